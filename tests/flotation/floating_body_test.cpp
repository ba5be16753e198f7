#include "flotation/floating_body.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "flotation/equilibrium.h"
#include "flotation/ship_axes.h"
#include "hydrostatics/buoyancy.h"
#include "tests/flotation/bodies.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

const Water kWater;

FloatingState state_of(const FloatingBody& body, const Pose& pose) {
  const std::optional<FloatingState> state = floating_state(body, pose, kWater);
  EXPECT_TRUE(state);
  return state.value_or(FloatingState{});
}

// Compares everything that is defined at a pose that pierces the surface.
void expect_same(const FloatingState& a, const FloatingState& b, double tolerance) {
  EXPECT_NEAR(a.hydrostatics.volume, b.hydrostatics.volume, tolerance);
  EXPECT_LE((a.hydrostatics.center_of_buoyancy_W - b.hydrostatics.center_of_buoyancy_W).norm(), tolerance);
  EXPECT_NEAR(a.hydrostatics.waterplane_area, b.hydrostatics.waterplane_area, tolerance);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(a.hydrostatics.waterplane_second_moments[i], b.hydrostatics.waterplane_second_moments[i],
                tolerance);
    EXPECT_NEAR(a.hydrostatics.metacentric_heights[i], b.hydrostatics.metacentric_heights[i], 10 * tolerance);
  }
  const double weight = kWater.density * kWater.gravity;
  EXPECT_NEAR(a.energy, b.energy, weight * tolerance);
  EXPECT_LE((a.force_W - b.force_W).norm(), weight * tolerance);
  EXPECT_LE((a.torque_W - b.torque_W).norm(), weight * tolerance);
  EXPECT_LE((a.hydrostatics.stiffness - b.hydrostatics.stiffness).norm(), 10 * weight * tolerance);
}

TEST(FloatingBody, HasTheHydrostaticsAndTheWrenchOfItsMesh) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 6, .roughness = 0.5, .seed = 2});
  const Vec3 center_of_mass_B(0.1, -0.2, 0.3);
  const FloatingBody body = body_of(mesh, 0.5, center_of_mass_B);
  const Solver solver(mesh, Method::kHierarchical);
  RandomPoses random(3);
  for (int i = 0; i < 50; ++i) {
    const Pose pose = random.crossing(bounding_box(mesh.surface), kWater);
    const FloatingState state = state_of(body, pose);
    const auto expected = hydrostatics(mesh, pose, kWater, center_of_mass_B, center_of_mass_B);
    EXPECT_EQ(state.hydrostatics.volume, expected->volume);
    EXPECT_EQ(state.hydrostatics.stiffness, expected->stiffness);
    EXPECT_EQ(state.hydrostatics.wetted_area, expected->wetted_area);
    const BuoyancyResult wrench = buoyancy(solver, pose, kWater, center_of_mass_B);
    const double weight = body.mass() * kWater.gravity;
    EXPECT_LE((state.force_W + weight * Vec3::UnitZ() - wrench.force_W).norm(),
              2.0 * state.force_error_bound);
    EXPECT_LE((state.torque_W - wrench.torque_W).norm(), 2.0 * state.torque_error_bound);
    EXPECT_GE(state.force_error_bound, wrench.force_error_bound);
    if (wrench.immersion == Immersion::kDry) continue;
    EXPECT_LE(state.torque_error_bound, 1.01 * wrench.torque_error_bound);
  }
}

// Of a hull at B's origin and far from it, of a compartment that is turned, or turned and moved, and of a
// tank.
TEST(FloatingBody, AddsTheBoundsOfItsMeshesAndTanks) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  for (const auto& [scale, distance] : {std::pair{1e-3, 1.0}, {1.0, 1.0}, {1.0, 0.0}, {1e3, 1.0}}) {
    const HydrostaticMesh hull = mesh_of(SphereShape{scale, 12});
    const HydrostaticMesh room = mesh_of(BoxShape{{0.5 * scale, 0.4 * scale, 0.3 * scale}, {2, 2, 2}});
    const HydrostaticMesh tank_mesh = mesh_of(SphereShape{0.2 * scale, 12});
    const Vec3 far = scale * distance * Vec3(300, -200, 100);
    const std::array<PlacedMesh, 2> meshes{
        PlacedMesh{.mesh = &hull, .position_B = far},
        PlacedMesh{.mesh = &room,
                   .position_B = far + scale * distance * Vec3(0.2, 0.1, -0.1),
                   .orientation_B = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2),
                   .signed_permeability = -0.6}};
    const std::array<Tank, 1> tanks{
        Tank{.mesh = &tank_mesh, .liquid_volume = 0.4 * tank_mesh.volume, .density = 900.0}};
    const Vec3 center_of_mass_B = far + scale * Vec3(0.5, -0.3, 0.2);
    const Water water{.level = 4.0 * scale, .density = 1025.0, .gravity = 9.8};
    const FloatingBody body =
        FloatingBody::make(meshes, 0.4 * water.density * hull.volume, center_of_mass_B, tanks).value();
    const Vec3 center_B = hull.center_B + far;
    double volume = 0.0;
    double moment = 0.0;
    for (const PlacedMesh& placed : meshes) {
      const HydrostaticMesh& mesh = *placed.mesh;
      const Mat3 R = placed.orientation_B.normalized().toRotationMatrix();
      const double offset = (R * mesh.center_B + placed.position_B - center_B).norm();
      const bool is_moved = distance > 0.0 || placed.signed_permeability < 0.0;
      const double moved = is_moved ? mesh.diagonal + offset + placed.position_B.norm() : 0.0;
      const double bound =
          std::abs(placed.signed_permeability) * (mesh.rounding_bound() + 4.0 * kEpsilon * mesh.area * moved);
      volume += bound;
      moment += bound * mesh.max_lever_arm(R.transpose() * (center_of_mass_B - placed.position_B));
    }
    const double liquid =
        2.0 * 900.0 * tank_mesh.rounding_bound() * tank_mesh.max_lever_arm(center_of_mass_B);
    const double weight = water.gravity * body.total_mass();
    RandomPoses random(9);
    for (int i = 0; i < 5; ++i) {
      const Pose pose = random.crossing({center_B + hull.box_min, center_B + hull.box_max}, water);
      const FloatingState state = floating_state(body, pose, water).value();
      const double specific_weight = water.density * water.gravity;
      EXPECT_NEAR(state.force_error_bound / (specific_weight * volume + kEpsilon * weight), 1.0, 1e-9);
      EXPECT_NEAR(state.torque_error_bound / (specific_weight * moment + water.gravity * liquid), 1.0, 1e-9);
    }
  }
}

// Two boxes side by side, one of them turned, are the box that they make up.
TEST(FloatingBody, OfTwoPartsIsTheBodyOfTheirUnion) {
  const HydrostaticMesh whole = mesh_of(BoxShape{{4, 2, 1}, {1, 1, 1}});
  const HydrostaticMesh aft = mesh_of(BoxShape{{1, 2, 1}, {1, 1, 1}});
  const HydrostaticMesh forward = mesh_of(BoxShape{{2, 3, 1}, {1, 1, 1}});
  const std::array<PlacedMesh, 2> parts{PlacedMesh{.mesh = &aft, .position_B = Vec3(-1.5, 0, 0)},
                                        PlacedMesh{.mesh = &forward,
                                                   .position_B = Vec3(0.5, 0, 0),
                                                   .orientation_B = Eigen::Quaterniond(Eigen::AngleAxisd(
                                                       std::numbers::pi / 2, Vec3::UnitZ()))}};
  const Vec3 center_of_mass_B(0.2, 0.1, 0.1);
  const double mass = 3.0 * kWater.density;
  const FloatingBody body = FloatingBody::make(parts, mass, center_of_mass_B).value();
  const PlacedMesh single{.mesh = &whole};
  const FloatingBody expected = FloatingBody::make({&single, 1}, mass, center_of_mass_B).value();
  EXPECT_NEAR(body.volume(), 8.0, 1e-14);
  RandomPoses random(7);
  for (int i = 0; i < 50; ++i) {
    const Pose pose = random.crossing(bounding_box(whole.surface), kWater);
    const FloatingState state = state_of(expected, pose);
    if (state.hydrostatics.volume < 1e-2) continue;
    expect_same(state_of(body, pose), state, 2e-12);
    const Vec3 up_B = pose.q_WB.conjugate() * kWater.up_W;
    EXPECT_NEAR(lowest_along(body, up_B) + up_B.dot(body.center_B()), lowest_along(expected, up_B), 1e-14);
  }
}

// A compartment of permeability 1 over the full section is the hull with it cut out.
TEST(FloatingBody, WithFloodedCompartmentIsTheHullWithoutIt) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{6, 2, 1}, {1, 1, 1}});
  const HydrostaticMesh compartment = mesh_of(BoxShape{{2, 2, 1}, {1, 1, 1}});
  const HydrostaticMesh end = mesh_of(BoxShape{{2, 2, 1}, {1, 1, 1}});
  const std::array<PlacedMesh, 2> flooded{PlacedMesh{.mesh = &hull},
                                          PlacedMesh{.mesh = &compartment, .signed_permeability = -1.0}};
  const std::array<PlacedMesh, 2> cut{PlacedMesh{.mesh = &end, .position_B = Vec3(-2, 0, 0)},
                                      PlacedMesh{.mesh = &end, .position_B = Vec3(2, 0, 0)}};
  const FloatingBody body = FloatingBody::make(flooded, 4000.0, Vec3(0, 0, 0.1)).value();
  const FloatingBody expected = FloatingBody::make(cut, 4000.0, Vec3(0, 0, 0.1)).value();
  RandomPoses random(8);
  for (int i = 0; i < 50; ++i) {
    const Pose pose = random.crossing(bounding_box(hull.surface), kWater);
    const FloatingState state = state_of(expected, pose);
    if (state.hydrostatics.volume < 1e-2) continue;
    expect_same(state_of(body, pose), state, 2e-12);
  }
}

// T' = T L/(L - mu l) for a compartment of length l over the full section.
TEST(FloatingBody, SinksToTheDraughtOfLostBuoyancy) {
  const double length = 60.0;
  const double flooded_length = 12.0;
  const HydrostaticMesh hull = mesh_of(BoxShape{{length, 20, 12}, {1, 1, 1}});
  const HydrostaticMesh compartment = mesh_of(BoxShape{{flooded_length, 20, 12}, {1, 1, 1}});
  for (const double permeability : {0.5, 0.85, 1.0}) {
    const std::array<PlacedMesh, 2> meshes{
        PlacedMesh{.mesh = &hull}, PlacedMesh{.mesh = &compartment, .signed_permeability = -permeability}};
    const double draft = 6.0;
    const double mass = kWater.density * length * 20.0 * draft;
    const FloatingBody body = FloatingBody::make(meshes, mass, Vec3(0, 0, -3.0)).value();
    const auto found = find_equilibrium_from(body, kWater, Eigen::Quaterniond::Identity());
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->draft, draft * length / (length - permeability * flooded_length), 1e-11);
    EXPECT_NEAR(found->angles.trim, 0.0, 1e-11);
    EXPECT_LE(found->residual_force, found->force_bound);
    EXPECT_LE(found->residual_torque, found->torque_bound);
    for (std::size_t i = 0; i < 2; ++i) {
      const double expected = mass * kWater.gravity * found->state.hydrostatics.metacentric_heights[i];
      EXPECT_NEAR(found->stiffness[i], expected, 1e-11 * mass * kWater.gravity * length);
    }
  }
}

TEST(FloatingBody, RejectsWhatIsNoBody) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  const HydrostaticMesh without_tree = make_hydrostatic_mesh({make_shape(BoxShape{}), {}}, WithTree::kNo);
  const auto make = [](PlacedMesh placed, double mass) {
    return FloatingBody::make({&placed, 1}, mass, Vec3::Zero());
  };
  EXPECT_TRUE(make({.mesh = &mesh}, 1.0));
  EXPECT_FALSE(make({.mesh = &mesh}, 0.0));
  EXPECT_FALSE(make({.mesh = &mesh}, std::nan("")));
  EXPECT_FALSE(make({.mesh = &mesh, .signed_permeability = 0.5}, 1.0));
  EXPECT_FALSE(make({.mesh = &mesh, .signed_permeability = -0.5}, 1.0));  // a compartment alone
  EXPECT_FALSE(make({.mesh = &without_tree}, 1.0));
  EXPECT_FALSE(make({}, 1.0));
  EXPECT_FALSE(FloatingBody::make({}, 1.0, Vec3::Zero()));
  const auto error = make({.mesh = &mesh, .signed_permeability = 0.5}, 1.0).error();
  EXPECT_TRUE(contains(error.message(), "0.5"));
}

TEST(ShipAxes, ConvertBetweenHeelTrimAndUp) {
  const ShipAxes axes = make_ship_axes(-Vec3::UnitY(), Vec3::UnitX()).value();
  const Vec3 up_W = Vec3(0.36, 0.48, 0.8);
  for (const double heel : {-3.0, -1.0, 0.0, 0.5, 2.0}) {
    for (const double trim : {-1.2, -0.1, 0.0, 0.7}) {
      const Vec3 up_B = up_at(axes, {heel, trim});
      const HeelTrim found = heel_trim_of(axes, up_B);
      EXPECT_NEAR(found.heel, heel, 1e-14);
      EXPECT_NEAR(found.trim, trim, 1e-14);
      const Eigen::Quaterniond q = attitude_at(axes, {heel, trim}, up_W);
      EXPECT_LT((q * up_B - up_W).norm(), 1e-15);
      // Forward lies over W's x axis, the bow is up by the trim, and starboard is down by the heel.
      const Vec3 forward_W = q * axes.forward_B;
      EXPECT_NEAR(forward_W.dot(up_W), std::sin(trim), 1e-14);
      EXPECT_NEAR(up_W.cross(forward_W).dot(Vec3::UnitX()), 0.0, 1e-14);
      EXPECT_GT(forward_W.x(), 0.0);
      EXPECT_NEAR((q * axes.port_B()).dot(up_W), std::cos(trim) * std::sin(heel), 1e-14);
      const Vec3 starboard_W = q * starboard_at(axes, heel);
      EXPECT_NEAR(starboard_W.dot(up_W), 0.0, 1e-14);
      EXPECT_NEAR(starboard_W.dot(forward_W), 0.0, 1e-14);
    }
  }
}

TEST(ShipAxes, RejectsDirectionsThatAreNoAxes) {
  EXPECT_FALSE(make_ship_axes(Vec3::Zero(), Vec3::UnitZ()));
  EXPECT_FALSE(make_ship_axes(Vec3::UnitX(), Vec3(0, std::nan(""), 1)));
  EXPECT_FALSE(make_ship_axes(Vec3::UnitX(), Vec3(1, 0, 1)));
  const auto axes = make_ship_axes(Vec3(2, 0, 0), Vec3(0, 0, 1e-3));
  ASSERT_TRUE(axes);
  EXPECT_EQ(axes->port_B(), Vec3::UnitY());
}

}  // namespace
}  // namespace buoyancy
