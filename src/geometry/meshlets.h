// A mesh's triangles in meshlets: groups of neighbouring triangles with their own copy of their few vertices.
//
// They serve loops over all triangles, which spend most of their time on fetching corners: vertices are read
// from memory in order, the corners of a meshlet's triangles then lie in the nearest cache, and neither
// depends on the order of the mesh's triangles. A vertex is stored once per meshlet that uses it. Triangles
// come in groups of four, which the loops process together (hydrostatics/wetted_surface.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr std::size_t kGroupTriangles = 4;

// The corners of four triangles: four times the index of a vertex of the meshlet, which is the offset of its
// row in a table of four numbers per vertex. Missing triangles at the end of a meshlet have three equal
// corners.
struct CornerGroup {
  std::uint64_t vertices = 0;  // one bit per vertex of the meshlet: set for the corners
  std::array<std::uint8_t, kGroupTriangles> a{}, b{}, c{};
};

struct Meshlet {
  std::uint32_t first_vertex;  // index into Meshlets::x, y, z
  std::uint32_t first_group;   // index into Meshlets::groups
  std::uint32_t vertices;      // a multiple of 4: the last vertex is repeated
  std::uint32_t groups;
};

struct Meshlets {
  static constexpr std::size_t kMaxVertices = 64;
  static constexpr std::size_t kMaxGroups = 32;

  std::vector<double> x, y, z;  // [m], of the meshlets' vertices, in the mesh's frame
  std::vector<CornerGroup> groups;
  std::vector<Meshlet> meshlets;

  std::size_t bytes() const;
};

// Each triangle of the mesh is in one meshlet, with its corners in the same order. Neighbours along a Morton
// curve through the triangles' centres are grouped. Deterministic; O(n log n) for n triangles.
Meshlets build_meshlets(const TriangleMesh& mesh);

}  // namespace buoyancy
