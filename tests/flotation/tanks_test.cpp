// Floating bodies with liquid in tanks, beside flooded compartments.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "flotation/displaced_sum.h"
#include "flotation/equilibrium.h"
#include "flotation/righting_arms.h"
#include "tests/flotation/bodies.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Water kWater;

FloatingBody with_tanks(const HydrostaticMesh& hull, double mass, const Vec3& center_B,
                        const std::vector<Tank>& tanks) {
  const PlacedMesh placed{.mesh = &hull};
  return FloatingBody::make({&placed, 1}, mass, center_B, tanks).value();
}

HydrostaticMesh box_at(const BoxShape& shape, const Vec3& position_B) {
  return make_hydrostatic_mesh({moved_and_scaled(make_shape(shape), position_B), {}});
}

TEST(FloatingBodyWithTanks, HasTheGradientOfItsEnergy) {
  const HydrostaticMesh hull = mesh_of(RockShape{.radius = 2.0, .frequency = 8});
  const HydrostaticMesh tank = box_at({{1.5, 1.0, 0.8}}, {0.2, -0.3, 0.1});
  RandomPoses random(51);
  const FloatingBody body = with_tanks(hull, 0.4 * 1025.0 * hull.volume, {0.1, 0.2, -0.1},
                                       {{.mesh = &tank, .liquid_volume = 0.4, .density = 900.0}});
  EXPECT_EQ(body.total_mass(), body.mass() + 360.0);
  for (int i = 0; i < 30; ++i) {
    const Pose pose = random.crossing({hull.box_min + hull.center_B, hull.box_max + hull.center_B}, kWater);
    const Vec3 axis = random.direction();
    const Vec3 along = random.direction();
    const double step = 1e-5;
    const auto energy = [&](double angle, double distance) {
      Pose moved = pose;
      const Vec3 center_W = pose.p_WB + pose.q_WB * body.center_of_mass_B();
      moved.q_WB = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * pose.q_WB;
      moved.p_WB = center_W - moved.q_WB * body.center_of_mass_B() + distance * along;
      return floating_state(body, moved, kWater).value().energy;
    };
    const FloatingState state = floating_state(body, pose, kWater).value();
    const double torque = -(energy(step, 0.0) - energy(-step, 0.0)) / (2.0 * step);
    const double force = -(energy(0.0, step) - energy(0.0, -step)) / (2.0 * step);
    EXPECT_NEAR(state.torque_W.dot(axis), torque, 0.1) << i;
    EXPECT_NEAR(state.force_W.dot(along), force, 0.1) << i;
  }
}

TEST(FloatingBodyWithTanks, HasTheMetacentricHeightOfItsArms) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{20, 8, 4}});
  const HydrostaticMesh tank = box_at({{6, 7, 2}}, {1.0, 0.0, -0.8});
  const double volume = 0.5 * tank.volume;
  const FloatingBody body = with_tanks(hull, 250e3, {0, 0, 0.2}, {{&tank, volume, 900.0}});
  const double total = 250e3 + 900.0 * volume;
  const double draft = total / (1025.0 * 160.0);
  const double kg = (250e3 * 2.2 + 900.0 * volume * (2.0 - 1.8 + 0.5)) / total;
  const double free_surface = 900.0 * (6.0 * 343.0 / 12.0) / total;
  const double gm = 0.5 * draft + 64.0 / (12.0 * draft) - kg - free_surface;

  RightingArmOptions fixed;
  fixed.fixed_trim = 0.0;
  const double heel = 1e-5;
  const RightingArm arm = righting_arm(body, kWater, heel, fixed).value();
  EXPECT_NEAR(arm.gz / heel, gm, 1e-6);
  const auto upright = righting_arm(body, kWater, 0.0, fixed);
  ASSERT_TRUE(upright);
  EXPECT_NEAR(upright->draft, draft, 1e-12);
  const auto afloat = find_equilibrium_from(body, kWater, Eigen::Quaterniond::Identity());
  ASSERT_TRUE(afloat);
  // The tank lies forward of the middle, so that the body trims a little.
  EXPECT_NEAR(afloat->state.hydrostatics.metacentric_heights[0], gm, 1e-2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(afloat->stiffness[i],
                total * kWater.gravity * afloat->state.hydrostatics.metacentric_heights[i],
                1e-9 * afloat->stiffness[1]);
  }
  // Wall-sided, hull and tank alike: GZ = sin (GM + BM tan^2 / 2), with BM less that of the tank.
  const double bm = 64.0 / (12.0 * draft) - free_surface;
  for (const double degrees : {2.0, 5.0, 8.0}) {
    const double tangent = std::tan(degrees * kDegree);
    const RightingArm at = righting_arm(body, kWater, degrees * kDegree, fixed).value();
    EXPECT_NEAR(at.gz, std::sin(degrees * kDegree) * (gm + 0.5 * bm * tangent * tangent), 1e-11) << degrees;
  }
}

// One view: the flooded space no longer belongs to the ship. The other: the water in it is weight on board.
TEST(FloatingBodyWithTanks, RightsAlikeByLostBuoyancyAndAddedWeight) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{20, 8, 4}});
  const HydrostaticMesh room = box_at({{4, 8, 3}}, {0.0, 0.0, -0.5});
  const std::vector<PlacedMesh> lost{{.mesh = &hull}, {.mesh = &room, .signed_permeability = -1.0}};
  const double mass = 200e3;
  const FloatingBody by_lost_buoyancy = FloatingBody::make(lost, mass, {0, 0, -0.4}).value();
  for (const double degrees : {0.0, 5.0, 15.0, 30.0, 60.0}) {
    const RightingArm arm = righting_arm(by_lost_buoyancy, kWater, degrees * kDegree).value();
    // The water that stands in the room at this attitude.
    const Vec3 up_B = up_at({}, {arm.heel, arm.trim});
    const double height = arm.draft + lowest_along(by_lost_buoyancy, up_B);
    const WaterPlane sea{.up_B = up_B, .h_c = height + up_B.dot(hull.center_B - room.center_B)};
    const double volume = immersed_part(room, sea).moments.volume;
    const FloatingBody by_added_weight = with_tanks(hull, mass, {0, 0, -0.4}, {{&room, volume, 1025.0}});
    const RightingArm added = righting_arm(by_added_weight, kWater, degrees * kDegree).value();
    EXPECT_NEAR(added.draft, arm.draft, 1e-11) << degrees;
    EXPECT_NEAR(added.gz * by_added_weight.total_mass(), arm.gz * mass, 1e-11 * mass) << degrees;
  }
}

TEST(FloatingBodyWithTanks, RejectsLiquidThatDoesNotFit) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{2, 2, 2}});
  const HydrostaticMesh tank = mesh_of(BoxShape{{1, 1, 1}});
  const PlacedMesh placed{.mesh = &hull};
  const auto error_of = [&](const Tank& bad) {
    const auto body = FloatingBody::make({&placed, 1}, 100.0, Vec3::Zero(), {&bad, 1});
    return body ? std::string("accepted") : body.error().message();
  };
  EXPECT_TRUE(contains(error_of({&tank, 1.5, 1000.0}), "1.5 m^3"));
  EXPECT_TRUE(contains(error_of({&tank, -0.1, 1000.0}), "-0.1 m^3"));
  EXPECT_TRUE(contains(error_of({&tank, 0.5, -1.0}), "density -1"));
  EXPECT_TRUE(contains(error_of({nullptr, 0.5, 1.0}), "mesh"));
  EXPECT_EQ(error_of({&tank, 1.0, 1000.0}), "accepted");
}

TEST(FloatingBodyWithTanks, FloatsWithAPistonAsWithASolid) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{20, 8, 4}});
  const HydrostaticMesh tank = box_at({{6, 3, 2}}, {4.0, 1.0, -0.8});
  const double liquid = 9.0 * 900.0;  // [kg], a quarter of the tank
  const FloatingBody body =
      with_tanks(hull, 250e3, {0, 0, 0.2},
                 {{.mesh = &tank, .liquid_volume = 9.0, .density = 900.0, .piston_axis_B = Vec3::UnitX()}});
  const double total = 250e3 + liquid;
  const Vec3 center_B = (250e3 * Vec3(0, 0, 0.2) + liquid * Vec3(1.0 + 0.75, 1.0, -0.8)) / total;
  const FloatingBody solid = with_tanks(hull, total, center_B, {});

  RandomPoses random(52);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = random.crossing({hull.box_min + hull.center_B, hull.box_max + hull.center_B}, kWater);
    const FloatingState a = floating_state(body, pose, kWater).value();
    const FloatingState b = floating_state(solid, pose, kWater).value();
    EXPECT_LE((a.force_W - b.force_W).norm(), 1e-12 * total * kWater.gravity) << i;
    // Each torque is about the centre of the mass that is no liquid.
    const Vec3 arm_W = pose.q_WB * (center_B - body.center_of_mass_B());
    EXPECT_LE((a.torque_W - arm_W.cross(a.force_W) - b.torque_W).norm(), 1e-11 * total * kWater.gravity) << i;
  }
  const auto afloat = find_equilibrium_from(body, kWater, Eigen::Quaterniond::Identity());
  const auto expected = find_equilibrium_from(solid, kWater, Eigen::Quaterniond::Identity());
  ASSERT_TRUE(afloat && expected);
  EXPECT_NEAR(afloat->angles.heel, expected->angles.heel, 1e-10);
  EXPECT_NEAR(afloat->angles.trim, expected->angles.trim, 1e-10);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(afloat->stiffness[i], expected->stiffness[i], 1e-9 * expected->stiffness[1]);
  }
}

TEST(FloatingBodyWithTanks, RejectsAPistonAxisThatIsNoUnitVector) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{2, 2, 2}});
  const PlacedMesh placed{.mesh = &hull};
  const Tank bad{.mesh = &hull, .liquid_volume = 0.5, .density = 1.0, .piston_axis_B = Vec3(1, 1, 0)};
  const auto body = FloatingBody::make({&placed, 1}, 100.0, Vec3::Zero(), {&bad, 1});
  ASSERT_FALSE(body);
  EXPECT_TRUE(contains(body.error().message(), "piston axis"));
}

}  // namespace
}  // namespace buoyancy
