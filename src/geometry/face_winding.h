// Gives the faces of each surface a consistent winding.
#pragma once

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Turns the faces of each surface (faces connected through edges of exactly two faces) that disagree with the
// larger part of its area. Two kinds of surfaces stay as they are: those of one side, as a Moebius strip, and
// those with an edge of more than two faces, because the turned surface might be inside out against others
// that meet it there, which validation could not see (inner_faces.h orients them). Complexity: O(n log n).
void make_winding_consistent(TriangleMesh& mesh, RepairReport& report);

}  // namespace buoyancy
