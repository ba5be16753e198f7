// The shape that a page draws: a mesh in single precision, with fewer triangles where it has too many.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec3.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy::view {

inline constexpr std::size_t kMaxDrawnTriangles = 60'000;  // of a page, which are about 1.5 MB of it

struct MeshDrawing {
  std::vector<float> positions;        // three per vertex [m]
  std::vector<std::uint32_t> indices;  // three per triangle, counter-clockwise seen from outside

  std::size_t triangle_count() const { return indices.size() / 3; }
};

// Adds a mesh: its vertices at rotation * vertex + offset.
void append(MeshDrawing& drawing, const TriangleMesh& mesh, const Mat3& rotation = Mat3::Identity(),
            const Vec3& offset = Vec3::Zero());

// Reduces a drawing of more triangles to at most max_triangles (meshoptimizer); max_triangles: at least 4.
void reduce(MeshDrawing& drawing, std::size_t max_triangles);

}  // namespace buoyancy::view
