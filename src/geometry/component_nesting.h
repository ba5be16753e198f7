// Which components of a mesh lie inside which others.
//
// A component lies inside another if its box does and if the other winds around every one of a few of its
// vertices, found by counting the other's crossings of a ray from there, entering and leaving, with exact
// predicates. Vertices that lie on the other component do not count; components that cross each other are not
// nested. Nothing is built where no box holds another; else O(n log n) for n faces of the components that
// could hold others, and O(log n) per vertex.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh_topology.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// By component: the components around it, ascending. Each must be closed or balanced.
std::vector<std::vector<std::int32_t>> enclosing_components(const TriangleMesh& mesh,
                                                            const MeshTopology& topology);

}  // namespace buoyancy
