// The true result of one pose in rational arithmetic, in world axes, and the distance of a result from it;
// nothing is rounded before the difference is taken.
#pragma once

#include <limits>
#include <string>

#include "tests/hydrostatics/rational.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"

namespace buoyancy {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

struct Truth {
  Rational volume;           // [m^3]
  Vec3T<Rational> force_W;   // [m^3]
  Vec3T<Rational> torque_W;  // [m^4], about the reference point
};

Truth true_result(const TriangleMesh& mesh, const Pose& pose, const Water& water, const Vec3& reference_B);

double distance(const Vec3& found, const Vec3T<Rational>& truth);

double distance(double found, const Rational& truth);

// Checks one result against the truth: volume and force within factor G_V, torque within factor G_tau.
void check_result(StressCase& stress, const StressedBody& body, const BuoyancyResult& result,
                  const Truth& truth, const Vec3& reference_B, double factor, const std::string& where);

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
