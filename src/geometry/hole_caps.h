// Measures holes and closes them with caps.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh_topology.h"
#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Holes are closed at load if their bulges together are at most this share of the volume.
inline constexpr double kNegligibleBulge = 1e-5;

struct HoleSize {
  double perimeter = 0.0;  // [m]
  double area = 0.0;       // of a cap [m^2]
  double bulge = 0.0;  // 0.376 area^1.5, the volume of a hemisphere over the cap, summed over its loops [m^3]
};

// Measures a hole. A hole whose edges form no closed loops is measured as if closed by straight lines.
// work_left: see cap_negligible_holes().
HoleSize measure_hole(const TriangleMesh& mesh, const Hole& hole, std::int64_t& work_left);

// Returns whether some of the edges, whatever their directions, form a closed loop.
bool has_closed_loop(const std::vector<Edge>& edges);

// Measuring or capping the holes of a mesh may take this number of steps, each of 10 ns or less.
inline constexpr std::int64_t kCapWork = 200'000'000;

// Closes all holes if they are negligible together (kNegligibleBulge).
//
// The caps' edges are the net chain of the unmatched edges: each edge as often, and in the direction, as it
// lacks uses. That chain consists of closed loops, so that the mesh is closed or balanced afterwards whatever
// its faults were, and the area of the caps alone decides. A loop of up to 64 edges gets the triangulation of
// least area, as long as kCapWork lasts; others are cut from their shortest diagonals on, which suits cracks.
// Complexity: O(n log n).
void cap_negligible_holes(TriangleMesh& mesh, RepairReport& report);

// Closes each hole that consists of boundary edges alone and whose bulge is at most kNegligibleBulge of the
// bounding box's volume, whatever the winding of the faces around it. The caller must check that they are
// negligible together once the volume is known.
void cap_small_holes(TriangleMesh& mesh, RepairReport& report);

}  // namespace buoyancy
