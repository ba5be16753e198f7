// Where and how bodies float in layered water.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "flotation/balance.h"
#include "flotation/ballast.h"
#include "flotation/displaced_parts.h"
#include "flotation/equilibrium.h"
#include "flotation/hydrostatic_table.h"
#include "flotation/righting_arms.h"
#include "tests/flotation/bodies.h"

namespace buoyancy {
namespace {

// Two metres of fuel on water, and brine on the ground.
const Water kFuelOnWater{.level = 1.5, .density = 850.0, .layers = {{-0.5, 1000.0}, {-20.0, 1200.0}}};

FloatingBody body_with_density(const HydrostaticMesh& mesh, double density,
                               const Vec3& center_of_mass_B = Vec3::Zero()) {
  const PlacedMesh placed{.mesh = &mesh};
  return FloatingBody::make({&placed, 1}, density * mesh.volume, center_of_mass_B).value();
}

// A cylinder of radius 1 m and height 0.8 m with its axis upright.
const CylinderShape kDisc{.radius = 1.0, .height = 0.8, .segments = 48};

// Its draft follows from its mass: m = A sum of the densities times the heights in each water.
TEST(LayeredFlotation, ACylinderHasTheDraftOfItsMass) {
  const HydrostaticMesh mesh = mesh_of(kDisc);
  struct Case {
    double density;
    double depth;  // [m], of the base under the surface
  };
  const double height = 0.8;
  for (const Case& at : {Case{425.0, 0.5 * height},                  // at the surface
                         Case{880.0, 2.0 + 0.2 * height},            // on the water
                         Case{980.0, 2.0 + 130.0 / 150.0 * height},  // on the water
                         Case{1100.0, 21.5 + 0.5 * height}}) {       // on the brine
    const FloatingBody body = body_with_density(mesh, at.density);
    const auto found = find_equilibrium_from(body, kFuelOnWater, Eigen::Quaterniond::Identity());
    ASSERT_TRUE(found) << at.density;
    EXPECT_TRUE(found->is_stable()) << at.density;
    EXPECT_NEAR(found->draft, at.depth, 1e-12) << at.density;
    EXPECT_NEAR(found->pose.p_WB.z(), 1.5 - at.depth + 0.5 * height, 1e-12) << at.density;
    EXPECT_NEAR(found->state.hydrostatics.density * found->state.hydrostatics.volume, body.mass(), 1e-9);
    EXPECT_LE(found->residual_force, found->force_bound) << at.density;
    EXPECT_LE(found->residual_torque, found->torque_bound) << at.density;
  }
}

TEST(LayeredFlotation, TheDeepestDensityDecidesWhatSinks) {
  const HydrostaticMesh mesh = mesh_of(kDisc);
  const auto outcome = [&](double density) {
    return find_equilibria(body_with_density(mesh, density), kFuelOnWater).outcome;
  };
  EXPECT_EQ(outcome(1199.0), FlotationOutcome::kFloats);
  EXPECT_EQ(outcome(1200.0), FlotationOutcome::kNeutral);
  EXPECT_EQ(outcome(1201.0), FlotationOutcome::kSinks);
}

// On the water under the fuel: KB is that of the displaced mass, and only the step of density has a
// waterplane.
TEST(LayeredFlotation, OnAnInterfaceHasTheMetacentricHeightOfItsStep) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{4, 2, 1}, {2, 2, 2}});
  const Vec3 center_of_mass_B(0, 0, -0.2);
  const FloatingBody body = body_with_density(mesh, 940.0, center_of_mass_B);
  const auto found = find_equilibrium_from(body, kFuelOnWater, Eigen::Quaterniond::Identity());
  ASSERT_TRUE(found);
  const double in_water = 90.0 / 150.0;  // [m], of its height
  const double kb =
      (850.0 * (1.0 - in_water) * (1.0 - 0.5 * (1.0 - in_water)) + 1000.0 * in_water * 0.5 * in_water) /
      940.0;
  const double gm = kb - 0.3 + 150.0 * 4.0 * 8.0 / 12.0 / body.mass();
  EXPECT_NEAR(found->state.hydrostatics.metacentric_heights[0], gm, 1e-11);
  EXPECT_NEAR(found->stiffness[0], body.mass() * kStandardGravity * gm, 1e-6);
  EXPECT_NEAR(upright_metacentric_height(body, kFuelOnWater).value(), gm, 1e-7);
}

// Force and torque are minus the derivatives of the energy, within the water that the body leaves as well as
// at the surface.
TEST(LayeredFlotation, ForcesAreTheSlopeOfTheEnergy) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 10, .seed = 2});
  const FloatingBody body = body_with_density(mesh, 900.0, Vec3(0.1, -0.05, 0.02));
  for (const double height : {1.6, 0.6, -0.4, -0.7, -5.0, -20.2, -30.0}) {
    const Pose pose{Vec3(2, 3, height), Eigen::Quaterniond(0.9, 0.3, -0.2, 0.1).normalized()};
    const auto here = floating_state(body, pose, kFuelOnWater);
    ASSERT_TRUE(here);
    const double step = 1e-4;
    const double scale = body.mass() * kStandardGravity;
    for (int i = 0; i < 4; ++i) {
      const auto energy_at = [&](double by) {
        Pose moved = pose;
        if (i == 3) {
          moved.p_WB.z() += by;
        } else {
          const Eigen::Quaterniond turn(Eigen::AngleAxisd(by, Vec3::Unit(i)));
          const Vec3 center_W = pose.q_WB * body.center_of_mass_B();
          moved.q_WB = turn * pose.q_WB;
          moved.p_WB += center_W - turn * center_W;
        }
        return floating_state(body, moved, kFuelOnWater)->energy;
      };
      const double slope = (energy_at(-step) - energy_at(step)) / (2.0 * step);
      EXPECT_NEAR(slope, i == 3 ? here->force_W.z() : here->torque_W[i], 1e-6 * scale) << height << ' ' << i;
    }
  }
}

// The same attitudes, and at each its own height: a body that does not fit into the fuel lies across it.
TEST(LayeredFlotation, FindsTheAttitudesOfABoxAcrossThreeWaters) {
  const Water thin{.level = 0.0, .density = 700.0, .layers = {{-0.1, 900.0}, {-0.25, 1000.0}}};
  const HydrostaticMesh mesh = mesh_of(BoxShape{{2, 1.2, 1}, {2, 2, 2}});
  const FloatingBody body = body_with_density(mesh, 600.0, Vec3(0.02, 0.01, -0.05));
  const Equilibria found = find_equilibria(body, thin, {.unstable = true});
  EXPECT_EQ(found.outcome, FlotationOutcome::kFloats);
  ASSERT_GE(found.attitudes.size(), 6U);
  int sum = 0;  // minima - saddle points + maxima of a function on the sphere
  for (const Equilibrium& at : found.attitudes) {
    EXPECT_LE(at.residual_force, at.force_bound);
    EXPECT_LE(at.residual_torque, at.torque_bound);
    EXPECT_NEAR(at.state.hydrostatics.density * at.state.hydrostatics.volume, body.mass(), 1e-8);
    sum += at.unstable_directions == 1 ? -1 : 1;
  }
  EXPECT_EQ(sum, 2);
}

// What corrects an attitude for an allowed error of its volume holds for one waterplane.
TEST(LayeredFlotation, BalancesExactlyWhateverTheSlack) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{4, 2, 1}, {2, 2, 2}});
  const FloatingBody body = body_with_density(mesh, 940.0);
  const Balance balance(body, kFuelOnWater);
  const std::optional<BalancedAttitude> at = balance.at(Vec3::UnitZ(), nullptr, balance.start_slack());
  ASSERT_TRUE(at);
  EXPECT_TRUE(at->is_exact);
  EXPECT_EQ(at->excess, 0.0);
  EXPECT_NEAR(at->height, -2.1, 1e-12);  // 0.6 m of its height lie in the water
}

// The area under the arm is the work of the heel, over the weight.
TEST(LayeredFlotation, RightingArmsAreTheSlopeOfTheEnergy) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{4, 2, 1}, {2, 2, 2}});
  const FloatingBody body = body_with_density(mesh, 940.0, Vec3(0, 0, -0.2));
  std::vector<double> heels;
  for (int i = 0; i <= 60; ++i) heels.push_back(0.01 * i);
  const auto curve = righting_curve(body, kFuelOnWater, heels);
  ASSERT_TRUE(curve);
  double area = 0.0;
  for (std::size_t i = 1; i < curve->points.size(); ++i) {
    const auto& [arm, of_energy] = curve->points[i];
    area += 0.005 * (arm.gz + curve->points[i - 1].arm.gz);
    EXPECT_NEAR(of_energy, area, 1e-5) << arm.heel;
  }
  EXPECT_GT(area, 0.01);
}

TEST(LayeredFlotation, ATableOfABoxHasItsClosedForm) {
  const Water water{.density = 1000.0, .layers = {{-0.4, 1025.0}}};
  const HydrostaticMesh mesh = mesh_of(BoxShape{{4, 2, 1}, {2, 2, 2}});
  const FloatingBody body = body_with_density(mesh, 500.0);
  const HydrostaticTable table = HydrostaticTable::make(body, water).value();
  for (const double draft : {0.3, 0.4, 0.7, 0.9}) {
    const auto row = table.row(draft);
    ASSERT_TRUE(row);
    const double salt = std::max(0.0, draft - 0.4);
    const double mass = 8.0 * (1000.0 * (draft - salt) + 1025.0 * salt);
    const double density = mass / (8.0 * draft);
    const double step = salt > 0.0 ? 1025.0 : 1000.0;
    EXPECT_NEAR(row->volume, 8.0 * draft, 1e-12);
    EXPECT_NEAR(row->mass, mass, 1e-9);
    EXPECT_NEAR(row->kb, 8.0 * (1000.0 * (draft - salt) * 0.5 * (draft + salt) + 512.5 * salt * salt) / mass,
                1e-12);
    EXPECT_NEAR(row->waterplane_area, 8.0 * step / density, 1e-11);
    EXPECT_NEAR(row->bm_t, step * (4.0 * 8.0 / 12.0) / mass, 1e-12);
    EXPECT_NEAR(row->mass_per_cm, 0.08 * step, 1e-9);
    EXPECT_NEAR(row->lwl, 4.0, 1e-12);
    EXPECT_NEAR(row->wetted_area, 8.0 + 12.0 * draft, 1e-11);
  }
}

TEST(LayeredFlotation, BallastBringsABodyToItsDraft) {
  const Water water{.density = 1000.0, .layers = {{-0.4, 1025.0}}};
  const HydrostaticMesh mesh = mesh_of(BoxShape{{4, 2, 1}, {2, 2, 2}});
  const FloatingBody body = body_with_density(mesh, 300.0);
  const auto ballast = find_ballast(body, water, {.draft = 0.7});
  ASSERT_TRUE(ballast) << ballast.error().message();
  EXPECT_NEAR(ballast->total_mass, 8.0 * (400.0 + 1025.0 * 0.3), 1e-8);
  const auto by_mass = find_ballast(body, water, {.mass = ballast->mass});
  ASSERT_TRUE(by_mass);
  EXPECT_NEAR(by_mass->draft, 0.7, 1e-12);
}

TEST(LayeredFlotation, PartsAddUpToTheDisplacedMass) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{4, 2, 1}, {2, 2, 2}});
  const HydrostaticMesh hold = mesh_of(BoxShape{{1, 1, 1}, {2, 2, 2}});
  const std::vector<PlacedMesh> meshes{
      {.mesh = &hull}, {.mesh = &hold, .position_B = Vec3(1, 0, 0), .signed_permeability = -0.5}};
  const FloatingBody body = FloatingBody::make(meshes, 940.0 * 7.5, Vec3::Zero()).value();
  const Pose pose{.p_WB = Vec3(0, 0, -0.45)};  // 0.45 m of its height lie in the water under the fuel
  const auto parts = displaced_parts(body, pose, kFuelOnWater);
  ASSERT_EQ(parts.size(), 2U);
  const double per_area = 850.0 * 0.55 + 1000.0 * 0.45;
  EXPECT_NEAR(parts[0].volume, 8.0, 1e-12);
  EXPECT_NEAR(parts[0].mass, 8.0 * per_area, 1e-9);
  EXPECT_NEAR(parts[1].volume, -0.5, 1e-13);
  EXPECT_NEAR(parts[1].mass, -0.5 * per_area, 1e-9);
  const auto state = floating_state(body, pose, kFuelOnWater);
  EXPECT_NEAR(state->hydrostatics.density * state->hydrostatics.volume, parts[0].mass + parts[1].mass, 1e-8);
}

}  // namespace
}  // namespace buoyancy
