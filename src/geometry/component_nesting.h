// Finds which components of a mesh lie inside which others.
//
// A component lies inside another if its bounding box does and if the other has a non-zero winding number
// about each of a few sample vertices. The winding number is the signed count of the other's crossings of a
// ray from the vertex, by exact predicates. Vertices on the other component do not count; components that
// cross each other are not nested. Complexity: no tree is built if no box contains another; else O(n log n)
// for the n faces of the candidate outer components, and O(log n) per vertex and component around its box.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/mesh_topology.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns, by component, its enclosing components, ascending; nullopt if there are more than some 50,000,000
// pairs of components whose boxes overlap, or some 2,000,000 of which one box contains the other. Requires
// closed or balanced components.
std::optional<std::vector<std::vector<std::int32_t>>> enclosing_components(const TriangleMesh& mesh,
                                                                           const MeshTopology& topology);

}  // namespace buoyancy
