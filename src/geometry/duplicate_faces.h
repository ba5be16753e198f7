// Removes faces that are stored more than once.
#pragma once

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Faces with the same three vertices are copies of the same winding, or opposites.
//
// Copies are removed, patch by patch (connected through edges), unless all edges at the patch's rim are
// matched with it: a part that is stored twice becomes one, and of a box that stands flush inside another
// nothing is removed.
//
// Of opposites either one stays, the earlier, or none. None stays of a flat patch (within the tolerance)
// whose rim meets other faces in even numbers only, as that of a wall between two solids or of a fin, and
// none of a flat sheet that is connected to nothing, unless the mesh consists of such sheets. Otherwise one
// stays, since the patch may be a surface that is stored for both sides; should it lie inside another,
// inner_faces.h removes it.
//
// Flat polygons that are stored twice count as duplicates also if they are divided into other triangles.
// tolerance: [m]. mesh: welded. Complexity: O(n log n).
void remove_duplicate_faces(TriangleMesh& mesh, double tolerance, RepairReport& report);

}  // namespace buoyancy
