// Inserts vertices into edges: repairs T-junctions, where one face has an edge and its neighbours have the
// same edge divided in several.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/edge_uses.h"
#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// A vertex to be inserted into all faces with this edge.
struct EdgeInsertion {
  Edge edge{};              // lower vertex first
  double along = 0.0;       // position on the edge, from 0 at the lower vertex to 1
  std::int32_t vertex = 0;  // not an end of the edge
  double distance = 0.0;    // from the edge [m]

  bool operator<(const EdgeInsertion& other) const;  // by edge, position, vertex
};

struct SplitMesh {
  TriangleMesh mesh;          // the split faces are replaced in place by their pieces
  double area = 0.0;          // of the split faces [m^2]
  double volume_bound = 0.0;  // between the surfaces before and after [m^3]
};

// Inserts the vertices and triangulates the faces anew, without folds: a face with vertices on its edges is
// cut from one corner into strips between its two sides, then into a fan over the third. A face of which
// nothing is left vanishes, such as a needle whose three corners lie on one edge. insertions: ascending.
// Complexity: O(n log n).
SplitMesh split_edges(const TriangleMesh& mesh, std::span<const EdgeInsertion> insertions);

// Inserts vertices of unmatched edges into edges within the tolerance [m] of them. An insertion is undone if
// no edge next to it gains a face.
void insert_vertices_on_edges(TriangleMesh& mesh, double tolerance, RepairReport& report);

}  // namespace buoyancy
