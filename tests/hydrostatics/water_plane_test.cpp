#include "hydrostatics/water_plane.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/hydrostatics/random_poses.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Water, pose and centre over many orders of magnitude, and their exact water plane.
struct FarRequest {
  Water water;
  Pose pose;
  Vec3 c_B = Vec3::Zero();
  ExactPlane<Rational> exact;  // about c

  FarRequest(RandomPoses& random, double quaternion_norm) {
    water.up_W = random.direction();
    water.level = random.uniform(-1, 1);
    water.level *= random.power_of_ten(-3, 6);
    pose.q_WB = random.rotation();
    pose.q_WB.coeffs() *= quaternion_norm;
    pose.p_WB = random.far_vector(-3, 9);
    c_B = random.far_vector(-3, 6);
    exact = exact_plane<Rational>(pose, water, c_B);
  }
};

TEST(WaterPlane, RoundsExactPlaneOnce) {
  RandomPoses random(1);
  for (int i = 0; i < 2000; ++i) {
    const FarRequest request(random, random.uniform(0.999, 1.001));
    const WaterPlane plane = water_plane_in_body(request.pose, request.water, request.c_B);

    for (int axis = 0; axis < 3; ++axis) {
      const Rational error = plane.up_B[axis] - request.exact.up_B[axis];
      EXPECT_LE(std::abs(error.convert_to<double>()), kEpsilon);
    }
    const double error = std::abs(Rational(plane.h_c - request.exact.h).convert_to<double>());
    EXPECT_LE(error,
              kEpsilon * std::abs(plane.h_c) + 1e-29 * (request.pose.p_WB.norm() + request.c_B.norm()));
  }
}

TEST(WaterPlane, StaysWithinStatedErrorInPlainDouble) {
  RandomPoses random(5);
  for (int i = 0; i < 2000; ++i) {
    const FarRequest request(random, std::pow(10.0, random.uniform(-20, 20)));
    const double reach = std::pow(10.0, random.uniform(-3, 3));
    const Vec3 y = reach * random.direction();

    const RoughWaterPlane rough = rough_water_plane_in_body(request.pose, request.water, request.c_B, reach);
    const double height = (rough.up_B.vec3().dot(y) - rough.h_c) / rough.norm_squared;

    const Rational true_height = request.exact.up_B.dot(y.cast<Rational>()) - request.exact.h;
    const double error = std::abs(Rational(height - true_height).convert_to<double>());
    EXPECT_LE(error, rough.error / rough.norm_squared);
  }
}

TEST(WaterPlane, AcceptsQuaternionsOfAnyNorm) {
  RandomPoses random(4);
  for (const double norm : {1e-300, 1e-160, 0.5, 2.0, 1e160, 1e300}) {
    const Pose unit{Vec3(0.1, 0.2, 0.3), random.rotation()};
    Pose scaled = unit;
    scaled.q_WB.coeffs() *= norm;
    const WaterPlane expected = water_plane_in_body(unit, {}, Vec3::Zero());
    const WaterPlane plane = water_plane_in_body(scaled, {}, Vec3::Zero());
    EXPECT_LE((plane.up_B - expected.up_B).norm(), 4 * kEpsilon) << norm;
  }
}

}  // namespace
}  // namespace buoyancy
