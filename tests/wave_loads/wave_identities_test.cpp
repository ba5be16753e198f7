// Changes of a sea and of a body that leave the load as it is, and seas whose load is known from others.
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "hydrostatics/buoyancy.h"
#include "tests/wave_loads/body_in_sea.h"
#include "tests/waves/seas.h"

namespace buoyancy {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

WaveComponents some_waves() {
  return {{0.12, 2.2, 25.0, 40.0}, {0.08, 2.9, -50.0, 130.0}, {0.05, 3.9, 80.0, -110.0}};
}

Pose floating_pose() {
  Pose pose;
  pose.p_WB = {5.0, 6.0, -0.2};
  pose.q_WB = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized();
  return pose;
}

const SeaBody& rock() {
  static const SeaBody body(RockShape{1.0, 16, 0.4, 3});
  return body;
}

// Both methods, hierarchical first. What is compared has the same patches and the same points, so that loads
// differ by rounding alone, which is far below the bound.
void expect_same(const TestSea& sea, const Pose& pose, const TestSea& other_sea, const Pose& other_pose,
                 double tolerance = 5e-6) {
  const std::vector<std::pair<WaveLoad, WaveLoad>> loads{
      {hierarchical_load(rock(), sea, pose, 1e-5), hierarchical_load(rock(), other_sea, other_pose, 1e-5)},
      {exact_surface_load(rock(), sea, pose), exact_surface_load(rock(), other_sea, other_pose)}};
  for (const auto& [one, other] : loads) {
    EXPECT_GT(one.volume, 0.2 * rock().mesh.volume);
    EXPECT_LT((one.force - other.force).norm(), tolerance);
    EXPECT_LT((one.torque - other.torque).norm(), tolerance);
    EXPECT_NEAR(one.volume, other.volume, tolerance);
  }
}

class WaveIdentity : public ::testing::TestWithParam<WavePressure> {};

TEST_P(WaveIdentity, HoldsForABodyAndASeaThatTurnTogether) {
  constexpr double kDegrees = 37.0;
  WaveComponents turned = some_waves();
  for (WaveComponent& wave : turned) wave.direction += kDegrees;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(kDegrees * kPi / 180.0, Vec3::UnitZ()));
  const TestSea sea(sea_of({some_waves()}, GetParam()), 2'345'678);
  const TestSea turned_sea(sea_of({turned}, GetParam()), 2'345'678);
  const Pose pose = floating_pose();
  expect_same(sea, pose, turned_sea, {turn * pose.p_WB, turn * pose.q_WB});
}

TEST_P(WaveIdentity, HoldsForEveryUpwardDirection) {
  const TestSea sea(sea_of({some_waves()}, GetParam()), 2'345'678);
  const Pose pose = floating_pose();
  for (const Vec3& up : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(0.6, 0.0, -0.8)}) {
    Water water;
    water.up_W = up;
    const TestSea other(sea_of({some_waves()}, GetParam()), 2'345'678, water);
    Mat3 R;
    R << other.sea.axes().e1_W, other.sea.axes().e2_W, up;
    expect_same(sea, pose, other, {R * pose.p_WB, Eigen::Quaterniond(R) * pose.q_WB});
  }
}

TEST_P(WaveIdentity, HoldsForAShiftOfTheLevel) {
  Water water;
  water.level = 7.5;
  const TestSea sea(sea_of({some_waves()}, GetParam()), 2'345'678);
  const TestSea other(sea_of({some_waves()}, GetParam()), 2'345'678, water);
  Pose raised = floating_pose();
  raised.p_WB.z() += water.level;
  expect_same(sea, floating_pose(), other, raised);
}

TEST_P(WaveIdentity, HoldsAPeriodLater) {
  const SeaDescription description = sea_of({RegularWave{0.4, 4.0, 20.0, 30.0}}, GetParam());
  const TestSea sea(description, 1'234'567);
  const TestSea later(description, 1'234'567 + 4'000'000);
  const TestSea between(description, 1'234'567 + 2'000'000);
  expect_same(sea, floating_pose(), later, floating_pose(), 1e-7);
  EXPECT_GT((exact_surface_load(rock(), sea, floating_pose()).force -
             exact_surface_load(rock(), between, floating_pose()).force)
                .norm(),
            0.05);
}

// Phases are reduced from 1e6 m and more.
TEST_P(WaveIdentity, HoldsManyWavesAway) {
  const TestSea sea(sea_of({RegularWave{0.4, 4.0, 0.0, 30.0}}, GetParam()), 1'234'567);
  Pose far = floating_pose();
  far.p_WB.x() += 40'000.0 * 2.0 * kPi / sea.sea.prepared().wave_number[0];
  expect_same(sea, floating_pose(), sea, far, 1e-6);
}

TEST_P(WaveIdentity, HoldsForComponentsThatAreSplit) {
  WaveComponents split;
  for (WaveComponent wave : some_waves()) {
    wave.amplitude *= 0.5;
    split.push_back(wave);
    split.push_back(wave);
  }
  const TestSea sea(sea_of({some_waves()}, GetParam()), 2'345'678);
  const TestSea other(sea_of({split}, GetParam()), 2'345'678);
  expect_same(sea, floating_pose(), other, floating_pose());
}

// Components of one direction are summed together; those that differ by a hair are not.
TEST_P(WaveIdentity, HoldsForDirectionsThatDifferByAHair) {
  const IrregularWaves waves{
      .significant_wave_height = 0.5, .peak_period = 3.0, .gamma = {}, .spreading = 10.0, .frequencies = {}};
  for (const double depth : {kInfinity, 3.0}) {
    const TestSea sea(sea_of({waves}, GetParam(), depth), 2'345'678);
    WaveComponents components = sea.sea.components();
    for (std::size_t i = 0; i < components.size(); ++i) {
      components[i].direction += 1e-9 * static_cast<double>(i);
    }
    const TestSea other(sea_of({components}, GetParam(), depth), 2'345'678);
    ASSERT_TRUE(sea.expansion.slots.any());
    ASSERT_FALSE(other.expansion.slots.any());
    expect_same(sea, floating_pose(), other, floating_pose(), 1e-7);
    const WaveLoad one = hierarchical_load(rock(), sea, floating_pose(), 1e-3);
    const WaveLoad two = hierarchical_load(rock(), other, floating_pose(), 1e-3);
    EXPECT_LT((one.force - two.force).norm(), 1e-5) << "in single precision";
    EXPECT_LT((one.torque - two.torque).norm(), 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Pressures, WaveIdentity,
                         ::testing::Values(WavePressure::kWheeler, WavePressure::kHydrostatic),
                         [](const auto& pressure) { return std::string(to_string(pressure.param)); });

TEST(WaveLimit, WheelerInVeryLongWavesIsThePlaneAtTheHeightOfTheCrest) {
  const Pose pose = floating_pose();
  double previous = kInfinity;
  for (const double k : {2e-2, 2e-3, 2e-4}) {
    // The crest is at the body.
    const double phase = -k * pose.p_WB.x() * 180.0 / kPi;
    constexpr double kA = 0.3;
    const TestSea sea(sea_of({WaveComponents{{kA, std::sqrt(kStandardGravity * k), 0.0, phase}}}));
    Water raised;
    raised.level = kA;
    raised.density = raised.gravity = 1.0;
    const BuoyancyResult plane =
        buoyancy(Solver(rock().mesh, Method::kHierarchical), pose, raised, Vec3::Zero());
    const WaveLoad load = hierarchical_load(rock(), sea, pose, 1e-6);
    const WaveLoad exact = exact_surface_load(rock(), sea, pose);
    const double error = (pose.q_WB * exact.force - plane.force_W).norm();
    const double expected = k * kA * rock().mesh.volume;
    EXPECT_LT(error, expected);
    EXPECT_LT((pose.q_WB * load.force - plane.force_W).norm(), load.force_bound + expected);
    EXPECT_LT((pose.q_WB * load.torque - plane.torque_W).norm(), load.torque_bound + expected);
    EXPECT_LT(error, previous / 8.0);  // in proportion to k
    previous = error;
  }
}

TEST(WaveLimit, HydrostaticInLongWavesIsTheTangentPlane) {
  const Pose pose = floating_pose();
  double previous = kInfinity;
  for (const double k : {8e-3, 4e-3, 2e-3}) {
    // The body is on the slope.
    const double phase = -90.0 - k * pose.p_WB.x() * 180.0 / kPi;
    const double a = 0.2 / k;
    const TestSea sea(sea_of({WaveComponents{{a, std::sqrt(kStandardGravity * k), 0.0, phase}}},
                             WavePressure::kHydrostatic));
    Water tilted;
    tilted.up_W = Vec3(-0.2, 0.0, 1.0).normalized();
    tilted.level = tilted.up_W.dot(Vec3(pose.p_WB.x(), pose.p_WB.y(), 0.0));
    tilted.density = std::hypot(1.0, 0.2);
    tilted.gravity = 1.0;
    const BuoyancyResult plane =
        buoyancy(Solver(rock().mesh, Method::kHierarchical), pose, tilted, Vec3::Zero());
    const double error = (pose.q_WB * exact_surface_load(rock(), sea, pose).force - plane.force_W).norm();
    EXPECT_LT(error, 4.0 * a * k * k * rock().mesh.volume);
    // On the slope the curvature is zero: a k^2 L^2 vanishes, and a k^3 L^3 is left.
    EXPECT_LT(error, previous / 3.0);
    previous = error;
    const WaveLoad load = hierarchical_load(rock(), sea, pose, 1e-5);
    EXPECT_LT((pose.q_WB * load.force - plane.force_W).norm(), load.force_bound + 1.01 * error);
  }
}

TEST(WaveLimit, HydrostaticDoesNotKnowTheDepth) {
  // The same wave numbers, so that only the pressure could differ.
  WaveComponents deep = some_waves();
  WaveComponents finite = some_waves();
  constexpr double kDepth = 2.0;
  for (WaveComponent& wave : finite) {
    const double k = wave.angular_frequency * wave.angular_frequency / kStandardGravity;
    wave.angular_frequency = std::sqrt(kStandardGravity * k * std::tanh(k * kDepth));
  }
  const TestSea sea(sea_of({deep}, WavePressure::kHydrostatic));
  const TestSea other(sea_of({finite}, WavePressure::kHydrostatic, kDepth));
  expect_same(sea, floating_pose(), other, floating_pose(), 1e-6);
  const TestSea wheeler(sea_of({deep}));
  const TestSea other_wheeler(sea_of({finite}, WavePressure::kWheeler, kDepth));
  EXPECT_GT((exact_surface_load(rock(), wheeler, floating_pose()).force -
             exact_surface_load(rock(), other_wheeler, floating_pose()).force)
                .norm(),
            1e-3);
}

TEST(WaveLimit, WheelerTendsToDeepWaterAsOneOverTheDepth) {
  // z' - s = -s eta / (h + eta) changes the pressure by a k exp(k s) |s| eta / h <= a eta / (e h).
  constexpr double kA = 0.2;
  constexpr double kW = 3.5;
  const double k = kW * kW / kStandardGravity;
  const WaveComponents wave{{kA, kW, 30.0, 10.0}};
  const TestSea deep(sea_of({wave}));
  Pose pose = floating_pose();
  pose.p_WB.z() = -0.5;
  const WaveLoad load = hierarchical_load(rock(), deep, pose, 1e-6);
  const WaveLoad exact = exact_surface_load(rock(), deep, pose);
  double previous = 0.0;
  for (const double depth : {20.0, 40.0, 80.0}) {
    ASSERT_LT(std::exp(-2.0 * k * depth), 1e-9);  // nothing else depends on the depth
    const TestSea finite(sea_of({wave}, WavePressure::kWheeler, depth));
    const double difference = (exact_surface_load(rock(), finite, pose).force - exact.force).norm();
    const double bound = rock().mesh.area * kA * kA / (std::numbers::e * depth);
    EXPECT_LT(difference, bound);
    EXPECT_GT(difference, 1e-3 * bound);
    if (previous > 0.0) {
      EXPECT_NEAR(difference / previous, 0.5, 0.02) << depth;
    }
    previous = difference;
    const WaveLoad other = hierarchical_load(rock(), finite, pose, 1e-6);
    EXPECT_NEAR((other.force - load.force).norm(), difference, load.force_bound + other.force_bound);
  }
}

}  // namespace
}  // namespace buoyancy
