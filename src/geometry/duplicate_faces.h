// Removes faces that are stored more than once.
#pragma once

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Faces with the same three vertices are copies of the same winding, or opposites.
//
// Copies are removed, patch by patch (connected through edges), unless more edges would then be unmatched: a
// part that is stored twice becomes one, and of a box that stands flush inside another nothing is removed.
//
// Of opposites either one stays, the earlier, or none. That is decided patch by patch by the parity of the
// rim: where the faces of the rest meet it in odd number, they need one to be matched, and where in even
// number, none, as at a wall between two solids. Where the patch is not connected to faces of the rest, one
// stays, since it is a surface stored for both its sides; but none if it is a flat sheet (within the
// tolerance), unless the mesh consists of such sheets.
//
// Flat polygons that are stored twice count as duplicates also if they are divided into other triangles.
// tolerance: [m]. mesh: welded. Complexity: O(n log n).
void remove_duplicate_faces(TriangleMesh& mesh, double tolerance, RepairReport& report);

}  // namespace buoyancy
