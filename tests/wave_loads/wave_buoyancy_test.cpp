#include "wave_loads/wave_buoyancy.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "tests/wave_loads/brute_force.h"
#include "waves/sea.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A sphere in a regular wave.
struct Floating {
  explicit Floating(Method method) : solver(mesh, method, 1e-3) { sea.set_time(1'000'000, 0.0); }

  WaveBuoyancyResult at(double height) const {
    Pose pose;
    pose.p_WB.z() = height;
    return buoyancy_in_waves(solver, wave_mesh, sea, pose, Vec3::Zero());
  }
  bool try_from_bounds(double height, WaveBuoyancyResult& outcome) const {
    Pose pose;
    pose.p_WB.z() = height;
    const FullySubmerged submerged = submerged_constants(mesh, prepared.sea().water(), Vec3::Zero());
    return try_buoyancy_in_waves_from_bounds(solver, submerged, sea, pose, Vec3::Zero(), outcome);
  }

  HydrostaticMesh mesh = make_hydrostatic_mesh(ValidatedMesh{make_shape(SphereShape{1.0, 8}), {}});
  WaveMesh wave_mesh = make_wave_mesh(mesh);
  PreparedSea prepared{Sea::make({.systems = {RegularWave{0.4, 4.0, 0.0, 0.0}}}, Water{}).value()};
  SeaAtTime sea{prepared};
  Solver solver;
};

TEST(WaveBuoyancy, BoundsTheVolume) {
  const Floating body(Method::kHierarchical);
  for (const double height : {-0.8, -0.2, 0.3, 0.9}) {
    Pose pose;
    pose.p_WB.z() = height;
    const WaveBuoyancyResult outcome = body.at(height);
    const BruteForceLoad truth =
        brute_force_load(body.mesh.surface, body.mesh.center_B, body.sea.snapshot(), pose, Vec3::Zero(), 12);
    EXPECT_LE(std::abs(outcome.result.volume - truth.volume), outcome.volume_error_bound + truth.volume_error)
        << height;
    EXPECT_LE(outcome.volume_error_bound, 2e-3 * body.mesh.volume);
  }
}

TEST(WaveBuoyancy, HasNoErrorOfTheVolumeOfADryBody) {
  const Floating body(Method::kHierarchical);
  EXPECT_EQ(body.at(5.0).volume_error_bound, 0.0);
  WaveBuoyancyResult outcome;
  outcome.volume_error_bound = 1.0;
  ASSERT_TRUE(body.try_from_bounds(5.0, outcome));
  EXPECT_EQ(outcome.volume_error_bound, 0.0);
}

TEST(WaveBuoyancy, BoundsTheVolumeOfADeepBodyByRounding) {
  const Floating body(Method::kHierarchical);
  WaveBuoyancyResult outcome;
  ASSERT_TRUE(body.try_from_bounds(-100.0, outcome));
  EXPECT_EQ(outcome.volume_error_bound, body.mesh.rounding_bound());
  EXPECT_EQ(body.at(-2.0).volume_error_bound, body.mesh.rounding_bound());
}

TEST(WaveBuoyancy, KnowsNoErrorOfTheVolumeOfSurfaceMethods) {
  for (const Method method : {Method::kFastSurface, Method::kExactSurface}) {
    const Floating body(method);
    EXPECT_EQ(body.at(0.0).volume_error_bound, kInfinity);
    EXPECT_EQ(body.at(5.0).volume_error_bound, 0.0);
  }
}

// An open box of 20 x 6 x 4 m, without its lid, in a regular wave whose crests are `crest` metres high.
struct OpenBox {
  explicit OpenBox(double crest)
      : prepared(Sea::make({.systems = {RegularWave{2.0 * crest, 1.79, 0.0, 0.0}}}, Water{}).value()) {}

  BuoyancyStatus at(double height, std::int64_t utime) {
    sea.set_time(utime, 0.0);
    Pose pose;
    pose.p_WB.z() = height;
    return buoyancy_in_waves(solver, wave_mesh, sea, pose, Vec3::Zero()).result.status;
  }

  static HydrostaticMesh make_mesh() {
    TriangleMesh box = make_shape(BoxShape{{20.0, 6.0, 4.0}, {1, 1, 1}});
    std::erase_if(box.triangles, [&](const Triangle& t) {
      return box.vertex(t[0]).z() > 1.0 && box.vertex(t[1]).z() > 1.0 && box.vertex(t[2]).z() > 1.0;
    });
    ValidatedMesh validated{box, {}};
    for (std::int32_t i = 0; i < 8; ++i) {
      if (box.vertex(i).z() > 1.0) validated.boundary_vertices.push_back(i);
    }
    return make_hydrostatic_mesh(validated);
  }

  HydrostaticMesh mesh = make_mesh();
  WaveMesh wave_mesh = make_wave_mesh(mesh);
  PreparedSea prepared;
  SeaAtTime sea{prepared};
  Solver solver{mesh, Method::kHierarchical, 1e-3};
};

TEST(WaveBuoyancy, TakesOpenBodiesWhoseEdgesAreFarAboveTheCrests) {
  OpenBox box(0.2);
  EXPECT_EQ(box.wave_mesh.boundary_edges.size(), 4U);
  for (std::int64_t utime = 0; utime < 2'000'000; utime += 130'000) {
    EXPECT_EQ(box.at(1.0, utime), BuoyancyStatus::kOk) << utime;
    // An edge of 20 m, 1 cm over the crests, which are 5 m long.
    EXPECT_EQ(box.at(-1.79, utime), BuoyancyStatus::kOk) << utime;
    // Each crest reaches 2 cm over the edge somewhere.
    EXPECT_EQ(box.at(-1.82, utime), BuoyancyStatus::kOpenEdgeWet) << utime;
  }
}

// A box of 1 m in regular waves over a bed.
struct OverBed {
  OverBed(double depth, RegularWave wave)
      : prepared(Sea::make({.depth = depth, .systems = {wave}}, Water{}).value()) {
    sea.set_time(400'000, 0.0);
  }

  WaveBuoyancyResult at(double height) const {
    Pose pose;
    pose.p_WB.z() = height;
    return buoyancy_in_waves(solver, wave_mesh, sea, pose, Vec3::Zero());
  }

  HydrostaticMesh mesh = make_hydrostatic_mesh(ValidatedMesh{make_shape(BoxShape{{1, 1, 1}, {1, 1, 1}}), {}});
  WaveMesh wave_mesh = make_wave_mesh(mesh);
  PreparedSea prepared;
  SeaAtTime sea{prepared};
  Solver solver{mesh, Method::kHierarchical, 1e-3};
};

TEST(WaveBuoyancy, SaysThatABodyReachesBelowTheBed) {
  const OverBed body(5.0, {0.4, 3.0, 0.0, 0.0});
  EXPECT_FALSE(body.at(-4.49).below_bed);
  EXPECT_TRUE(body.at(-4.51).below_bed);
  WaveBuoyancyResult outcome;
  const Water& water = body.prepared.sea().water();
  Pose pose;
  pose.p_WB.z() = -1000.0;
  const FullySubmerged submerged = submerged_constants(body.mesh, water, Vec3::Zero());
  const OverBed calm(5.0, {0.01, 1.0, 0.0, 0.0});
  ASSERT_TRUE(
      try_buoyancy_in_waves_from_bounds(body.solver, submerged, calm.sea, pose, Vec3::Zero(), outcome));
  EXPECT_TRUE(outcome.below_bed);
}

// Below the bed the waves are those at the bed: no vertical force besides the weight of the water, and a
// horizontal one that does not depend on the depth.
TEST(WaveBuoyancy, BelowTheBedIsThatOfTheWavesAtTheBed) {
  const RegularWave wave{0.4, 3.0, 0.0, 0.0};
  const OverBed body(2.0, wave);
  const Water& water = body.prepared.sea().water();
  const double weight = water.density * water.gravity * body.mesh.volume;
  const double k = body.prepared.sea().prepared().wave_number[0];
  const double phase = -2.0 * std::numbers::pi / wave.period * 0.4;
  // The mean of -d/dx (a cos(k x + phase) / cosh kh) over the box.
  const double slope =
      0.5 * wave.height * k / std::cosh(2.0 * k) * std::sin(0.5 * k) / (0.5 * k) * std::sin(phase);
  for (const double height : {-2.6, -4.0, -8.0, -80.0, -10'000.0}) {
    const WaveBuoyancyResult outcome = body.at(height);
    ASSERT_EQ(outcome.result.status, BuoyancyStatus::kOk);
    EXPECT_LE(outcome.result.force_error_bound, 1.1e-3 * weight);
    EXPECT_LE((outcome.result.force_W - weight * Vec3(slope, 0.0, 1.0)).norm(),
              outcome.result.force_error_bound)
        << height;
  }
}

TEST(WaveBuoyancy, GivesNoLoadWhereATroughUncoversTheBed) {
  // Short waves that meet at the origin, in a trough of 2.24 m.
  WaveComponents waves;
  for (int i = 0; i < 16; ++i) waves.push_back({0.14, 1.5 + 0.05 * i, 22.5 * i, 180.0});
  const PreparedSea prepared(Sea::make({.depth = 2.0, .systems = {waves}}, Water{}).value());
  const SeaAtTime sea(prepared);
  const OverBed body(2.0, {0.01, 6.0, 0.0, 0.0});
  for (const double x : {0.0, 200.0}) {
    for (const double height : {-2.3, -2.0, -1.2, -1.0}) {
      Pose pose;
      pose.p_WB = {x, 0.0, height};
      const WaveBuoyancyResult outcome =
          buoyancy_in_waves(body.solver, body.wave_mesh, sea, pose, Vec3::Zero());
      const bool uncovered = x == 0.0 && height < -1.9;  // the box reaches down to the surface there
      EXPECT_EQ(outcome.result.status, uncovered ? BuoyancyStatus::kNotCertified : BuoyancyStatus::kOk)
          << x << ' ' << height;
    }
  }
}

}  // namespace
}  // namespace buoyancy
