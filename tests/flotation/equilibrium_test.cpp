#include "flotation/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "flotation/righting_arms.h"
#include "geometry/mesh_validation.h"
#include "hydrostatics/buoyancy.h"
#include "tests/flotation/bodies.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Water kWater;

// Within the bounds of the state and what rounding of the pose changes, which is neither less nor more.
void expect_balance(const Equilibrium& at, const FloatingBody& body, const Water& water) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  EXPECT_LE(at.residual_force, at.force_bound);
  EXPECT_LE(at.residual_torque, at.torque_bound);
  const double height = water.up_W.dot(at.pose.p_WB) - water.level;
  const double rise = kEpsilon * (std::abs(water.level) + std::abs(height)) +
                      4.0 * kEpsilon * (body.center_of_mass_B().norm() + body.reach());
  const auto& K = at.state.hydrostatics.stiffness;
  const double force =
      K.topLeftCorner<3, 3>().norm() * rise + K.topRightCorner<3, 3>().norm() * 4.0 * kEpsilon;
  const double torque =
      K.topRightCorner<3, 3>().norm() * rise + K.bottomRightCorner<3, 3>().norm() * 4.0 * kEpsilon;
  EXPECT_NEAR(at.force_bound / (at.state.force_error_bound + force), 1.0, 1e-6);
  EXPECT_NEAR(at.torque_bound / (at.state.torque_error_bound + torque), 1.0, 1e-6);
}

void expect_equilibrium(const Equilibrium& at, const FloatingBody& body) {
  expect_balance(at, body, kWater);
  // The same from the wrench that the service computes.
  const FloatingBody::SignedVolume& volume = body.volumes().front();
  const BuoyancyResult wrench =
      buoyancy(Solver(*volume.placed.mesh, Method::kHierarchical), at.pose, kWater, body.center_of_mass_B());
  EXPECT_LE((wrench.force_W - body.mass() * kWater.gravity * kWater.up_W).norm(), at.force_bound);
  EXPECT_LE(wrench.torque_W.norm(), at.torque_bound);
}

// [rad], how far a heel is from the nearest multiple of 90 degrees.
double from_a_face(double heel) {
  const double quarter = 0.5 * std::numbers::pi;
  return std::abs(heel - quarter * std::round(heel / quarter));
}

// The log is square, and floats with its axis horizontal. It lies on a side where s < (3 - sqrt 3)/6 and
// where s > (3 + sqrt 3)/6, on an edge where 9/32 < s < 23/32, and tilted between these.
TEST(Equilibrium, FindsEveryAttitudeOfTheSquareLog) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{8, 1, 1}, {4, 1, 1}});
  const double side = (3.0 - std::sqrt(3.0)) / 6.0;
  std::vector<double> densities;
  for (int i = 1; i < 100; ++i) densities.push_back(0.01 * i);
  for (const double limit : {side, 9.0 / 32.0, 23.0 / 32.0, 1.0 - side}) {
    for (const double beside : {-2e-3, 2e-3}) densities.push_back(limit + beside);
  }
  for (const double density : densities) {
    SCOPED_TRACE(density);
    const double from_limit = std::min(std::abs(std::min(density, 1.0 - density) - side),
                                       std::abs(std::min(density, 1.0 - density) - 9.0 / 32.0));
    if (from_limit < 1.9e-3) continue;
    const FloatingBody body = body_of(mesh, density);
    const Equilibria found = find_equilibria(body, kWater);
    ASSERT_EQ(found.outcome, FlotationOutcome::kFloats);
    const double s = std::min(density, 1.0 - density);  // water and air change places
    EXPECT_EQ(found.attitudes.size(), s > side && s < 9.0 / 32.0 ? 8U : 4U);
    for (const Equilibrium& at : found.attitudes) {
      expect_equilibrium(at, body);
      EXPECT_TRUE(at.is_stable());
      EXPECT_EQ(at.family, AttitudeFamily::kNone);
      EXPECT_NEAR(at.state.energy, found.attitudes.front().state.energy, 1e-12 * at.state.energy);
      EXPECT_LT(std::abs(at.angles.trim), 1e-9);
      const double tilt = from_a_face(at.angles.heel);
      if (s < side) {
        EXPECT_LT(tilt, 1e-9);
      } else if (s <= 0.25) {
        // The angle of loll of a wall-sided body: tan^2 = -2 GM/BM.
        const double radius = 1.0 / (12.0 * s);
        EXPECT_NEAR(std::tan(tilt), std::sqrt(-2.0 * (radius - 0.5 * (1.0 - s)) / radius), 1e-9);
      } else if (s < 9.0 / 32.0) {
        EXPECT_GT(tilt, 26.0 * kDegree);
        EXPECT_LT(tilt, 44.9 * kDegree);
      } else {
        EXPECT_NEAR(tilt, 45.0 * kDegree, 1e-9);
      }
    }
  }
}

TEST(Equilibrium, FindsAngleOfLollOfBoxWithHighCentreOfMass) {
  // Beam 20, depth 12, draught 6 [m]: KB 3, BM 5.5556, so that the upright box is unstable with KG > 8.5556.
  const HydrostaticMesh mesh = mesh_of(BoxShape{{60, 20, 12}, {3, 2, 2}});
  const FloatingBody body = body_of(mesh, 0.5, Vec3(0, 0, 8.7 - 6.0));
  const auto found = find_equilibrium_from(body, kWater, Eigen::Quaterniond::Identity());
  ASSERT_TRUE(found);
  const double radius = 400.0 / 72.0;
  EXPECT_NEAR(std::abs(std::tan(found->angles.heel)), std::sqrt(-2.0 * (3.0 + radius - 8.7) / radius), 1e-10);
  expect_equilibrium(*found, body);
  const FloatingBody stable = body_of(mesh, 0.5, Vec3(0, 0, 8.0 - 6.0));
  const auto upright = find_equilibrium_from(stable, kWater, Eigen::Quaterniond::Identity());
  ASSERT_TRUE(upright);
  EXPECT_NEAR(upright->angles.heel, 0.0, 1e-10);
  EXPECT_NEAR(upright->draft, 6.0, 1e-12);
  EXPECT_NEAR(upright->state.hydrostatics.metacentric_heights[0], 3.0 + radius - 8.0, 1e-11);
}

TEST(Equilibrium, ReportsSphereOnce) {
  const HydrostaticMesh mesh = mesh_of(SphereShape{});
  for (const double density : {0.05, 0.3, 0.5, 0.8}) {
    SCOPED_TRACE(density);
    const FloatingBody body = body_of(mesh, density);
    const Equilibria found = find_equilibria(body, kWater);
    ASSERT_EQ(found.attitudes.size(), 1U);
    EXPECT_EQ(found.attitudes[0].family, AttitudeFamily::kSphere);
    // The metacentre is at the centre at every draught; the mesh has 50 meridians.
    for (const double height : found.attitudes[0].state.hydrostatics.metacentric_heights) {
      EXPECT_NEAR(height, 0.0, 4e-3);
    }
  }
  const FloatingBody weighted = body_of(mesh, 0.5, Vec3(0.1, -0.2, 0.05));
  const Equilibria found = find_equilibria(weighted, kWater);
  ASSERT_EQ(found.attitudes.size(), 1U);
  EXPECT_EQ(found.attitudes[0].family, AttitudeFamily::kNone);
  const Vec3 down_W = found.attitudes[0].pose.q_WB * Vec3(0.1, -0.2, 0.05).normalized();
  EXPECT_LT((down_W + Vec3::UnitZ()).norm(), 0.01);
}

TEST(Equilibrium, ReportsCylinderThatRollsOnce) {
  const HydrostaticMesh slender = mesh_of(CylinderShape{0.5, 3.0});
  const Equilibria lying = find_equilibria(body_of(slender, 0.3), kWater);
  ASSERT_EQ(lying.attitudes.size(), 1U);
  EXPECT_EQ(lying.attitudes[0].family, AttitudeFamily::kCurve);
  EXPECT_NEAR((lying.attitudes[0].pose.q_WB * Vec3::UnitZ()).z(), 0.0, 1e-6);

  const HydrostaticMesh disc = mesh_of(CylinderShape{0.5, 0.5});
  const Equilibria flat = find_equilibria(body_of(disc, 0.5), kWater);
  ASSERT_EQ(flat.attitudes.size(), 2U);
  for (const Equilibrium& at : flat.attitudes) {
    EXPECT_EQ(at.family, AttitudeFamily::kNone);
    EXPECT_NEAR(std::abs((at.pose.q_WB * Vec3::UnitZ()).z()), 1.0, 1e-12);
  }
}

// [rad], between the axis of a body and the vertical.
double tilt_of(const Equilibrium& at) {
  return std::acos(std::clamp((at.pose.q_WB * Vec3::UnitZ()).z(), -1.0, 1.0));
}

// The heels to starboard at which the arm turns the body back, up to 60 degrees, at no trim.
std::vector<double> rest_heels(const FloatingBody& body) {
  std::vector<double> heels;
  for (int i = 0; i <= 30; ++i) heels.push_back(2.0 * i * kDegree);
  std::vector<double> rests;
  RightingArmOptions options;
  options.fixed_trim = 0.0;
  const RightingCurve curve = righting_curve(body, kWater, heels, options).value();
  for (const ArmCrossing& crossing : curve.crossings) {
    if (crossing.returns) rests.push_back(crossing.heel);
  }
  return rests;
}

// A cylinder with facets that is too high to float upright. Its second moments are those of every axis, so
// that its curve of loll is level, tan^2 = -2 GM/BM, until an edge crosses the water. Beyond that each facet
// makes a ripple, which is far below the rounding of the energy where there are many.
TEST(Equilibrium, FindsTheCurveOfLollForAnyNumberOfFacets) {
  int beyond_an_edge = 0;
  int dry = 0;
  for (const int segments : {16, 23, 32, 64, 100, 128, 200, 256, 300, 400, 512, 777, 1024}) {
    const HydrostaticMesh mesh = mesh_of(CylinderShape{1.0, 1.0, segments, 1});
    const double density = 1500.0 / (kWater.density * mesh.volume);
    const double turn = 2.0 * std::numbers::pi / segments;
    const double radius = segments / 24.0 * std::sin(turn) * (2.0 + std::cos(turn)) / (density * mesh.volume);
    for (const double height : {0.26, 0.28, 0.3, 0.31, 0.32, 0.33, 0.34}) {
      SCOPED_TRACE(testing::Message() << segments << " segments, centre of mass at " << height);
      const FloatingBody body = body_of(mesh, density, Vec3(0, 0, height));
      const double upright = 0.5 * density - 0.5 + radius - height;  // [m], GM
      // Below 8 degrees the valley is too shallow to be followed: attitudes on it are reported one by one.
      if (!(upright < -0.01 * radius)) continue;
      double loll = std::atan(std::sqrt(-2.0 * upright / radius));
      double accuracy = 1e-6;
      if (std::tan(loll) > std::min(density, 1.0 - density)) {
        if (segments < 64) continue;
        const std::vector<double> rests = rest_heels(body);
        ASSERT_EQ(rests.size(), 1U);
        loll = rests.front();
        accuracy = 1e-4;
        ++beyond_an_edge;
      } else {
        ++dry;
      }
      int found = 0;
      for (const Equilibrium& at : find_equilibria(body, kWater).attitudes) {
        if (std::abs(tilt_of(at) - loll) > accuracy) continue;
        expect_equilibrium(at, body);
        EXPECT_EQ(at.family, AttitudeFamily::kCurve);
        ++found;
      }
      EXPECT_EQ(found, 1);
    }
  }
  EXPECT_GE(dry, 20);
  EXPECT_GE(beyond_an_edge, 20);
}

// The ripples of its facets are below the rounding of the energy.
TEST(Equilibrium, FindsThatALogOfManyFacetsFloats) {
  for (const int segments : {64, 256, 500, 762, 1024}) {
    for (const double density : {0.1, 0.345, 0.55, 0.8}) {
      SCOPED_TRACE(testing::Message() << segments << " segments, density " << density);
      const HydrostaticMesh mesh = mesh_of(CylinderShape{1.0, 3.75, segments, 1});
      const FloatingBody body = body_of(mesh, density, Vec3(0, 0, 0.2));
      const Equilibria found = find_equilibria(body, kWater);
      EXPECT_EQ(found.outcome, FlotationOutcome::kFloats);
      ASSERT_EQ(found.attitudes.size(), 1U);
      EXPECT_EQ(found.attitudes[0].family, AttitudeFamily::kCurve);
      expect_equilibrium(found.attitudes[0], body);
    }
  }
}

// A cone floats with its apex down where s^(1/3) > cos^2 of its half-angle: GM = 3/4 (h / cos^2 - H).
TEST(Equilibrium, FindsWhetherConeFloatsOnItsApex) {
  const double radius = 0.6;
  const HydrostaticMesh mesh = mesh_of(ConeShape{radius, 1.0, 96, 1});
  const double cos_squared = 1.0 / (1.0 + radius * radius);
  for (const double factor : {0.9, 0.97, 1.03, 1.1}) {
    SCOPED_TRACE(factor);
    const FloatingBody body = body_of(mesh, factor * std::pow(cos_squared, 3.0), Vec3(0, 0, 0.25));
    bool on_apex = false;
    for (const Equilibrium& at : find_equilibria(body, kWater).attitudes) {
      on_apex = on_apex || (at.pose.q_WB * Vec3::UnitZ()).z() < -1.0 + 1e-9;
    }
    EXPECT_EQ(on_apex, factor > 1.0);
  }
}

TEST(Equilibrium, FindsDesignDraughtOfWigleyHull) {
  const WigleyShape hull{};
  const HydrostaticMesh mesh = mesh_of(hull);
  const double volume = hydrostatics(mesh, Pose{}, kWater, Vec3::Zero(), std::nullopt)->volume;
  const FloatingBody body = body_of(mesh, volume / mesh.volume, Vec3(0, 0, -0.35));
  const Equilibria found = find_equilibria(body, kWater);
  ASSERT_FALSE(found.attitudes.empty());
  const Equilibrium& at = found.attitudes.front();
  expect_equilibrium(at, body);
  EXPECT_NEAR(at.draft, hull.draft, 1e-12);
  EXPECT_NEAR(at.angles.heel, 0.0, 1e-10);
  EXPECT_NEAR(at.angles.trim, 0.0, 1e-12);
  EXPECT_LT((at.pose.q_WB * Vec3::UnitX() - Vec3::UnitX()).norm(), 1e-9);  // the bow over W's x axis
}

TEST(Equilibrium, FindsTheSameAttitudesInAnyFrame) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 6, .roughness = 0.5, .seed = 4});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  const HydrostaticMesh far =
      make_hydrostatic_mesh({moved_and_scaled(rock, Vec3(4096, -512, 1024), 1.0), {}});
  const Water tilted{.up_W = Vec3(0.6, 0.0, 0.8), .level = 7.0};
  const Equilibria near_found = find_equilibria(body_of(mesh, 0.4, Vec3(0.1, 0, 0)), kWater);
  const FloatingBody far_body = body_of(far, 0.4, Vec3(4096.1, -512, 1024));
  const Equilibria far_found = find_equilibria(far_body, tilted);
  ASSERT_EQ(near_found.attitudes.size(), far_found.attitudes.size());
  for (std::size_t i = 0; i < near_found.attitudes.size(); ++i) {
    const Equilibrium& a = near_found.attitudes[i];
    const Equilibrium& b = far_found.attitudes[i];
    EXPECT_NEAR(a.angles.heel, b.angles.heel, 1e-7);
    EXPECT_NEAR(a.angles.trim, b.angles.trim, 1e-7);
    EXPECT_NEAR(a.draft, b.draft, 1e-7);
    expect_balance(b, far_body, tilted);
    // B's origin is on the vertical through W's origin.
    EXPECT_LT(b.pose.p_WB.cross(tilted.up_W).norm(), 1e-9);
  }
}

// On a sphere of attitudes, minima - saddle points + maxima = 2.
TEST(Equilibrium, FindsUnstableAttitudesThatCompleteTheSphere) {
  EquilibriumOptions options;
  options.unstable = true;
  for (const std::uint64_t seed : {1U, 2U, 3U, 5U}) {
    SCOPED_TRACE(seed);
    const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 5, .roughness = 0.4, .seed = seed});
    const FloatingBody body = body_of(mesh, 0.4);
    const Equilibria found = find_equilibria(body, kWater, options);
    int characteristic = 0;
    std::size_t stable = 0;
    for (const Equilibrium& at : found.attitudes) {
      characteristic += at.unstable_directions == 1 ? -1 : 1;
      if (at.is_stable()) ++stable;
      EXPECT_EQ(at.unstable_directions > 0, at.stiffness[0] < 0.0);
      EXPECT_LE(at.residual_torque, at.torque_bound);
    }
    EXPECT_EQ(characteristic, 2);
    EXPECT_EQ(find_equilibria(body, kWater).attitudes.size(), stable);
  }
}

TEST(Equilibrium, ReportsItsProgress) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{80, 20, 12}, {2, 2, 2}});
  EquilibriumOptions options;
  std::int64_t last = 0;
  std::int64_t last_total = 0;
  options.progress = [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(done, last + 1);
    EXPECT_LE(done, total);
    last = done;
    last_total = total;
  };
  find_equilibria(body_of(mesh, 0.5), kWater, options);
  EXPECT_GE(last, 24);
  EXPECT_EQ(last, last_total);
}

TEST(Equilibrium, SaysWhatSinksAndWhatIsNeutral) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  EXPECT_EQ(find_equilibria(body_of(mesh, 1.001), kWater).outcome, FlotationOutcome::kSinks);
  EXPECT_EQ(find_equilibria(body_of(mesh, 1.0), kWater).outcome, FlotationOutcome::kNeutral);
  const Equilibria nearly = find_equilibria(body_of(mesh, 1.0 - 1e-8), kWater);
  EXPECT_EQ(nearly.outcome, FlotationOutcome::kFloats);
  EXPECT_FALSE(nearly.attitudes.empty());
  EXPECT_FALSE(find_equilibrium_from(body_of(mesh, 1.001), kWater, Eigen::Quaterniond::Identity()));
}

TEST(Equilibrium, ReportsNothingThatDoesNotBalance) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  const Equilibria found = find_equilibria(body_of(mesh, 0.5, Vec3(1e200, 0, 0)), kWater);
  EXPECT_EQ(found.outcome, FlotationOutcome::kOutOfRange);
  EXPECT_TRUE(found.attitudes.empty());
}

TEST(Equilibrium, FloatsOpenHullUntilItTakesInWater) {
  TriangleMesh hull = make_shape(BoxShape{{4, 2, 1}, {2, 2, 2}});
  std::erase_if(hull.triangles, [&](const Triangle& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](std::int32_t i) { return hull.vertex(i).z() > 0.49; });
  });
  const ValidatedMesh open =
      validate_mesh({hull, {}}, "hull", {.open = OpenPolicy::kDryBoundary}).mesh.value();
  const HydrostaticMesh mesh = make_hydrostatic_mesh(open);
  ASSERT_TRUE(mesh.is_open());
  const PlacedMesh placed{.mesh = &mesh};
  const auto outcome_of = [&](double mass, double height) {
    return find_equilibria(FloatingBody::make({&placed, 1}, mass, Vec3(0, 0, height)).value(), kWater);
  };
  const Equilibria found = outcome_of(4.0 * 1025.0, 0.0);
  ASSERT_EQ(found.attitudes.size(), 1U);
  EXPECT_NEAR(found.attitudes[0].draft, 0.5, 1e-12);
  EXPECT_EQ(outcome_of(8.5 * 1025.0, 0.0).outcome, FlotationOutcome::kTakesInWater);
  EXPECT_EQ(outcome_of(4.0 * 1025.0, 3.0).outcome, FlotationOutcome::kTakesInWater);
}

}  // namespace
}  // namespace buoyancy
