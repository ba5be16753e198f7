#include "wave_loads/wave_load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/forced_target.h"
#include "tests/support/allocation_count.h"
#include "tests/wave_loads/brute_force.h"
#include "wave_loads/wave_surface_methods.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.141592653589793;

// A body and a sea, with everything that a query needs.
struct Case {
  Case(const Shape& shape, SeaDescription description, double tolerance, const Water& water = {})
      : mesh(make_hydrostatic_mesh(ValidatedMesh{make_shape(shape), {}})),
        tree(build_patch_tree(mesh.surface)),
        sea(Sea::make(description, water).value()),
        snapshot(sea),
        expansion(sea),
        body{&mesh, &tree, tolerance} {}

  WaveLoad load(const Pose& pose, const Vec3& reference_B = Vec3::Zero()) const {
    return wave_load(body, expansion, snapshot, pose, reference_B);
  }

  HydrostaticMesh mesh;
  PatchTree tree;
  Sea sea;
  SeaSnapshot snapshot;
  SeaExpansion expansion;
  WaveBody body;
};

class RandomCases {
 public:
  explicit RandomCases(std::uint64_t seed) : random_(seed) {}

  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }

  Shape shape() {
    switch (random_() % 3) {
      case 0:
        return BoxShape{{uniform(0.3, 3.0), uniform(0.3, 3.0), uniform(0.3, 3.0)}, {1, 1, 1}};
      case 1:
        return SphereShape{uniform(0.3, 2.0), 6};
      default:
        return RockShape{uniform(0.3, 2.0), 4, 0.4, random_()};
    }
  }

  // Waves of 1 to 40 times `size`, of a steepness up to `steepest` in sum of a k / sqrt(components).
  WaveComponents waves(double size, int components, double steepest, double depth) {
    WaveComponents waves;
    double slope = 0.0;
    const double length = size * std::exp(uniform(0.0, 2.5));
    for (int i = 0; i < components; ++i) {
      const double k = 2.0 * kPi / (length * uniform(1.0, 3.0));
      const double squared = 9.80665 * k * (std::isinf(depth) ? 1.0 : std::tanh(k * depth));
      waves.push_back({uniform(0.2, 1.0), std::sqrt(squared), uniform(0.0, 360.0), uniform(0.0, 360.0)});
      slope += waves.back().amplitude * k;
    }
    const double scale = uniform(0.02, 1.0) * steepest / slope * std::sqrt(components);
    for (WaveComponent& wave : waves) {
      wave.amplitude = std::min(scale * wave.amplitude, 0.9 * depth / components);
    }
    return waves;
  }

  Pose pose(double size) {
    Pose pose;
    pose.q_WB =
        Eigen::Quaterniond(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    pose.p_WB = {uniform(-100, 100), uniform(-100, 100), size * uniform(-0.6, 0.4)};
    return pose;
  }

  std::mt19937_64& generator() { return random_; }

 private:
  std::mt19937_64 random_;
};

struct Setting {
  std::string name;
  WavePressure pressure;
  double depth;
  double tolerance;
  double steepest;
};

class WaveLoadBound : public ::testing::TestWithParam<Setting> {};

TEST_P(WaveLoadBound, HoldsAgainstBruteForce) {
  const Setting& setting = GetParam();
  RandomCases random(11);
  int within_tolerance = 0;
  constexpr int kCases = 25;
  for (int i = 0; i < kCases; ++i) {
    const Shape shape = random.shape();
    const double size = make_hydrostatic_mesh(ValidatedMesh{make_shape(shape), {}}, WithTree::kNo).diagonal;
    SeaDescription description;
    description.pressure = setting.pressure;
    description.depth = setting.depth;
    description.systems = {random.waves(size, 5, setting.steepest, setting.depth)};
    Case one(shape, description, setting.tolerance);
    one.snapshot.set_time(static_cast<std::int64_t>(random.uniform(0.0, 1e12)));
    const Pose pose = random.pose(size);
    const Vec3 reference_B(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const int cuts = std::holds_alternative<BoxShape>(shape) ? 64 : 12;
    const BruteForceLoad truth =
        brute_force_load(one.mesh.surface, one.mesh.center_B, one.snapshot, pose, reference_B, cuts);
    for (const std::string& target : simd_targets()) {
      const ForcedTarget forced(target);
      const WaveLoad load = one.load(pose, reference_B);
      ASSERT_LE((load.force - truth.force).norm(), load.force_bound + truth.force_error)
          << "case " << i << ", " << target;
      ASSERT_LE((load.torque - truth.torque).norm(), load.torque_bound + truth.torque_error)
          << "case " << i << ", " << target;
      ASSERT_LE(std::abs(load.volume - truth.volume), load.volume_bound + truth.volume_error)
          << "case " << i << ", " << target;
    }
    const WaveLoad load = one.load(pose, reference_B);
    within_tolerance += static_cast<int>(load.force_bound <= setting.tolerance * one.mesh.volume);
  }
  EXPECT_GE(within_tolerance, kCases - 1);
}

INSTANTIATE_TEST_SUITE_P(Seas, WaveLoadBound,
                         ::testing::Values(Setting{"coarse", WavePressure::kWheeler, kInfinity, 1e-2, 0.2},
                                           Setting{"usual", WavePressure::kWheeler, kInfinity, 1e-3, 0.2},
                                           Setting{"fine", WavePressure::kWheeler, kInfinity, 1e-5, 0.2},
                                           Setting{"hydrostatic", WavePressure::kHydrostatic, kInfinity, 1e-3,
                                                   0.2},
                                           Setting{"shallow", WavePressure::kWheeler, 3.0, 1e-3, 0.2},
                                           Setting{"steep", WavePressure::kWheeler, kInfinity, 1e-2, 0.9}),
                         [](const auto& setting) { return setting.param.name; });

SeaDescription wind_sea(double height, WavePressure pressure = WavePressure::kWheeler) {
  IrregularWaves waves;
  waves.significant_wave_height = height;
  waves.peak_period = 3.0;
  waves.spreading = 10.0;
  waves.directions = 5;
  SeaDescription description;
  description.pressure = pressure;
  description.systems = {waves};
  return description;
}

TEST(WaveLoad, OfADryBodyIsNone) {
  const Case one(SphereShape{1.0, 10}, wind_sea(0.5), 1e-3);
  Pose pose;
  pose.p_WB.z() = 1.01 + one.sea.max_elevation();
  const WaveLoad load = one.load(pose);
  EXPECT_EQ(load.force, Vec3::Zero());
  EXPECT_EQ(load.force_bound, 0.0);
  EXPECT_EQ(load.volume, 0.0);
  EXPECT_EQ(load.volume_bound, 0.0);
}

TEST(WaveLoad, OfADeepBodyIsTheWeightOfItsWater) {
  const Case one(SphereShape{1.0, 20}, wind_sea(0.5), 1e-3);
  Pose pose;
  pose.p_WB = {3.0, 4.0, -200.0};
  const WaveLoad load = one.load(pose);
  EXPECT_NEAR((load.force - one.mesh.volume * Vec3::UnitZ()).norm(), 0.0, load.force_bound);
  EXPECT_LE(load.force_bound, 1e-3 * one.mesh.volume);
  EXPECT_EQ(load.volume, one.mesh.volume);
  EXPECT_EQ(load.volume_bound, 0.0);
}

TEST(WaveLoad, BoundsTheVolumeAboutAsTheForceInLongWaves) {
  for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
    RandomCases random(12);
    for (int i = 0; i < 40; ++i) {
      const Shape shape = random.shape();
      const double size = make_hydrostatic_mesh(ValidatedMesh{make_shape(shape), {}}, WithTree::kNo).diagonal;
      SeaDescription description;
      description.pressure = pressure;
      description.systems = {random.waves(2.0 * size, 5, 0.2, kInfinity)};
      const Case one(shape, description, std::pow(10.0, random.uniform(-5.0, -2.0)));
      const WaveLoad load = one.load(random.pose(size));
      EXPECT_LE(load.volume_bound, 2.5 * load.force_bound) << "case " << i;
    }
  }
}

// At this tolerance no patch is refined, and what the models of wet patches leave out is most of the bound.
TEST(WaveLoad, BoundsFewLargePatchesUnderWaves) {
  for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
    RandomCases random(13);
    double largest_ratio_of_force = 0.0;
    double largest_ratio_of_torque = 0.0;
    for (int i = 0; i < 80; ++i) {
      const RockShape rock{1.0, 1, 0.3, random.generator()()};
      SeaDescription description;
      description.pressure = pressure;
      description.systems = {random.waves(random.uniform(3.0, 20.0), 2, 0.1, kInfinity)};
      const Case one(rock, description, 1.0);
      Pose pose = random.pose(1.0);
      pose.p_WB.z() = random.uniform(-4.0, -2.0);
      const WaveLoad load = one.load(pose);
      const BruteForceLoad truth =
          brute_force_load(one.mesh.surface, one.mesh.center_B, one.snapshot, pose, Vec3::Zero(), 32);
      const double force_error = (load.force - truth.force).norm();
      const double torque_error = (load.torque - truth.torque).norm();
      ASSERT_LE(force_error, load.force_bound + truth.force_error) << "case " << i;
      ASSERT_LE(torque_error, load.torque_bound + truth.torque_error) << "case " << i;
      largest_ratio_of_force = std::max(largest_ratio_of_force, force_error / load.force_bound);
      largest_ratio_of_torque = std::max(largest_ratio_of_torque, torque_error / load.torque_bound);
    }
    EXPECT_GT(largest_ratio_of_force, 0.15);
    EXPECT_GT(largest_ratio_of_torque, 0.04);
  }
}

// On a fine mesh in long waves, the patches along the waterline inherit the models of patches that hold them.
TEST(WaveLoad, BoundsTheWaterlineOfFineMeshes) {
  for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
    RandomCases random(17);
    double largest_ratio = 0.0;
    for (int i = 0; i < 8; ++i) {
      const RockShape rock{1.0, 39, 0.3, random.generator()()};
      SeaDescription description;
      description.pressure = pressure;
      description.systems = {random.waves(random.uniform(10.0, 40.0), 4, 0.1, kInfinity)};
      const Case one(rock, description, 1e-3);
      Pose pose = random.pose(1.0);
      pose.p_WB.z() = random.uniform(-0.3, 0.3);
      const WaveLoad load = one.load(pose);
      const BruteForceLoad truth =
          brute_force_load(one.mesh.surface, one.mesh.center_B, one.snapshot, pose, Vec3::Zero(), 2);
      const double force_error = (load.force - truth.force).norm();
      ASSERT_LE(load.force_bound, 1e-3 * one.mesh.volume) << "case " << i;
      ASSERT_LE(force_error, load.force_bound + truth.force_error) << "case " << i;
      ASSERT_LE((load.torque - truth.torque).norm(), load.torque_bound + truth.torque_error) << "case " << i;
      ASSERT_LE(std::abs(load.volume - truth.volume), load.volume_bound + truth.volume_error) << "case " << i;
      largest_ratio = std::max(largest_ratio, force_error / load.force_bound);
    }
    EXPECT_GT(largest_ratio, 0.001);
  }
}

TEST(WaveLoad, BoundsWideBodiesInShortWaves) {
  SeaDescription description;
  WaveComponents waves;
  for (const double length : {1.0, 1.3, 1.7}) {
    const double k = 2.0 * kPi / length;
    waves.push_back({0.05 / k, std::sqrt(kStandardGravity * k), 100.0 * length, 50.0 * length});
  }
  description.systems = {waves};
  const Case one(RockShape{6.0, 39, 0.2, 5}, description, 3e-5);
  Pose pose;
  pose.p_WB = {40.0, -70.0, 0.5};
  const WaveLoad load = one.load(pose);
  const BruteForceLoad truth =
      brute_force_load(one.mesh.surface, one.mesh.center_B, one.snapshot, pose, Vec3::Zero(), 4);
  // Far more columns of cells than those whose phases are kept.
  EXPECT_GT(load.cells, 300);
  EXPECT_LE(load.force_bound, 3e-5 * one.mesh.volume);
  EXPECT_LE((load.force - truth.force).norm(), load.force_bound + truth.force_error);
  EXPECT_LE((load.torque - truth.torque).norm(), load.torque_bound + truth.torque_error);
  EXPECT_LE(std::abs(load.volume - truth.volume), load.volume_bound + truth.volume_error);
  EXPECT_LE(truth.force_error, load.force_bound);
}

TEST(WaveLoad, InShortGentleWavesHasAVolumeAndNoSteepSurface) {
  // Waves of a twentieth of the body, far shorter than the patches of its deep parts.
  SeaDescription description;
  description.systems = {RegularWave{0.004, std::sqrt(2.0 * kPi * 0.1 / kStandardGravity), 20.0, 0.0}};
  for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
    description.pressure = pressure;
    const Case one(RockShape{1.0, 2, 0.4, 3}, description, 1e-2);
    Pose pose;
    pose.p_WB = {1.0, 2.0, -0.8};
    const WaveLoad load = one.load(pose);
    const BruteForceLoad truth =
        brute_force_load(one.mesh.surface, one.mesh.center_B, one.snapshot, pose, Vec3::Zero(), 64);
    EXPECT_FALSE(load.too_steep);
    EXPECT_NEAR(load.volume, truth.volume, 1e-2 * one.mesh.volume);
    EXPECT_LE(std::abs(load.volume - truth.volume), load.volume_bound + truth.volume_error);
    EXPECT_LE((load.force - truth.force).norm(), load.force_bound + truth.force_error);
  }
}

TEST(WaveLoad, OnASphereHasNoTorqueAboutItsCentre) {
  Case one(SphereShape{1.0, 40}, wind_sea(0.5), 1e-4);
  for (const double height : {-3.5, -0.6, 0.0, 0.5}) {
    one.snapshot.set_time(static_cast<std::int64_t>(1e7 * (height + 4.0)));
    Pose pose;
    pose.p_WB = {3.0, 4.0, height};
    const WaveLoad load = one.load(pose);
    // The polyhedron is not quite a sphere.
    EXPECT_LE(load.torque.norm(), load.torque_bound + 3e-4 * load.force.norm()) << height;
  }
}

TEST(WaveLoad, ShiftOfTheBodyIsAShiftOfThePhase) {
  const double k = std::pow(2.0 * kPi / 4.0, 2) / kStandardGravity;
  SeaDescription description;
  description.systems = {RegularWave{0.4, 4.0, 0.0, 0.0}};
  const Case here(RockShape{1.0, 8, 0.4, 3}, description, 1e-3);
  description.systems = {RegularWave{0.4, 4.0, 0.0, 90.0}};
  const Case there(RockShape{1.0, 8, 0.4, 3}, description, 1e-3);
  Pose pose;
  pose.p_WB = {1.0, 2.0, -0.1};
  Pose shifted = pose;
  shifted.p_WB.x() += 0.5 * kPi / k;
  const WaveLoad one = here.load(shifted);
  const WaveLoad other = there.load(pose);
  EXPECT_NEAR((one.force - other.force).norm(), 0.0, one.force_bound + other.force_bound);
  EXPECT_NEAR((one.force - other.force).norm(), 0.0, 1e-5);
}

TEST(WaveLoad, TurnsWithUp) {
  const Case upright(RockShape{1.0, 8, 0.4, 3}, wind_sea(0.5), 1e-3);
  Water sideways;
  sideways.up_W = Vec3::UnitX();
  const Case turned(RockShape{1.0, 8, 0.4, 3}, wind_sea(0.5), 1e-3, sideways);
  // World x, y, z of the second are up, e1, e2 of the first.
  Mat3 R;
  R << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  Pose pose;
  pose.p_WB = {5.0, 6.0, -0.2};
  pose.q_WB = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3).normalized();
  Pose other;
  other.p_WB = R * pose.p_WB;
  other.q_WB = Eigen::Quaterniond(R) * pose.q_WB;
  const WaveLoad one = upright.load(pose);
  const WaveLoad two = turned.load(other);
  EXPECT_NEAR((one.force - two.force).norm(), 0.0, 1e-5);
  EXPECT_NEAR((one.torque - two.torque).norm(), 0.0, 1e-5);
}

TEST(WaveLoad, InVeryLongWavesIsThatOfATiltedPlane) {
  // A wave of 40 km, halfway up its slope.
  SeaDescription description;
  description.pressure = WavePressure::kHydrostatic;
  description.systems = {RegularWave{400.0, std::sqrt(2.0 * kPi * 40e3 / kStandardGravity), 0.0, -90.0}};
  const Case one(BoxShape{{1.0, 1.5, 0.8}, {1, 1, 1}}, description, 1e-5);
  Pose pose;
  pose.p_WB = {0.1, 0.2, 0.1};
  pose.q_WB = Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3).normalized();
  const WaveLoad load = one.load(pose);

  const double slope = 200.0 * one.sea.prepared().wave_number[0];
  Water tilted;
  tilted.up_W = Vec3(-slope, 0.0, 1.0).normalized();
  tilted.density = std::hypot(1.0, slope);
  tilted.gravity = 1.0;
  const Solver solver(one.mesh, Method::kHierarchical);
  const BuoyancyResult plane = buoyancy(solver, pose, tilted, Vec3::Zero());
  const Vec3 force_W = pose.q_WB * load.force;
  const Vec3 torque_W = pose.q_WB * load.torque;
  EXPECT_NEAR((force_W - plane.force_W).norm(), 0.0, load.force_bound + 1e-6);
  EXPECT_NEAR((torque_W - plane.torque_W).norm(), 0.0, load.torque_bound + 1e-6);
  EXPECT_NEAR(load.volume, plane.volume, 1e-5);
}

TEST(WaveLoad, DoesNotDependOnTheWorldsOrigin) {
  // A whole number of waves away: the same load, though phases are reduced from 1e6 m.
  SeaDescription description;
  description.systems = {RegularWave{0.4, 4.0, 0.0, 30.0}};
  const Case one(RockShape{1.0, 8, 0.4, 3}, description, 1e-3);
  const double length = 2.0 * kPi / one.sea.prepared().wave_number[0];
  Pose pose;
  pose.p_WB = {1.0, 2.0, -0.1};
  Pose far = pose;
  far.p_WB.x() += 40'000.0 * length;
  const WaveLoad here = one.load(pose);
  const WaveLoad there = one.load(far);
  EXPECT_NEAR((here.force - there.force).norm(), 0.0, 1e-6);
}

TEST(WaveLoad, MomentIsThatOfTheVolumeUnderTheSurface) {
  const Case one(BoxShape{{2.0, 2.0, 2.0}, {12, 12, 12}}, wind_sea(0.5), 1e-4);
  Pose pose;
  pose.p_WB = {3.0, 4.0, 0.1};
  pose.q_WB = Eigen::Quaterniond(0.9, 0.3, -0.2, 0.1).normalized();
  const WaveLoad load = one.load(pose);
  const WaveLoad baseline = exact_surface_in_waves(one.mesh, one.snapshot, pose, Vec3::Zero());
  EXPECT_NEAR((load.moment - baseline.moment).norm(), 0.0, 2e-5 * one.mesh.volume);
}

TEST(WaveLoad, AllocatesNothingAfterWarmUp) {
  Case one(RockShape{1.0, 16, 0.4, 3}, wind_sea(0.5), 1e-3);
  Pose pose;
  pose.p_WB = {1.0, 2.0, -0.1};
  const auto load_at = [&](std::int64_t utime) {
    one.snapshot.set_time(utime);
    EXPECT_GT(one.load(pose).force_bound, 0.0);
  };
  for (std::int64_t i = 0; i < 50; ++i) load_at(100'000 * i);
  const AllocationCount allocations;
  for (std::int64_t i = 0; i < 50; ++i) load_at(100'000 * i);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(WaveLoad, CapsItsWorkAndStillBounds) {
  // Waves of half a metre on a box of 60 m.
  SeaDescription description;
  description.systems = {RegularWave{0.02, 0.55, 20.0, 0.0}};
  const Case one(BoxShape{{60.0, 40.0, 10.0}, {1, 1, 1}}, description, 1e-6);
  Pose pose;
  pose.p_WB = {1.0, 2.0, -1.0};
  pose.q_WB = Eigen::Quaterniond(0.99, 0.05, 0.02, 0.1).normalized();
  const WaveLoad load = one.load(pose);
  EXPECT_TRUE(load.capped);
  const BruteForceLoad truth =
      brute_force_load(one.mesh.surface, one.mesh.center_B, one.snapshot, pose, Vec3::Zero(), 400);
  EXPECT_LE((load.force - truth.force).norm(), load.force_bound + truth.force_error);
  EXPECT_LE((load.torque - truth.torque).norm(), load.torque_bound + truth.torque_error);
  EXPECT_LE(std::abs(load.volume - truth.volume), load.volume_bound + truth.volume_error);
}

// A cell's expansion sums over all components: as many cells of the largest sea as of a small one would take
// a second.
TEST(WaveLoad, CapsItsWorkInSeasOfManyComponents) {
  for (const int components : {256, 4096}) {
    IrregularWaves waves;
    waves.significant_wave_height = 0.3;
    waves.peak_period = 2.0;
    waves.cutoff = 6.0;
    waves.frequencies = components;
    SeaDescription description;
    description.systems = {waves};
    const Case one(RockShape{20.0, 30, 0.1, 3}, description, 1e-6);
    Pose pose;
    pose.p_WB = {1.0, 2.0, -1.0};
    const WaveLoad load = one.load(pose);
    EXPECT_TRUE(load.capped);
    EXPECT_GT(load.cells, 200) << "the case is no hard one";
    EXPECT_LE(load.cells * components, (2'048 + 2 * 20'000) * 256);
  }
}

}  // namespace
}  // namespace buoyancy
