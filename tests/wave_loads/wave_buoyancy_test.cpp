#include "wave_loads/wave_buoyancy.h"

#include <cmath>
#include <limits>

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

}  // namespace
}  // namespace buoyancy
