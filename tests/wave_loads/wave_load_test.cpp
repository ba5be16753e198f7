#include "wave_loads/wave_load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/hydrostatics/random_poses.h"
#include "tests/support/allocation_count.h"
#include "tests/wave_loads/body_in_sea.h"
#include "tests/waves/seas.h"

namespace buoyancy {
namespace {

constexpr double kPi = std::numbers::pi;

double period_of(double length) {
  return std::sqrt(2.0 * kPi * length / kStandardGravity);
}

TEST(WaveLoad, OfADryBodyIsNone) {
  const SeaBody sphere(SphereShape{1.0, 10});
  const TestSea sea(sea_of({wind_sea(0.5, 3.0)}));
  Pose pose;
  pose.p_WB.z() = 1.01 + sea.sea.max_elevation();
  const WaveLoad load = hierarchical_load(sphere, sea, pose, 1e-3);
  EXPECT_EQ(load.force, Vec3::Zero());
  EXPECT_EQ(load.force_bound, 0.0);
  EXPECT_EQ(load.volume, 0.0);
  EXPECT_EQ(load.volume_bound, 0.0);
}

TEST(WaveLoad, OfADeepBodyIsTheWeightOfItsWater) {
  const SeaBody sphere(SphereShape{1.0, 20});
  Pose pose;
  pose.p_WB = {3.0, 4.0, -200.0};
  const WaveLoad load = hierarchical_load(sphere, TestSea(sea_of({wind_sea(0.5, 3.0)})), pose, 1e-3);
  EXPECT_NEAR((load.force - sphere.mesh.volume * Vec3::UnitZ()).norm(), 0.0, load.force_bound);
  EXPECT_LE(load.force_bound, 1e-3 * sphere.mesh.volume);
  EXPECT_EQ(load.volume, sphere.mesh.volume);
  EXPECT_EQ(load.volume_bound, 0.0);
}

TEST(WaveLoad, BoundsTheVolumeAboutAsTheForceInLongWaves) {
  RandomPoses random(12);
  for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
    for (const Shape& shape : {Shape(BoxShape{{2.5, 0.7, 1.1}, {1, 1, 1}}), Shape(SphereShape{1.2, 6}),
                               Shape(RockShape{0.8, 4, 0.4, 9})}) {
      const SeaBody body(shape);
      for (int i = 0; i < 12; ++i) {
        WaveComponents waves;
        for (int wave = 0; wave < 5; ++wave) {
          const double length = body.mesh.diagonal * random.log_uniform(2.0, 20.0);
          waves.push_back({0.005 * length, 2.0 * kPi / period_of(length), random.uniform(0.0, 360.0),
                           random.uniform(0.0, 360.0)});
        }
        const Pose pose{body.mesh.diagonal * random.uniform(-0.5, 0.4) * Vec3::UnitZ(), random.rotation()};
        const WaveLoad load = hierarchical_load(body, TestSea(sea_of({waves}, pressure)), pose,
                                                random.power_of_ten(-5.0, -2.0));
        EXPECT_LE(load.volume_bound, 2.5 * load.force_bound) << "case " << i;
      }
    }
  }
}

// Bodies and seas at which the descent works in ways that random cases seldom need.
struct HardCase {
  std::string name;
  Shape shape;
  WaveComponents waves;
  Pose pose;
  double tolerance;
};

Pose turned(const Vec3& p_WB, const Eigen::Quaterniond& q_WB = Eigen::Quaterniond::Identity()) {
  return {p_WB, q_WB.normalized()};
}

WaveComponent wave(double height, double length, double direction, double phase = 0.0) {
  return {0.5 * height, 2.0 * kPi / period_of(length), direction, phase};
}

std::vector<HardCase> hard_cases() {
  return {// On a fine mesh in long waves, the patches along the waterline inherit the models of patches that
          // hold them.
          {"fine mesh",
           RockShape{1.0, 39, 0.3, 8},
           {wave(0.8, 25.0, 70.0, 30.0), wave(0.3, 12.0, -20.0)},
           turned({31.0, -8.0, 0.1}, {0.3, -0.7, 0.5, 0.4}),
           1e-3},
          // Far more columns of cells than those whose phases are kept.
          {"wide body in short waves",
           RockShape{6.0, 39, 0.2, 5},
           {wave(0.016, 1.0, 100.0, 50.0), wave(0.021, 1.3, 130.0, 65.0), wave(0.027, 1.7, 170.0, 85.0)},
           turned({40.0, -70.0, 0.5}),
           6e-5},
          // Waves of a twentieth of the body, far shorter than the patches of its deep parts.
          {"short gentle waves",
           RockShape{1.0, 2, 0.4, 3},
           {wave(0.004, 0.1, 20.0)},
           turned({1.0, 2.0, -0.8}),
           1e-2},
          // Waves of half a metre on a box of 60 m.
          {"work that is capped",
           BoxShape{{60.0, 40.0, 10.0}, {1, 1, 1}},
           {wave(0.02, 0.47, 20.0)},
           turned({1.0, 2.0, -1.0}, {0.99, 0.05, 0.02, 0.1}),
           1e-6}};
}

TEST(WaveLoad, BoundsHardCases) {
  for (const HardCase& hard : hard_cases()) {
    const SeaBody body(hard.shape);
    for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
      SCOPED_TRACE(hard.name + ", " + std::string(to_string(pressure)));
      const TestSea sea(sea_of({hard.waves}, pressure), 7'700'000);
      const WaveLoad load = hierarchical_load(body, sea, hard.pose, hard.tolerance);
      const bool is_capped = hard.name == "work that is capped";
      EXPECT_EQ(load.capped, is_capped);
      EXPECT_EQ(load.cells > 300, hard.name != "fine mesh" && hard.name != "short gentle waves");
      EXPECT_FALSE(load.too_steep);
      if (!is_capped) {
        EXPECT_LE(load.force_bound, hard.tolerance * body.mesh.volume);
      }
      const double accuracy = 0.2 * load.force_bound / body.mesh.volume;
      const ReferenceLoad truth = true_wave_load(body.mesh, sea.sea, sea.utime, hard.pose, accuracy);
      EXPECT_TRUE(truth.resolved);
      EXPECT_LE((load.force - truth.force).norm(), load.force_bound + truth.force_error);
      EXPECT_LE((load.torque - truth.torque).norm(), load.torque_bound + truth.torque_error);
      EXPECT_LE(std::abs(load.volume - truth.volume), load.volume_bound + truth.volume_error);
    }
  }
}

TEST(WaveLoad, OnASphereHasNoTorqueAboutItsCentre) {
  const SeaBody sphere(SphereShape{1.0, 40});
  for (const double height : {-3.5, -0.6, 0.0, 0.5}) {
    const TestSea sea(sea_of({wind_sea(0.5, 3.0)}), static_cast<std::int64_t>(1e7 * (height + 4.0)));
    const WaveLoad load = hierarchical_load(sphere, sea, turned({3.0, 4.0, height}), 1e-4);
    // The polyhedron is not quite a sphere.
    EXPECT_LE(load.torque.norm(), load.torque_bound + 3e-4 * load.force.norm()) << height;
  }
}

TEST(WaveLoad, MomentIsThatOfTheVolumeUnderTheSurface) {
  const SeaBody box(BoxShape{{2.0, 2.0, 2.0}, {12, 12, 12}});
  const TestSea sea(sea_of({wind_sea(0.5, 3.0)}));
  const Pose pose = turned({3.0, 4.0, 0.1}, {0.9, 0.3, -0.2, 0.1});
  const WaveLoad load = hierarchical_load(box, sea, pose, 1e-4);
  EXPECT_NEAR((load.moment - exact_surface_load(box, sea, pose).moment).norm(), 0.0, 2e-5 * box.mesh.volume);
}

TEST(WaveLoad, AllocatesNothingAfterWarmUp) {
  const SeaBody rock(RockShape{1.0, 16, 0.4, 3});
  TestSea sea(sea_of({wind_sea(0.5, 3.0)}));
  const auto load_at = [&](std::int64_t utime) {
    sea.snapshot.set_time(utime);
    EXPECT_GT(hierarchical_load(rock, sea, turned({1.0, 2.0, -0.1}), 1e-3).force_bound, 0.0);
  };
  for (std::int64_t i = 0; i < 50; ++i) load_at(100'000 * i);
  const AllocationCount allocations;
  for (std::int64_t i = 0; i < 50; ++i) load_at(100'000 * i);
  EXPECT_EQ(allocations.count(), 0);
}

// A cell's expansion sums over all components: as many cells of the largest sea as of a small one would take
// a second.
TEST(WaveLoad, CapsItsWorkInSeasOfManyComponents) {
  for (const int components : {256, 4096}) {
    const IrregularWaves waves{.significant_wave_height = 0.3,
                               .peak_period = 2.0,
                               .gamma = {},
                               .spreading = {},
                               .frequencies = components,
                               .cutoff = 6.0};
    const SeaBody rock(RockShape{20.0, 30, 0.1, 3});
    const WaveLoad load = hierarchical_load(rock, TestSea(sea_of({waves})), turned({1.0, 2.0, -1.0}), 1e-6);
    EXPECT_TRUE(load.capped);
    EXPECT_GT(load.cells, 200) << "the case is no hard one";
    EXPECT_LE(load.cells * components, (2'048 + 2 * 20'000) * 256);
  }
}

}  // namespace
}  // namespace buoyancy
