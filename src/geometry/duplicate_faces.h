// Removes faces that are stored more than once.
#pragma once

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Faces with the same three vertices are copies of the same winding, or opposites.
//
// Copies are removed, patch by patch (connected through edges), unless the edges at the patch's rim are
// matched only together with it: a part that is stored twice becomes one, and a box that stands flush inside
// another keeps all its faces.
//
// Of two opposites the earlier one stays: the surface is stored for both sides. Later steps remove it too if
// it is a wall between solids or a fin, which depends on geometry (inner_faces.h, flat_sheets.h).
//
// Flat polygons (within the tolerance) that are stored twice count as duplicates also if they are divided
// into other triangles. tolerance: [m]. mesh: welded. Complexity: O(n log n).
void remove_duplicate_faces(TriangleMesh& mesh, double tolerance, RepairReport& report);

}  // namespace buoyancy
