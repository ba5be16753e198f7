// Who uses which edge of a welded mesh, what hangs together, and where its holes are.
//
// An undirected edge is used `forward` by the faces that run from its lower vertex to its higher one and
// `backward` by the others. Every volume integral over a mesh is exact where the two are equal, edge by edge.
// With f forward and b backward uses an edge is
//   manifold      f = b = 1
//   boundary      f + b = 1
//   misoriented   f + b = 2, both the same way
//   balanced      f = b > 1
//   non-manifold  f + b > 2, f != b
// Complexity: O(n) for n faces; O(n log n) if many faces share one vertex.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

using Edge = std::array<std::int32_t, 2>;  // vertex indices

struct EdgeCounts {
  std::int64_t manifold = 0;
  std::int64_t boundary = 0;
  std::int64_t misoriented = 0;
  std::int64_t balanced = 0;
  std::int64_t non_manifold = 0;

  bool all_matched() const { return boundary == 0 && misoriented == 0 && non_manifold == 0; }
};

struct MeshTopology {
  EdgeCounts counts;
  std::vector<Edge> boundary;  // each as its one face runs along it; ascending by lower, higher vertex
  std::vector<std::int32_t> boundary_faces;  // the face of each
  std::vector<Edge> misoriented;             // lower vertex first; ascending
  std::vector<Edge> non_manifold;            // lower vertex first; ascending
  std::int64_t duplicate_faces = 0;          // with the same three vertices, in any order, as an earlier face

  // Faces connected through shared edges, of whatever kind. Numbered in the order of their first faces.
  std::vector<std::int32_t> component_of_face;
  std::int32_t components = 0;
};

// mesh: indices in range, no face names a vertex twice, less than 2^31 faces.
MeshTopology mesh_topology(const TriangleMesh& mesh);

// Boundary edges that hang together through their vertices. Where the only fault of a mesh is its boundary,
// each hole's edges form closed loops.
struct Hole {
  std::vector<Edge> edges;
  BoundingBox box;
};

// Most edges first, then by first edge.
std::vector<Hole> find_holes(const TriangleMesh& mesh, const std::vector<Edge>& boundary);

}  // namespace buoyancy
