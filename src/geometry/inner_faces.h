// Removes faces inside the surface that bounds a body, such as decks and bulkheads, and fins of zero
// thickness outside it; gives the rest a consistent winding.
#pragma once

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Treats each component with unmatched edges of two faces or more by itself.
//
// Around each edge, the sides of faces that follow each other by angle border the same space. That joins the
// sides of all faces into cells, one of which is the outside. Faces with the outside on one side bound the
// body: they stay, wound so that it is on their front (or on their back, if that is the side of the larger
// area). Faces without the outside on either side lie in the body and are removed. Faces with the outside on
// both sides are removed if they are fins: flat sheets (flat_sheets.h) with free edges around most of them.
//
// A component stays as it is if faces of it intersect, since cells then leak into each other; if faces with
// the outside on both sides are no fins, as where the outside reaches through a hole; if what would stay is
// not closed; or if a removed face is not where it should be by its winding number. tolerance: [m]. Angles
// are compared by exact predicates. Complexity: O(n log n).
void remove_inner_faces(TriangleMesh& mesh, double tolerance, RepairReport& report);

}  // namespace buoyancy
