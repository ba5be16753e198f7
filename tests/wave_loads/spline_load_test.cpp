// The load in seas that are known on grids: docs/wave_mathematics.md, "Surfaces on a grid".
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hydrostatics/buoyancy.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/support/allocation_count.h"
#include "tests/truth/reference_spline.h"
#include "tests/wave_loads/body_in_sea.h"
#include "tests/waves/random_grid.h"
#include "tests/waves/seas.h"
#include "wave_loads/wave_buoyancy.h"

namespace buoyancy {
namespace {

constexpr double kPi = std::numbers::pi;

std::shared_ptr<const ElevationSpline> spline_of(const SampledGrid& grid) {
  auto spline = std::make_shared<ElevationSpline>();
  EXPECT_TRUE(spline->set(grid.grid));
  return spline;
}

// The sea of one grid, or half-way between those of two.
struct GridSea {
  explicit GridSea(const SampledGrid& grid, const Water& water = {})
      : GridSea({{0, spline_of(grid)}}, 0, water) {}
  GridSea(const SampledGrid& first, const SampledGrid& second, const Water& water = {})
      : GridSea({{0, spline_of(first)}, {1'000'000, spline_of(second)}}, 500'000, water) {}
  GridSea(std::vector<TimedElevation> surfaces, std::int64_t utime, const Water& water)
      : prepared(Sea::of_surfaces(surfaces, water)), now(prepared, utime) {}
  GridSea(const GridSea&) = delete;
  GridSea& operator=(const GridSea&) = delete;

  WaveLoad load(const SeaBody& body, const Pose& pose, double tolerance,
                const Vec3& reference_B = Vec3::Zero()) const {
    return wave_load({&body.mesh, &body.tree, tolerance}, prepared.expansion(), now, pose, reference_B);
  }

  PreparedSea prepared;
  SeaAtTime now;
};

const SeaBody& rock() {
  static const SeaBody body(RockShape{1.0, 16, 0.4, 3});
  return body;
}

Pose floating_pose() {
  return {{5.0, 6.0, -0.2}, Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized()};
}

void expect_within(const WaveLoad& load, const ReferenceLoad& truth) {
  EXPECT_LE((load.force - truth.force).norm(), load.force_bound + truth.force_error);
  EXPECT_LE((load.torque - truth.torque).norm(), load.torque_bound + truth.torque_error);
  EXPECT_LE(std::abs(load.volume - truth.volume), load.volume_bound + truth.volume_error);
}

// A grid that has a body of this size at X, of samples without any order or of a few waves.
SampledGrid grid_around(RandomPoses& random, double x1, double x2, double diagonal) {
  const bool periodic = random.pick(2) == 0;
  const std::array<std::size_t, 2> sides{4 + random.pick(16), 4 + random.pick(16)};
  std::array<double, 2> spacing{}, origin{};
  for (std::size_t n = 0; n < 2; ++n) {
    const auto cells = static_cast<double>(sides[n] - 1);
    spacing[n] = 1.2 * diagonal / cells * random.log_uniform(periodic ? 0.5 : 1.0, 12.0);
    const double spare = cells * spacing[n] - 1.1 * diagonal;
    origin[n] = (n == 0 ? x1 : x2) - 0.55 * diagonal - std::max(spare, 0.0) * random.uniform(0.0, 1.0);
    if (periodic) origin[n] += random.uniform(-100.0, 100.0);
  }
  const double height = std::min(spacing[0], spacing[1]) * random.log_uniform(0.003, 0.6);
  const double mean = random.uniform(-0.5, 0.5) * diagonal;
  const bool rough = random.pick(2) == 0;
  const double k1 = random.uniform(-1.0, 1.0) / spacing[0];
  const double k2 = random.uniform(-1.0, 1.0) / spacing[1];
  return sampled(sides[1], sides[0], origin, spacing, periodic, [&](double at_1, double at_2) {
    return mean + (rough ? random.uniform(-height, height) : height * std::cos(k1 * at_1 + k2 * at_2));
  });
}

TEST(WaveLoadOnGrids, IsWithinItsBounds) {
  const std::array<SeaBody, 3> bodies{SeaBody(BoxShape{{2.5, 0.7, 1.1}, {1, 1, 1}}),
                                      SeaBody(SphereShape{1.2, 5}), SeaBody(RockShape{0.8, 4, 0.4, 9})};
  RandomPoses random(21);
  int certified = 0;
  constexpr int kCases = 1'000;
  for (int n = 0; n < kCases; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    const SeaBody& body = bodies[random.pick(bodies.size())];
    const double diagonal = body.mesh.diagonal;
    Water water;
    if (random.pick(3) == 0) water.up_W = random.direction();
    water.level = random.uniform(-3.0, 3.0);
    const HorizontalAxes axes = horizontal_axes(water.up_W);
    const double x1 = random.uniform(-20.0, 20.0);
    const double x2 = random.uniform(-20.0, 20.0);
    const SampledGrid first = grid_around(random, x1, x2, diagonal);
    const SampledGrid second = grid_around(random, x1, x2, diagonal);
    const bool blended = random.pick(4) == 0;
    std::optional<GridSea> sea;
    if (blended) {
      sea.emplace(first, second, water);
    } else {
      sea.emplace(first, water);
    }
    // The middle of the box above or below X, near the surface there.
    Pose pose{Vec3::Zero(), random.rotation()};
    const Mat3 R_WB = pose.q_WB.toRotationMatrix();
    const double height = water.level + sea->now.elevation(x1, x2) + random.uniform(-0.6, 0.45) * diagonal;
    pose.p_WB = x1 * axes.e1_W + x2 * axes.e2_W + height * water.up_W -
                R_WB * (body.mesh.center_B + 0.5 * (body.mesh.box_min + body.mesh.box_max));
    const double tolerance = random.power_of_ten(-5.0, -2.0);
    const Vec3 reference_B = random.vector(0.0, 2.0);
    ASSERT_TRUE(sea->now.surface().holds(footprint_of(body.mesh, pose, axes)));
    const WaveLoad load = sea->load(body, pose, tolerance, reference_B);
    certified += static_cast<int>(load.force_bound <= tolerance * body.mesh.volume);

    const ReferenceSpline one(first.grid);
    const ReferenceSpline other(second.grid);
    std::vector<ReferenceSplineSea::Part> parts{{&one, blended ? 0.5 : 1.0}};
    if (blended) parts.push_back({&other, 0.5});
    const ReferenceSplineSea reference(parts, water, pose, body.mesh.center_B);
    const double error = std::max(0.5 * load.force_bound, 1e-6 * body.mesh.volume);
    expect_within(load, reference_load(moved_and_scaled(body.mesh.surface, body.mesh.center_B),
                                       body.mesh.center_B, reference, reference_B,
                                       {.force_error = error,
                                        .torque_error = error * body.mesh.max_lever_arm(reference_B),
                                        .volume_error = std::max(0.5 * load.volume_bound, error),
                                        .max_work = 2'000'000}));
  }
  EXPECT_GE(certified, kCases * 9 / 10);
}

TEST(WaveLoadOnGrids, OfALevelPlaneIsThatOfWaterAtRest) {
  const SampledGrid plane = sampled(8, 9, {0.0, 1.0}, {1.5, 1.5}, false, [](double, double) { return 0.35; });
  Water raised;
  raised.level = 2.35;
  Water water;
  water.level = 2.0;
  const GridSea sea(plane, water);
  const Solver at_rest(rock().mesh, Method::kHierarchical, 0.0);
  for (const double height : {1.2, 2.0, 2.7, 3.2}) {
    Pose pose = floating_pose();
    pose.p_WB.z() = height;
    const BuoyancyResult still = buoyancy(at_rest, pose, raised, Vec3::Zero());
    const Mat3 R_WB = pose.q_WB.toRotationMatrix();
    for (const double tolerance : {1e-3, 3e-6}) {
      const WaveLoad load = sea.load(rock(), pose, tolerance);
      const double scale = water.density * water.gravity;
      EXPECT_NEAR((R_WB * load.force - still.force_W / scale).norm(), 0.0, load.force_bound);
      EXPECT_NEAR((R_WB * load.torque - still.torque_W / scale).norm(), 0.0, load.torque_bound);
      EXPECT_NEAR(load.volume, still.volume, load.volume_bound);
      EXPECT_LE(load.force_bound, tolerance * rock().mesh.volume);
    }
  }
}

// Under a tilted plane the pressure is that of water at rest with the plane's up and a larger gravity.
TEST(WaveLoadOnGrids, OfATiltedPlaneIsThatOfTiltedWater) {
  const auto height = [](double x1, double x2) { return 0.1 + 0.2 * x1 - 0.3 * x2; };
  const SampledGrid plane = sampled(20, 20, {-4.0, -4.0}, {0.75, 0.5}, false, height);
  Water tilted;
  const Vec3 normal(-0.2, 0.3, 1.0);
  tilted.up_W = normal.normalized();
  tilted.level = 0.1 / normal.norm();
  const Solver at_rest(rock().mesh, Method::kHierarchical, 0.0);
  Pose pose = floating_pose();
  pose.p_WB = {1.0, 0.5, 0.1};
  const BuoyancyResult still = buoyancy(at_rest, pose, tilted, Vec3::Zero());
  const double scale = tilted.density * tilted.gravity / normal.norm();
  const Mat3 R_WB = pose.q_WB.toRotationMatrix();
  const WaveLoad load = GridSea(plane).load(rock(), pose, 1e-6);
  EXPECT_LE((R_WB * load.force - still.force_W / scale).norm(), load.force_bound);
  EXPECT_LE((R_WB * load.torque - still.torque_W / scale).norm(), load.torque_bound);
  EXPECT_LE(std::abs(load.volume - still.volume), load.volume_bound);
  EXPECT_LE(load.force_bound, 1e-6 * rock().mesh.volume);
}

// A cubic spline of period h is off from a cosine of wave number k by at most a (5/384) (k h)^4: the bound of
// Hall and Meyer. Along both axes the errors add up.
TEST(WaveLoadOnGrids, OfSamplesOfAWaveIsThatOfTheWave) {
  constexpr double kAmplitude = 0.25;
  const TestSea wave(sea_of({RegularWave{2.0 * kAmplitude, 2.2, 30.0, 40.0}}, WavePressure::kHydrostatic),
                     700'000);
  const double k = wave.sea.prepared().wave_number[0];
  const Pose pose = floating_pose();
  const WaveLoad truth = hierarchical_load(rock(), wave, pose, 1e-7);
  std::vector<double> errors;
  for (const double spacing : {0.8, 0.4, 0.2}) {
    const auto side = static_cast<std::size_t>(16.0 / spacing) + 1;
    const SampledGrid samples =
        sampled(side, side, {-3.0, -2.0}, {spacing, spacing}, false,
                [&](double x1, double x2) { return wave.snapshot.elevation(x1, x2); });
    const WaveLoad load = GridSea(samples).load(rock(), pose, 1e-7);
    const double h1 = k * std::cos(kPi / 6.0) * spacing;
    const double h2 = k * std::sin(kPi / 6.0) * spacing;
    const double of_surface = kAmplitude * 5.0 / 384.0 * (std::pow(h1, 4) + std::pow(h2, 4));
    errors.push_back((load.force - truth.force).norm());
    EXPECT_LE(errors.back(), of_surface * rock().mesh.area + load.force_bound + truth.force_bound) << spacing;
  }
  EXPECT_LE(errors[1], errors[0] / 10.0);
  EXPECT_LE(errors[2], errors[1] / 10.0);
}

TEST(WaveLoadOnGrids, IsTheSameAPeriodAway) {
  std::mt19937_64 random(31);
  const SampledGrid grid = sampled(12, 16, {-1.5, 0.25}, {0.5, 0.25}, true, [&](double, double) {
    return std::uniform_real_distribution<double>(-0.1, 0.1)(random);
  });
  const GridSea sea(grid);
  for (const double tolerance : {1e-3, 1e-6}) {
    const WaveLoad here = sea.load(rock(), floating_pose(), tolerance);
    for (const auto& [periods_1, periods_2] : {std::pair(1.0, 0.0), {0.0, -1.0}, {-3.0, 2.0}}) {
      Pose moved = floating_pose();
      moved.p_WB += Vec3(8.0 * periods_1, 3.0 * periods_2, 0.0);
      const WaveLoad there = sea.load(rock(), moved, tolerance);
      EXPECT_NEAR((here.force - there.force).norm(), 0.0, 1e-12);
      EXPECT_NEAR((here.torque - there.torque).norm(), 0.0, 1e-12);
      EXPECT_NEAR(here.volume, there.volume, 1e-12);
    }
    Pose between = floating_pose();
    between.p_WB.x() += 4.0;
    EXPECT_GT((here.force - sea.load(rock(), between, tolerance).force).norm(), 1e-3);
  }
}

TEST(WaveLoadOnGrids, BetweenTwoGridsIsThatOfTheirMean) {
  const auto wave = [](double k1, double k2) {
    return sampled(50, 50, {0.0, 0.0}, {0.25, 0.25}, false,
                   [=](double x1, double x2) { return 0.3 * std::cos(k1 * x1 + k2 * x2); });
  };
  const SampledGrid first = wave(1.5, 0.3);
  const SampledGrid second = wave(0.8, -0.9);
  SampledGrid mean = first;
  for (std::size_t i = 0; i < mean.samples.size(); ++i) {
    mean.samples[i] = 0.5 * (first.samples[i] + second.samples[i]);
  }
  const WaveLoad between = GridSea(first, second).load(rock(), floating_pose(), 3e-6);
  const WaveLoad of_mean = GridSea(mean).load(rock(), floating_pose(), 3e-6);
  EXPECT_LE((between.force - of_mean.force).norm(), between.force_bound + of_mean.force_bound);
  EXPECT_LE((between.torque - of_mean.torque).norm(), between.torque_bound + of_mean.torque_bound);
  EXPECT_LE(between.force_bound, 3e-6 * rock().mesh.volume);
  EXPECT_GT((GridSea(first).load(rock(), floating_pose(), 1e-6).force - of_mean.force).norm(), 1e-2);
}

TEST(WaveLoadOnGrids, AllocatesNothingAfterWarmUp) {
  std::mt19937_64 random(32);
  const GridSea sea{random_grid(random, true, 0.2, 0.5), random_grid(random, true, 0.2, 0.5)};
  const auto load_at = [&](int n) {
    Pose pose = floating_pose();
    pose.p_WB.x() += 0.1 * n;
    EXPECT_GT(sea.load(rock(), pose, 1e-3).force_bound, 0.0);
  };
  for (int n = 0; n < 50; ++n) load_at(n);
  const AllocationCount allocations;
  for (int n = 0; n < 50; ++n) load_at(n);
  EXPECT_EQ(allocations.count(), 0);
}

// A body in a sea that has a hill, far from it.
class WaveBuoyancyOnGrids : public ::testing::Test {
 protected:
  static SampledGrid hill() {
    return sampled(40, 40, {0.0, 0.0}, {0.5, 0.5}, false, [](double x1, double x2) {
      return 3.0 * std::exp(-(x1 - 15.0) * (x1 - 15.0) - (x2 - 15.0) * (x2 - 15.0));
    });
  }
  WaveBuoyancyResult at(const Vec3& p_WB, Method method = Method::kHierarchical) const {
    const Solver solver(rock().mesh, method, 1e-3);
    return buoyancy_in_waves(solver, wave_mesh_, sea_.now, {p_WB, floating_pose().q_WB}, Vec3::Zero());
  }
  bool is_decided_by_bounds(const Vec3& p_WB, WaveBuoyancyResult& outcome) const {
    const Solver solver(rock().mesh, Method::kHierarchical, 1e-3);
    const FullySubmerged submerged = submerged_constants(rock().mesh, Water{}, Vec3::Zero());
    return try_buoyancy_in_waves_from_bounds(solver, submerged, sea_.now, {p_WB, floating_pose().q_WB},
                                             Vec3::Zero(), outcome);
  }

  GridSea sea_{hill()};
  WaveMesh wave_mesh_ = make_wave_mesh(rock().mesh);
};

TEST_F(WaveBuoyancyOnGrids, IsOutOfRangeWhereTheBodyLeavesTheGrid) {
  for (const Vec3& outside : {Vec3(0.5, 5.0, 0.0), Vec3(5.0, 19.0, 0.0), Vec3(-50.0, 5.0, 0.0),
                              Vec3(5.0, 1e12, 0.0), Vec3(0.5, 5.0, 50.0), Vec3(0.5, 5.0, -50.0)}) {
    EXPECT_EQ(at(outside).result.status, BuoyancyStatus::kOutOfRange);
    EXPECT_EQ(at(outside).result.force_W, Vec3::Zero());
    WaveBuoyancyResult outcome;
    EXPECT_FALSE(is_decided_by_bounds(outside, outcome));
  }
  EXPECT_EQ(at({5.0, 5.0, 0.0}).result.status, BuoyancyStatus::kOk);
}

TEST_F(WaveBuoyancyOnGrids, KnowsDryAndSubmergedBodiesByTheWaterAroundThem) {
  WaveBuoyancyResult outcome;
  EXPECT_TRUE(is_decided_by_bounds({5.0, 5.0, 2.2}, outcome));
  EXPECT_EQ(outcome.result.immersion, Immersion::kDry);
  EXPECT_FALSE(is_decided_by_bounds({15.0, 15.0, 2.2}, outcome)) << "in the hill";
  EXPECT_EQ(at({15.0, 15.0, 2.2}).result.immersion, Immersion::kPiercing);
  EXPECT_EQ(at({5.0, 5.0, -2.2}).result.immersion, Immersion::kSubmerged);
  const double weight = Water{}.density * Water{}.gravity * rock().mesh.volume;
  EXPECT_NEAR(at({5.0, 5.0, -2.2}).result.force_W.z(), weight, 1e-3 * weight);
}

TEST_F(WaveBuoyancyOnGrids, IsApproximatedByTheMethodsWithoutABound) {
  for (const Vec3& p_WB : {Vec3(5.0, 5.0, 0.1), Vec3(14.0, 14.5, 0.8)}) {
    const WaveBuoyancyResult certified = at(p_WB);
    for (const Method method : {Method::kFastSurface, Method::kExactSurface}) {
      const WaveBuoyancyResult approximate = at(p_WB, method);
      const double share = method == Method::kFastSurface ? 3e-2 : 3e-3;
      EXPECT_NEAR((certified.result.force_W - approximate.result.force_W).norm(), 0.0,
                  share * certified.result.force_W.norm());
      EXPECT_EQ(approximate.result.force_error_bound, std::numeric_limits<double>::infinity());
    }
  }
}

}  // namespace
}  // namespace buoyancy
