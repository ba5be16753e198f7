// Measures how far faces are from a plane.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns the largest distance of the faces' vertices from the plane of their largest face [m]; infinity if
// they have no area. Complexity: O(n).
double distance_from_plane(const TriangleMesh& mesh, std::span<const std::int32_t> faces);

}  // namespace buoyancy
