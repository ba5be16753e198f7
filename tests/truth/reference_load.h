// The load of waves on a body by adaptive subdivision, with an estimate of its own error that can be made as
// small as a test needs: the oracle of the random search.
//
// A triangle that is wet is integrated by a rule of degree 4, whose difference from one of degree 2 is the
// estimate of its error. One that the surface crosses is clipped by the linear interpolant of the height;
// the estimate is the integral over the strip where that may be on the wrong side. No triangle counts before
// its edges are short against the waves that matter there, so that nothing is missed between the points.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"
#include "tests/truth/reference_sea.h"

namespace buoyancy {

struct ReferenceLoad {
  Vec3 force = Vec3::Zero();                                         // [m^3], B axes, over rho g
  Vec3 torque = Vec3::Zero();                                        // [m^4]
  double volume = 0.0;                                               // [m^3]
  double force_error = 0.0, torque_error = 0.0, volume_error = 0.0;  // estimates
  bool resolved = false;                                             // the errors are as small as requested
  std::int64_t work = 0;                                             // component evaluations
};

struct ReferenceGoal {
  double force_error, torque_error, volume_error;
  std::int64_t max_work = 60'000'000;
};

// surface_B: as validated, in B.
ReferenceLoad reference_load(const TriangleMesh& surface_B, const Vec3& center_B, const ReferenceWaters& sea,
                             const Vec3& reference_B, const ReferenceGoal& goal);

}  // namespace buoyancy
