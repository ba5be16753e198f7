// Closes holes of any size, as a user asks for: a missing deck, windows, a moonpool.
//
// Unlike the automatic repair this adds a surface that the mesh does not have, so that no bound on the error
// exists. Two estimates stand for it:
//   bulge         the volume of a hemisphere over each cap: what a true surface that is not flat may hold
//   disagreement  of the volumes under three caps of the same loop: the one of least area, the one by ear
//                 clipping in projection, and a fan around the mean of its vertices. It is 0 for a flat loop.
// A loop of up to 1,000 edges gets the cap of least area, which follows a deck with sheer; a longer one gets
// the cap by ear clipping.
//
// Loops of boundary edges are closed first, and the mesh is then repaired again, so that walls inside it are
// told from its surface. Where edges are left unmatched after that, the net chain of what is missing is
// closed too, so that the result is always closed or balanced.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr double kDefaultMaxChange = 1e-2;   // of the volume
inline constexpr double kMaxCapDisagreement = 0.1;  // of the volume, whatever a user allows

// Which holes to close.
struct ClosingOptions {
  bool holes = false;     // all, if their bulge is at most max_change of the volume
  bool all_rims = false;  // all, whatever their bulge
  // Some, whatever their bulge: by number, from 1, in the order of MeshReport::holes.
  std::vector<std::int32_t> rims;
  // [m], above 0: the rims that face up are first raised by this height along up_B, and then closed whatever
  // their bulge.
  double freeboard = 0.0;
  Vec3 up_B = Vec3::UnitZ();  // unit length
  // Limit on the bulge of the holes and on the disagreement of all caps, as a share of the volume. The limit
  // on the disagreement is never above kMaxCapDisagreement.
  double max_change = kDefaultMaxChange;

  bool empty() const { return !holes && !all_rims && rims.empty() && freeboard == 0.0; }
  bool operator==(const ClosingOptions&) const = default;
};

// What closing all holes of an open mesh would do.
struct ClosingEstimate {
  double volume = 0.0;        // [m^3], closed
  double bulge = 0.0;         // [m^3]
  double disagreement = 0.0;  // [m^3]
};

// Closes the holes. If the limits are exceeded, or if holes are left that were not asked for, the mesh stays
// as it is and report.skipped says why; likewise if faces have more than one open edge on average, as in a
// soup of triangles. automatic: repair again after closing. mesh: welded. Complexity: O(n log n) for n faces,
// and the caps' n^3 up to some seconds.
void close_holes(TriangleMesh& mesh, const ClosingOptions& options, bool automatic, RepairReport& report);

// Estimates what closing all holes would do; nullopt if the mesh encloses no volume even then. Complexity:
// that of close_holes().
std::optional<ClosingEstimate> estimate_closing(const TriangleMesh& mesh);

}  // namespace buoyancy
