// Gives the faces of each surface a consistent winding.
#pragma once

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Turns the faces of each surface (faces connected through edges of exactly two faces) that disagree with the
// larger part of its area. Two kinds of surfaces stay as they are: one-sided ones such as a Moebius strip,
// and those with an edge of more than two faces. There the turned surface might be inside out against others
// that meet it, which validation could not see; inner_faces.h orients these. Complexity: O(n log n).
void make_winding_consistent(TriangleMesh& mesh, RepairReport& report);

}  // namespace buoyancy
