// Comparison of results with the truth, and the waterplane in rational arithmetic.
#pragma once

#include <limits>
#include <string>

#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"
#include "tests/truth/truth.h"

namespace buoyancy {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Checks one result against the truth, in water of density times gravity 1: volume and force within factor
// G_V, torque within factor G_tau.
void check_result(StressCase& stress, const StressedBody& body, const BuoyancyResult& result,
                  const Truth& truth, const Vec3& reference_B, double factor, const std::string& where);

// Checks its volume and torque against those of another result that is as exact.
void check_result(StressCase& stress, const StressedBody& body, const BuoyancyResult& result,
                  const BuoyancyResult& other, const Vec3& reference_B, double factor,
                  const std::string& where);

// Checks every exact method at one pose against the truth. factor: further factor on the tolerances.
void check_exactly(StressCase& stress, const StressedBody& body, const Pose& pose, const Water& water,
                   const Vec3& reference_B, const std::string& where = "", double factor = 1.0);

// The intersection of the body with the water plane at a level raised by `raised`, [m].
struct TrueWaterplane {
  double area = 0.0;       // [m^2], A_wp
  double perimeter = 0.0;  // [m], of the waterline
  double cut_area = 0.0;   // [m^2], of the cut triangles with two wet corners, projected on the water plane
};

TrueWaterplane true_waterplane(const TriangleMesh& mesh, const Pose& pose, const Water& water, double raised);

}  // namespace buoyancy
