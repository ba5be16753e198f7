// The true result of one pose in rational arithmetic, in the world's axes, and how far a result is from it:
// nothing is rounded before the difference is known.
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

// One answer against the truth: volume and force to G_V, torque to G_tau, times `factor`.
void check_result(StressCase& stress, const StressedBody& body, const BuoyancyResult& result,
                  const Truth& truth, const Vec3& reference_B, double factor, const std::string& where);

// Every exact method at one pose against the truth; factor: what else widens the gates.
void check_exactly(StressCase& stress, const StressedBody& body, const Pose& pose, const Water& water,
                   const Vec3& reference_B, const std::string& where = "", double factor = 1.0);

// What the water's surface, at a level raised by `raised`, has in common with the body.
struct TrueWaterplane {
  double area = 0.0;       // [m^2] A_wp
  double perimeter = 0.0;  // [m] of the waterline
  double cut_area = 0.0;   // [m^2] of the cut triangles that have two corners in the water, projected on it
};

TrueWaterplane true_waterplane(const TriangleMesh& mesh, const Pose& pose, const Water& water, double raised);

}  // namespace buoyancy
