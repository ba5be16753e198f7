// Buoyancy and hydrostatics in layered water.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/hydrostatics.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/support/allocation_count.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"

namespace buoyancy {
namespace {

using RationalVec = Vec3T<Rational>;

const Water kFuelOnWater{.level = 0.25, .density = 850.0, .layers = {{-0.35, 1000.0}}};

// size: [m], of a body at the level, which crosses most of them.
Water sixteen_layers(double size) {
  Water water{.level = 0.0, .density = 998.1};
  for (int i = 0; i < 16; ++i) {
    water.layers.push_back({-(0.02 + 0.04 * i) * size, 998.7 + 1.9 * i + 0.1 * i * i});
  }
  return water;
}

// The waters whose pressures add up, by subtraction rather than by water_of_step().
std::vector<Water> terms_of(const Water& water) {
  std::vector<Water> terms{
      {.up_W = water.up_W, .level = water.level, .density = water.density, .gravity = water.gravity}};
  double above = water.density;
  for (const WaterLayer& layer : water.layers) {
    terms.push_back(terms.front());
    terms.back().level = layer.below;
    terms.back().density = layer.density - above;
    above = layer.density;
  }
  return terms;
}

void expect_same(const BuoyancyResult& a, const BuoyancyResult& b, const std::string& where) {
  EXPECT_EQ(a.status, b.status) << where;
  EXPECT_EQ(a.immersion, b.immersion) << where;
  EXPECT_EQ(a.force_W, b.force_W) << where;
  EXPECT_EQ(a.torque_W, b.torque_W) << where;
  EXPECT_EQ(a.volume, b.volume) << where;
  EXPECT_EQ(a.center_of_buoyancy_W, b.center_of_buoyancy_W) << where;
  EXPECT_EQ(a.force_error_bound, b.force_error_bound) << where;
  EXPECT_EQ(a.torque_error_bound, b.torque_error_bound) << where;
}

// 0.6 m of its height lie in the fuel, and 0.25 m in the water.
TEST(LayeredBuoyancy, OfACubeInTwoLayersHasItsClosedForm) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{1, 1, 1}, {3, 4, 5}});
  const Pose pose{.p_WB = Vec3(3, -2, -0.1)};
  const Vec3 reference_B(0.5, 0.0, 0.0);
  const double mass = 850.0 * 0.6 + 1000.0 * 0.25;
  const double center = (850.0 * 0.6 * -0.05 + 1000.0 * 0.25 * -0.475) / mass + 0.1;
  for (const Method method : {Method::kExact, Method::kExactSurface, Method::kHierarchical}) {
    const BuoyancyResult result = buoyancy(Solver(mesh, method), pose, kFuelOnWater, reference_B);
    const double weight = mass * kStandardGravity;
    EXPECT_NEAR(result.force_W.z(), weight, 1e-11 * weight) << to_string(method);
    EXPECT_NEAR(result.torque_W.y(), 0.5 * weight, 1e-11 * weight) << to_string(method);
    EXPECT_NEAR(result.volume, 0.85, 1e-13) << to_string(method);
    EXPECT_LE((result.center_of_buoyancy_W - Vec3(0, 0, center)).norm(), 1e-12) << to_string(method);
    EXPECT_EQ(result.immersion, Immersion::kPiercing) << to_string(method);
  }
}

TEST(LayeredBuoyancy, OfEveryMethodIsTheSumOverItsTerms) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    const Water water = sixteen_layers(mesh.diagonal);
    const Vec3 reference_B = mesh.center_B + Vec3(0.1, -0.2, 0.3) * mesh.diagonal;
    RandomPoses random(41);
    for (int i = 0; i < 3; ++i) {
      const Pose pose = random.crossing(bounding_box(named.mesh), water);
      for (const Method method : kAllMethods) {
        const Solver solver(mesh, method, method == Method::kHierarchical && i == 2 ? 1e-3 : 0.0);
        const std::string where = named.name + ", " + std::string(to_string(method));
        const BuoyancyResult result = buoyancy(solver, pose, water, reference_B);
        BuoyancyResult sum;
        Vec3 moment_W = Vec3::Zero();
        for (const Water& term : terms_of(water)) {
          const BuoyancyResult part = buoyancy(solver, pose, term, reference_B);
          sum.force_W += part.force_W;
          sum.torque_W += part.torque_W;
          sum.force_error_bound += part.force_error_bound;
          sum.torque_error_bound += part.torque_error_bound;
          moment_W += part.force_W.z() * part.center_of_buoyancy_W;
        }
        const auto near = [](double bound) { return 1e-12 * bound; };
        const double force = water.layers.back().density * water.gravity * mesh.volume;
        const double torque = force * mesh.max_lever_arm(reference_B);
        EXPECT_LE((result.force_W - sum.force_W).norm(), near(force)) << where;
        EXPECT_LE((result.torque_W - sum.torque_W).norm(), near(torque)) << where;
        EXPECT_NEAR(result.force_error_bound, sum.force_error_bound, near(sum.force_error_bound)) << where;
        EXPECT_NEAR(result.torque_error_bound, sum.torque_error_bound, near(sum.torque_error_bound)) << where;
        EXPECT_EQ(result.volume, buoyancy(solver, pose, terms_of(water).front(), reference_B).volume);
        if (sum.force_W.z() > 1e-3 * force) {
          const double lever = mesh.max_lever_arm(Vec3::Zero());
          EXPECT_LE((result.center_of_buoyancy_W - moment_W / sum.force_W.z()).norm(), 1e-10 * lever)
              << where;
        }
      }
    }
  }
}

// The densities and heights are the given doubles; nothing is rounded before the difference is taken.
TEST(LayeredBuoyancy, AcrossSixteenLayersIsWithinItsBoundsOfTheTruth) {
  double largest = 0.0;
  for (const Shape& shape : {Shape(RockShape{.frequency = 3, .seed = 4}), Shape(BoxShape{{2, 1, 0.5}}),
                             Shape(CylinderShape{.radius = 0.3, .height = 2, .segments = 12})}) {
    const TriangleMesh source = make_shape(shape);
    const HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}});
    const Water water = sixteen_layers(mesh.diagonal);
    const Vec3 reference_B = mesh.center_B + Vec3(0.3, 0.2, -0.1) * mesh.diagonal;
    RandomPoses random(42);
    for (int i = 0; i < 8; ++i) {
      Pose pose = random.crossing(bounding_box(source), water);
      pose.p_WB.z() -= 0.3 * mesh.diagonal;
      Rational weight(0);
      RationalVec torque_W = RationalVec::Constant(Rational(0));
      Rational above(0);
      for (std::size_t n = 0; n <= water.layers.size(); ++n) {
        Water term{.level = n == 0 ? water.level : water.layers[n - 1].below};
        const Rational density(n == 0 ? water.density : water.layers[n - 1].density);
        const Rational step = (density - above) * Rational(water.gravity);
        above = density;
        const auto displaced = exact_displacement<Rational>(source, pose, term);
        weight += step * displaced.volume;
        torque_W += exactly_in_world<Rational>(pose, displaced.torque(reference_B)) * step;
      }
      for (const Method method : {Method::kExact, Method::kExactSurface, Method::kHierarchical}) {
        const BuoyancyResult result = buoyancy(Solver(mesh, method), pose, water, reference_B);
        Vec3 force_error;
        Vec3 torque_error;
        for (int axis = 0; axis < 3; ++axis) {
          force_error[axis] = Rational(Rational(result.force_W[axis]) - (axis == 2 ? weight : Rational(0)))
                                  .convert_to<double>();
          torque_error[axis] =
              Rational(Rational(result.torque_W[axis]) - torque_W[axis]).convert_to<double>();
        }
        EXPECT_LE(force_error.norm(), result.force_error_bound) << to_string(method);
        EXPECT_LE(torque_error.norm(), result.torque_error_bound) << to_string(method);
        EXPECT_LE(result.force_error_bound, 1e-10 * water.gravity * 1100.0 * mesh.volume);
        largest = std::max(largest, force_error.norm() / result.force_error_bound);
      }
    }
  }
  EXPECT_LE(largest, 0.5) << "the rounding of sums over the terms takes what is left of the bound";
  RecordProperty("largest_share_of_the_bound", std::to_string(largest));
}

// Bounds decide wherever the body crosses no top; a group has the bits of its members. No way allocates.
TEST(LayeredBuoyancy, IsTheSameAloneInGroupsAndFromBounds) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 6, .seed = 2});
  const Water water{.level = 5.0, .density = 800.0, .layers = {{0.0, 1000.0}, {-6.0, 1010.0}}};
  const Solver solver(mesh, Method::kHierarchical);
  const Vec3 reference_B(0.2, 0.1, -0.3);
  const FullySubmerged submerged = submerged_constants(mesh, water, reference_B);
  struct Case {
    double height;
    bool is_decided;
    Immersion immersion;
    double density;  // of the water around the body; 0: not one
  };
  const std::array<Case, 7> cases{{{8.0, true, Immersion::kDry, 0.0},
                                   {5.0, false, Immersion::kPiercing, 0.0},
                                   {2.5, true, Immersion::kSubmerged, 800.0},
                                   {0.1, false, Immersion::kSubmerged, 0.0},
                                   {-3.0, true, Immersion::kSubmerged, 1000.0},
                                   {-6.1, false, Immersion::kSubmerged, 0.0},
                                   {-20.0, true, Immersion::kSubmerged, 1010.0}}};
  std::vector<BuoyancyQuery> queries;
  std::vector<BuoyancyResult> alone;
  for (const Case& at : cases) {
    const std::string where = "height " + std::to_string(at.height);
    const Pose pose{Vec3(1, 2, at.height), Eigen::Quaterniond(0.8, 0.0, 0.6, 0.0)};
    const AllocationCount allocations;
    const BuoyancyResult result = buoyancy(solver, pose, water, reference_B);
    BuoyancyResult from_bounds;
    from_bounds.volume = -1.0;
    const bool is_decided =
        try_buoyancy_from_bounds(solver, submerged, pose, water, reference_B, from_bounds);
    EXPECT_EQ(allocations.count(), 0) << where;
    EXPECT_EQ(result.immersion, at.immersion) << where;
    EXPECT_EQ(is_decided, at.is_decided) << where;
    if (is_decided) {
      expect_same(from_bounds, result, where);
      const double force = at.density * water.gravity * mesh.volume;
      EXPECT_NEAR(result.force_W.z(), force, 1e-12 * force) << where;
    } else {
      EXPECT_EQ(from_bounds.volume, -1.0) << where;
    }
    queries.push_back({&solver, pose, reference_B});
    alone.push_back(result);
  }
  std::vector<BuoyancyResult> together(queries.size());
  buoyancy(queries, water, together);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    expect_same(together[i], alone[i], "query " + std::to_string(i));
  }
}

TEST(LayeredBuoyancy, LayersOfTheSameDensityAreOneWater) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 6, .seed = 3});
  const Water one{.level = 0.2, .density = 1010.0};
  Water layered = one;
  layered.layers = {{0.0, 1010.0}, {-0.2, 1010.0}};
  RandomPoses random(43);
  for (const Method method : kAllMethods) {
    const Solver solver(mesh, method);
    for (int i = 0; i < 5; ++i) {
      const Pose pose = random.crossing(bounding_box(mesh.surface), one);
      const BuoyancyResult a = buoyancy(solver, pose, one, Vec3::Zero());
      const BuoyancyResult b = buoyancy(solver, pose, layered, Vec3::Zero());
      EXPECT_EQ(a.force_W, b.force_W) << to_string(method);
      EXPECT_EQ(a.torque_W, b.torque_W) << to_string(method);
      EXPECT_LE((a.center_of_buoyancy_W - b.center_of_buoyancy_W).norm(), 1e-14) << to_string(method);
    }
  }
}

// As of a received sea.
TEST(LayeredBuoyancy, ASurfaceBelowALayersHeightIsItsTop) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 6, .seed = 3});
  const Solver solver(mesh, Method::kHierarchical);
  const Water layered{.level = -1.0, .density = 850.0, .layers = {{-0.5, 1000.0}, {-1.2, 1010.0}}};
  const Water below{.level = -1.0, .density = 1000.0, .layers = {{-1.2, 1010.0}}};
  const Pose pose{Vec3(0, 0, -1.1), Eigen::Quaterniond(0.8, 0.6, 0.0, 0.0)};
  const BuoyancyResult a = buoyancy(solver, pose, layered, Vec3::Zero());
  const BuoyancyResult b = buoyancy(solver, pose, below, Vec3::Zero());
  EXPECT_LE((a.force_W - b.force_W).norm(), 1e-12 * b.force_W.norm());
  EXPECT_LE((a.torque_W - b.torque_W).norm(), 1e-12 * b.force_W.norm());
  EXPECT_EQ(a.volume, b.volume);
}

TEST(LayeredBuoyancy, IsOutOfRangeWhereASumIs) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  const Water water{.density = 1e308, .gravity = 1.5, .layers = {{-1.0, 1.7e308}}};
  const BuoyancyResult result =
      buoyancy(Solver(mesh, Method::kExact), {.p_WB = Vec3(0, 0, -9)}, water, Vec3(1, 0, 0));
  EXPECT_EQ(result.status, BuoyancyStatus::kOutOfRange);
  EXPECT_EQ(result.force_W, Vec3(Vec3::Zero()));
}

// A box of 2 x 1 x 1 m, of which 0.6 m lie in the fuel and 0.25 m in the water.
TEST(LayeredHydrostatics, OfABoxHaveTheirClosedForm) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{2, 1, 1}, {2, 2, 2}});
  const Pose pose{.p_WB = Vec3(3, -2, -0.1)};
  const Vec3 center_of_mass_B(0, 0, -0.2);
  const auto found = hydrostatics(mesh, pose, kFuelOnWater, Vec3::Zero(), center_of_mass_B);
  ASSERT_TRUE(found);
  const double mass = 2.0 * (850.0 * 0.6 + 1000.0 * 0.25);
  const double center = 2.0 * (850.0 * 0.6 * -0.05 + 1000.0 * 0.25 * -0.475) / mass + 0.1;
  EXPECT_NEAR(found->volume, 1.7, 1e-13);
  EXPECT_NEAR(found->density, mass / 1.7, 1e-10);
  EXPECT_NEAR(found->wetted_area, 2.0 + 6.0 * 0.85, 1e-12);
  EXPECT_NEAR(found->center_of_buoyancy_W.z(), center, 1e-13);
  // The two waterplanes are equal, and their steps add up to the density of the water.
  EXPECT_NEAR(found->waterplane_area, 2.0 * 1000.0 / found->density, 1e-12);
  const double about_length = 1000.0 * (2.0 / 12.0);
  EXPECT_NEAR(found->metacentric_radii[0], about_length / mass, 1e-13);
  EXPECT_NEAR(found->metacentric_heights[0], center + about_length / mass + 0.2, 1e-13);
  EXPECT_NEAR(found->stiffness(2, 2), 2.0 * 1000.0 * kStandardGravity, 1e-8);
}

// Without a waterplane at the surface, the top of a layer is one.
TEST(LayeredHydrostatics, OfABodyOnAnInterfaceHaveItsWaterplane) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{2, 1, 1}, {2, 2, 2}});
  const auto found =
      hydrostatics(mesh, {.p_WB = Vec3(0, 0, -0.55)}, kFuelOnWater, Vec3::Zero(), std::nullopt);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->volume, 2.0, 1e-13);
  EXPECT_NEAR(found->waterplane_area, 2.0 * 150.0 / found->density, 1e-12);
  EXPECT_NEAR(found->stiffness(2, 2), 2.0 * 150.0 * kStandardGravity, 1e-9);
  EXPECT_TRUE(hydrostatics(mesh, {.p_WB = Vec3(0, 0, 9)}, kFuelOnWater, Vec3::Zero(), std::nullopt)
                  ->stiffness.isZero(0.0));
}

TEST(LayeredHydrostatics, HaveTheStiffnessOfTheWrench) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 12, .seed = 5});
  const Water water = sixteen_layers(mesh.diagonal);
  const Vec3 reference_B(0.1, -0.2, 0.3);
  const Solver solver(mesh, Method::kHierarchical);
  RandomPoses random(44);
  for (int i = 0; i < 6; ++i) {
    Pose pose = random.crossing(bounding_box(mesh.surface), water);
    pose.p_WB.z() -= 0.3 * mesh.diagonal;
    const auto found = hydrostatics(mesh, pose, water, reference_B, std::nullopt);
    ASSERT_TRUE(found);
    const BuoyancyResult here = buoyancy(solver, pose, water, reference_B);
    EXPECT_NEAR(found->density * water.gravity * found->volume, here.force_W.z(), 1e-9 * here.force_W.z());
    EXPECT_LE((found->center_of_buoyancy_W - here.center_of_buoyancy_W).norm(), 1e-10);
    const double step = 1e-5;
    const double scale = found->stiffness.cwiseAbs().maxCoeff();
    for (int column = 0; column < 6; ++column) {
      const auto moved = [&](double by) {
        Pose at = pose;
        if (column < 3) {
          at.p_WB[column] += by;
        } else {
          const Vec3 reference_W = pose.q_WB * reference_B;
          const Eigen::Quaterniond turn(Eigen::AngleAxisd(by, Vec3::Unit(column - 3)));
          at.q_WB = turn * pose.q_WB;
          at.p_WB += reference_W - turn * reference_W;
        }
        return buoyancy(solver, at, water, reference_B);
      };
      const BuoyancyResult up = moved(step);
      const BuoyancyResult down = moved(-step);
      const Vec3 force = (down.force_W - up.force_W) / (2.0 * step);
      const Vec3 torque = (down.torque_W - up.torque_W) / (2.0 * step);
      EXPECT_LE((found->stiffness.col(column).head<3>() - force).norm(), 2e-6 * scale) << column;
      EXPECT_LE((found->stiffness.col(column).tail<3>() - torque).norm(), 2e-6 * scale) << column;
    }
  }
}

}  // namespace
}  // namespace buoyancy
