// The exact methods against exact rational arithmetic, and the invariants that every exact method obeys.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
const Water kUnitWater{.up_W = Vec3::UnitZ(), .level = 0.25, .density = 1.0, .gravity = 1.0};

constexpr std::array kExactMethods{Method::kExact, Method::kExactSurface, Method::kHierarchical};

Vec3 turned(const Pose& pose, const Vec3T<Rational>& vector_B) {
  return pose.q_WB.normalized() * Vec3(vector_B.x().convert_to<double>(), vector_B.y().convert_to<double>(),
                                       vector_B.z().convert_to<double>());
}

TEST(ExactMethodsTest, ApplyForceAtCentreOfBuoyancy) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    std::vector<Solver> solvers;
    for (const Method method : kExactMethods) solvers.emplace_back(mesh, method);
    RandomPoses random(14);
    for (int i = 0; i < 20; ++i) {
      const Pose pose = random.crossing(bounding_box(named.mesh), kUnitWater);
      if (buoyancy(solvers[0], pose, kUnitWater, Vec3::Zero()).volume < 1e-3 * mesh.volume) continue;
      const auto oracle = exact_displacement<Rational>(named.mesh, pose, kUnitWater);
      const Vec3 center_W = turned(pose, oracle.moment / oracle.volume);
      for (const Solver& solver : solvers) {
        const BuoyancyResult result = buoyancy(solver, pose, kUnitWater, Vec3::Zero());
        EXPECT_LE((result.center_of_buoyancy_W - center_W).norm(),
                  8 * mesh.volume_tolerance() * mesh.diagonal / result.volume +
                      8 * kEpsilon * mesh.max_lever_arm(Vec3::Zero()))
            << named.name << ", " << to_string(solver.method());
        EXPECT_LE((result.center_of_buoyancy_W.cross(result.force_W) - result.torque_W).norm(),
                  16 * mesh.volume_tolerance() * mesh.max_lever_arm(Vec3::Zero()))
            << named.name << ", " << to_string(solver.method());
      }
    }
  }
}

class ExactMethods : public testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Methods, ExactMethods, testing::ValuesIn(kExactMethods),
                         [](const auto& method) { return std::string(to_string(method.param)); });

// Regression, found by the random search: the centre's grid was wider than such a mesh.
TEST(HydrostaticMesh, CentresMeshesFarFromTheirOrigin) {
  const TriangleMesh box = make_shape(BoxShape{.size = {8, 4, 2}});
  for (const double far : {0.0, 1e3, 1e6, 1e9, 1e12}) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({moved_and_scaled(box, {far, -0.7 * far, 0.1}), {}});
    for (int i = 0; i < 3; ++i) {
      EXPECT_LE(std::max(-mesh.box_min[i], mesh.box_max[i]), 0.52 * mesh.diagonal) << far;
    }
  }
}

TEST_P(ExactMethods, ScalesOnlyWithDensityAndGravity) {
  const TriangleMesh box = make_shape(BoxShape{.segments = {4, 4, 4}});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({box, {}});
  const Solver solver(mesh, GetParam());
  const Pose half{Vec3(5, -7, kUnitWater.level), Eigen::Quaterniond::Identity()};
  Water sea = kUnitWater;
  sea.density = 1025.0;
  sea.gravity = 9.80665;
  const BuoyancyResult result = buoyancy(solver, half, sea, Vec3(0.5, 0, 0));
  EXPECT_NEAR(result.force_W.z(), 1025.0 * 9.80665 * 0.5, 1e-10);
  EXPECT_NEAR(result.torque_W.y(), 1025.0 * 9.80665 * 0.5 * 0.5, 1e-10);
  EXPECT_NEAR(result.volume, 0.5, 1e-15);
  EXPECT_NEAR(result.center_of_buoyancy_W.z(), -0.25, 1e-15);
}

TEST_P(ExactMethods, PublishesForceAlongUpAndTorqueNormalToUp) {
  RandomPoses random(15);
  const NamedMesh named = closed_test_meshes()[7];
  const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
  const Solver solver(mesh, GetParam());
  for (int i = 0; i < 100; ++i) {
    Water water = kUnitWater;
    water.up_W = random.direction();
    const BuoyancyResult result =
        buoyancy(solver, random.crossing(bounding_box(named.mesh), water), water, Vec3::Zero());
    EXPECT_LE(result.force_W.cross(water.up_W).norm(), 2 * kEpsilon * result.force_W.norm());
    EXPECT_LE(std::abs(result.torque_W.dot(water.up_W)),
              4 * kEpsilon * (result.torque_W.norm() + result.volume * mesh.diagonal));
    EXPECT_LE(result.dropped_force, mesh.volume_tolerance() / mesh.volume);
    EXPECT_LE(result.dropped_torque, mesh.volume_tolerance() / mesh.volume);
  }
}

TEST_P(ExactMethods, SumsMillionTrianglesWithoutLosingDigits) {
  // A running sum of equal terms rounds all of them to the same side: here its error is tens of G_V.
  const TriangleMesh box = make_shape(BoxShape{.size = {2, 2, 2}, .segments = {290, 290, 290}});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({box, {}});
  const Solver solver(mesh, GetParam());
  RandomPoses random(16);
  const Pose level{Vec3(0, 0, 0.1), Eigen::Quaterniond::Identity()};
  for (const Pose& pose : {level, random.crossing(bounding_box(box), kUnitWater)}) {
    // Extended precision suffices as the oracle: rationals of a million triangles take minutes.
    const auto oracle = exact_displacement<long double>(box, pose, kUnitWater);
    const double error = std::abs(buoyancy(solver, pose, kUnitWater, Vec3::Zero()).volume -
                                  static_cast<double>(oracle.volume));
    EXPECT_GT(static_cast<double>(oracle.volume), 0.1 * mesh.volume);
    EXPECT_LE(error, mesh.volume_tolerance());
  }
}

}  // namespace
}  // namespace buoyancy
