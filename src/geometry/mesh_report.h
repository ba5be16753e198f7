// What validation found out about a mesh: the figures a person needs to trust it or to mend it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh_import.h"
#include "geometry/triangle_mesh.h"
#include "geometry/welding.h"

namespace buoyancy {

// Triangles connected through shared edges.
struct ComponentReport {
  std::int64_t triangles = 0;
  double volume = 0.0;  // m^3, signed, as used (after turning), about the mesh's bounding-box centre
  bool closed = false;  // no boundary edge
  bool cavity = false;  // negative volume, inside another component: counted as a hole
  bool nested = false;  // positive volume, inside another component: that volume is counted twice
  bool turned = false;  // was inside out and has been turned
};

// Boundary edges that hang together.
struct HoleReport {
  std::int64_t edges = 0;
  BoundingBox box{Vec3::Zero(), Vec3::Zero()};
};

struct MeshReport {
  std::string name;  // file or shape
  MeshSource source;

  std::int64_t triangles = 0;  // kept; 0 also where vertices were not finite, and nothing else was looked at
  std::int64_t vertices_stored = 0;
  std::int64_t vertices_welded = 0;
  WeldKind weld = WeldKind::kExact;
  double weld_largest_move = 0.0;  // m

  BoundingBox box{Vec3::Zero(), Vec3::Zero()};
  double diagonal = 0.0;  // m, L
  double area = 0.0;      // m^2, A_s
  double volume = 0.0;    // m^3, V_T, about the bounding box's centre; means nothing for open meshes
  Vec3 volume_by_axis = Vec3::Zero();  // m^3: from x, from y, from z; they agree on a closed mesh
  Vec3 area_vector = Vec3::Zero();     // m^2: integral of n dA; zero on a closed mesh

  std::int64_t boundary_edges = 0;      // used by one face
  std::int64_t non_manifold_edges = 0;  // used by more than two faces, not as often one way as the other
  std::int64_t balanced_edges = 0;      // used by four or more faces, as often one way as the other
  std::int64_t misoriented_edges = 0;   // used by two faces, both the same way
  std::int64_t degenerate_faces = 0;    // kept, but of zero area
  std::int64_t dropped_faces = 0;       // named a vertex twice
  std::int64_t duplicate_faces = 0;     // same three vertices as an earlier face
  std::optional<std::int64_t> intersecting_pairs;  // pairs of faces that cross each other; where counted

  std::vector<ComponentReport> components;  // largest absolute volume first
  std::vector<HoleReport> holes;            // most edges first
  bool turned = false;                      // the whole mesh was inside out and has been turned

  bool closed() const { return boundary_edges == 0 && non_manifold_edges == 0 && misoriented_edges == 0; }
};

// The report as aligned text lines for a terminal, without a final newline.
std::string to_text(const MeshReport& report);

}  // namespace buoyancy
