// Completes half a body by its mirror image.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "base/error.h"
#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

enum class Axis { kX, kY, kZ };
inline constexpr std::array<std::string_view, 3> kAxisNames{"x", "y", "z"};

// Adds the mirror image of the mesh in the plane through the origin across the axis. Vertices within 1e-6 of
// the mesh's size from the plane are moved into it, and faces that lie in it are removed: they bound nothing
// in a whole body. Errors: a mesh that reaches to both sides of the plane or does not reach it. name: of the
// mesh, for errors. O(n).
Expected<RepairStep> add_mirror_image(TriangleMesh& mesh, Axis axis, const std::string& name);

}  // namespace buoyancy
