// Removes plates of zero thickness: flat surfaces with an open rim, which bound nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

using FaceList = std::vector<std::int32_t>;

// Returns, by sheet, whether it can be left out of a body of this volume [m^3]: it is flat within the
// tolerance [m], and it is not one of three or more sheets close to each other that face different ways.
// Those might be the walls of a part that do not quite meet, unless they are so small that they could enclose
// only a negligible volume. Complexity: O(n log n).
std::vector<bool> sheets_to_leave_out(const TriangleMesh& mesh, const std::vector<FaceList>& sheets,
                                      double tolerance, double volume);

// Removes components that are flat, have a boundary, and can be left out of what the rest encloses. The mesh
// stays as it is if it consists of such components.
void remove_flat_sheets(TriangleMesh& mesh, double tolerance, RepairReport& report);

}  // namespace buoyancy
