// Flips (reverses the winding of) inside-out components, so that solids have positive volume and cavities
// negative volume.
//
// Rules, applied from the outermost components inward:
// - A component inside no other is a solid. If its volume is negative it is inside out, and it is flipped
//   together with everything inside it.
// - For a component inside others, let n be the number of times that the volume integrals count the space
//   around it. If n <= 0, as in a cavity, it is a solid and is flipped if its volume is negative. If n > 0,
//   it is a cavity if its volume is negative; otherwise its volume is counted once too often, which is kept
//   and reported.
// - Solids that share an edge are one component and are flipped together or not at all.
#pragma once

#include <vector>

#include "geometry/mesh_report.h"
#include "geometry/mesh_topology.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns topology and volume of each component, by component number. Flips nothing.
std::vector<ComponentReport> describe_components(const TriangleMesh& mesh, const MeshTopology& topology);

// Flips inside-out components of a mesh whose edges are all matched, and records that in `components`.
// Returns false and flips nothing if too many components overlap (component_nesting.h).
bool orient_closed(TriangleMesh& mesh, const MeshTopology& topology,
                   std::vector<ComponentReport>& components);

// Flips all faces of an open mesh if its volume is negative with its holes closed, each by a fan of triangles
// around the mean of its vertices. Requires a mesh without faults other than boundary edges. Returns the
// resulting volume [m^3].
double orient_open(TriangleMesh& mesh, const std::vector<Hole>& holes,
                   std::vector<ComponentReport>& components);

}  // namespace buoyancy
