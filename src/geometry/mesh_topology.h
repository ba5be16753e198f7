// Edge classification, connected components and holes of a welded mesh.
//
// A face uses an undirected edge `forward` if it runs along it from the lower to the higher vertex index,
// else `backward`. Every volume integral over a mesh is exact if each edge has as many forward as backward
// uses. With f forward and b backward uses an edge is
//   manifold      f = b = 1
//   boundary      f + b = 1
//   misoriented   f + b = 2, f != b
//   balanced      f = b > 1
//   non-manifold  f + b > 2, f != b
// Complexity: O(n) for n faces; O(n log n) if many faces share one vertex.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/edge_uses.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

struct EdgeCounts {
  std::int64_t manifold = 0;
  std::int64_t boundary = 0;
  std::int64_t misoriented = 0;
  std::int64_t balanced = 0;
  std::int64_t non_manifold = 0;

  std::int64_t unmatched() const { return boundary + misoriented + non_manifold; }
  bool all_matched() const { return unmatched() == 0; }
};

struct MeshTopology {
  EdgeCounts counts;
  std::vector<Edge> boundary;  // in the direction of its face; ascending by lower, higher vertex
  std::vector<std::int32_t> boundary_faces;  // the face of each boundary edge
  std::vector<Edge> misoriented;             // lower vertex first; ascending
  std::vector<Edge> non_manifold;            // lower vertex first; ascending
  std::int64_t duplicate_faces = 0;          // same three vertices, in any order, as an earlier face

  // Components are connected through shared edges of any kind and numbered in the order of their first faces.
  std::vector<std::int32_t> component_of_face;
  std::int32_t components = 0;
};

// mesh: indices in range, no face with two equal indices, fewer than 2^31 faces.
MeshTopology mesh_topology(const TriangleMesh& mesh);

// Boundary edges connected through their vertices. If boundary edges are the only fault of a mesh, the edges
// of each hole form closed loops.
struct Hole {
  std::vector<Edge> edges;
  BoundingBox box;
};

// Returns the holes, those with most edges first, then by first edge.
std::vector<Hole> find_holes(const TriangleMesh& mesh, const std::vector<Edge>& boundary);

}  // namespace buoyancy
