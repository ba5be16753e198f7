#include "wave_loads/wave_buoyancy.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/wave_loads/body_in_sea.h"
#include "waves/sea.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A body in a sea.
struct InSea {
  InSea(HydrostaticMesh of_body, const SeaDescription& description, std::int64_t utime = 0,
        Method method = Method::kHierarchical)
      : mesh(std::move(of_body)),
        prepared(Sea::make(description, Water{}).value()),
        sea(prepared, utime),
        solver(mesh, method, 1e-3) {}
  InSea(const InSea&) = delete;
  InSea& operator=(const InSea&) = delete;

  static Pose raised(double height) { return {height * Vec3::UnitZ(), Eigen::Quaterniond::Identity()}; }
  WaveBuoyancyResult at(const Pose& pose) const {
    return buoyancy_in_waves(solver, wave_mesh, sea, pose, Vec3::Zero());
  }
  WaveBuoyancyResult at(double height) const { return at(raised(height)); }
  bool try_from_bounds(double height, WaveBuoyancyResult& outcome) const {
    const FullySubmerged submerged = submerged_constants(mesh, prepared.water(), Vec3::Zero());
    return try_buoyancy_in_waves_from_bounds(solver, submerged, sea, raised(height), Vec3::Zero(), outcome);
  }

  HydrostaticMesh mesh;
  WaveMesh wave_mesh = make_wave_mesh(mesh);
  PreparedSea prepared;
  SeaAtTime sea;
  Solver solver;
};

// A sphere in a regular wave.
struct Floating : InSea {
  explicit Floating(Method method)
      : InSea(mesh_of(SphereShape{1.0, 8}), {.systems = {RegularWave{0.4, 4.0, 0.0, 0.0}}}, 1'000'000,
              method) {}
};

TEST(WaveBuoyancy, BoundsTheVolume) {
  const Floating body(Method::kHierarchical);
  for (const double height : {-0.8, -0.2, 0.3, 0.9}) {
    Pose pose;
    pose.p_WB.z() = height;
    const WaveBuoyancyResult outcome = body.at(height);
    const ReferenceLoad truth = true_wave_load(body.mesh, body.prepared, 1'000'000, pose, 1e-4);
    EXPECT_LE(std::abs(outcome.result.volume - truth.volume), outcome.volume_error_bound + truth.volume_error)
        << height;
    EXPECT_LE(outcome.volume_error_bound, 2e-3 * body.mesh.volume);
  }
}

TEST(WaveBuoyancy, AddsTheRoundingOfTheMeshToTheBoundsOfTheLoad) {
  const Floating body(Method::kHierarchical);
  const Water& water = body.prepared.water();
  const double weight = water.density * water.gravity;
  const double rounding = body.mesh.rounding_bound();
  for (const double height : {-2.0, -0.8, -0.2, 0.3, 0.9}) {
    const WaveBuoyancyResult outcome = body.at(height);
    const WaveLoad load = wave_load({&body.mesh, &body.wave_mesh.patches, body.solver.tolerance()},
                                    body.prepared.expansion(), body.sea, InSea::raised(height), Vec3::Zero());
    EXPECT_EQ(outcome.volume_error_bound, load.volume_bound + rounding) << height;
    EXPECT_EQ(outcome.result.force_error_bound, weight * (load.force_bound + rounding)) << height;
    EXPECT_EQ(outcome.result.torque_error_bound,
              weight * (load.torque_bound + rounding * body.mesh.max_lever_arm(Vec3::Zero())))
        << height;
  }
}

// A sea of two waves that grows along a ramp, at half of its amplitudes.
SeaDescription half_grown(WavePressure pressure, double depth) {
  SeaDescription description{.systems = {WaveComponents{{0.3, 1.6, 30.0, 50.0}, {0.1, 2.7, -70.0, 10.0}}}};
  description.pressure = pressure;
  description.depth = depth;
  description.ramp = 20.0;
  return description;
}

// docs/wave_mathematics.md, "Deep, calm, high": bound on the force of the waves over rho g V on a body whose
// highest point is at this height over the level.
double deep_bound(const SeaAtTime& sea, double highest) {
  const PreparedComponents& waves = sea.sea().prepared();
  const double factor = sea.amplitude_factor();
  const double h = sea.sea().depth();
  double crest = 0.0;  // A_0
  double slope = 0.0;  // L_1
  for (std::size_t i = 0; i < waves.size(); ++i) {
    crest += factor * waves.amplitude[i];
    slope += factor * waves.amplitude[i] * waves.wave_number[i];
  }
  if (sea.sea().pressure() == WavePressure::kHydrostatic) return slope;
  if (highest < -h) return factor * sea.sea().max_gradient(-h);
  const double least = std::isinf(h) ? 1.0 : h / (h + crest);
  const double q = std::isinf(h) ? 1.0 : h / (h - crest);
  const double w = std::isinf(h) ? 1.0 : 1.0 + highest / h;
  // V_1: the norm of the derivative of the places, a stretch with a shear.
  Eigen::Matrix2d derivative;
  derivative << 1.0, 0.0, w * q * q * slope, q;
  const double norm = Eigen::JacobiSVD<Eigen::Matrix2d>(derivative).singularValues()[0];
  return factor * sea.sea().max_gradient(least * (highest + crest)) * norm;
}

TEST(WaveBuoyancy, BoundsTheWavesOnADeepBodyByTheFormula) {
  TriangleMesh box = make_shape(BoxShape{{0.7, 0.2, 0.4}, {2, 1, 1}});
  for (double& x : box.x) x += 3.0;
  const HydrostaticMesh mesh = make_hydrostatic_mesh(ValidatedMesh{box, {}});
  const Solver solver(mesh, Method::kHierarchical, 1e9);
  const Water water{.up_W = Vec3(0.48, -0.6, 0.64), .level = 5.0};
  const Vec3 reference_B(-1.0, 2.0, 0.5);
  const FullySubmerged submerged = submerged_constants(mesh, water, reference_B);
  int below_bed = 0;
  for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
    for (const double depth : {kInfinity, 12.0, 3.0, 1.1}) {
      const PreparedSea prepared(Sea::make(half_grown(pressure, depth), water).value());
      const SeaAtTime sea(prepared, 10'000'000);
      for (const double center : {-0.9, -1.4, -2.5, -6.0, -20.0}) {
        Pose pose;
        pose.q_WB = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized();
        pose.p_WB =
            (water.level + center) * water.up_W + 40.0 * prepared.axes().e1_W - pose.q_WB * mesh.center_B;
        double highest = -kInfinity;
        for (std::size_t i = 0; i < box.vertex_count(); ++i) {
          const Vec3 p_W = pose.p_WB + pose.q_WB * box.vertex(static_cast<std::int32_t>(i));
          highest = std::max(highest, water.up_W.dot(p_W) - water.level);
        }
        below_bed += highest < -depth ? 1 : 0;
        SCOPED_TRACE(testing::Message() << to_string(pressure) << ", depth " << depth << ", at " << center);
        WaveBuoyancyResult outcome;
        ASSERT_TRUE(try_buoyancy_in_waves_from_bounds(solver, submerged, sea, pose, reference_B, outcome));
        const double bound = deep_bound(sea, highest) * submerged.buoyant_force;
        EXPECT_NEAR(outcome.result.force_error_bound / (submerged.force_error_bound + bound), 1.0, 1e-9);
        EXPECT_NEAR(outcome.result.torque_error_bound /
                        (submerged.torque_error_bound + bound * mesh.max_lever_arm(reference_B)),
                    1.0, 1e-9);
        EXPECT_EQ(outcome.volume_error_bound, mesh.rounding_bound());
      }
    }
  }
  EXPECT_GT(below_bed, 3);
}

// B_1 is a table over heights: it may give the sum of a shallower row, which is no farther away than the
// ratio of the rows.
TEST(PreparedSea, BoundsTheGradientByThatOfTheRowAbove) {
  for (const double depth : {kInfinity, 12.0, 3.0}) {
    const PreparedSea prepared(Sea::make(half_grown(WavePressure::kWheeler, depth), {}).value());
    const PreparedComponents& waves = prepared.prepared();
    const auto sum_at = [&](double z) {
      double sum = 0.0;
      for (std::size_t i = 0; i < waves.size(); ++i) {
        const double k = waves.wave_number[i];
        const double decay =
            std::isinf(depth) ? std::exp(k * z) : std::cosh(k * (z + depth)) / std::cosh(k * depth);
        sum += waves.amplitude[i] * k * decay;
      }
      return sum;
    };
    const double k_max = prepared.expansion().k_max;
    for (double z = 0.0; z > -std::min(depth, 10.0); z -= 0.037) {
      EXPECT_GE(prepared.max_gradient(z), sum_at(z)) << z;
      EXPECT_LE(prepared.max_gradient(z), sum_at(-((1.0 - z * k_max) / 1.1 - 1.0) / k_max) * (1.0 + 1e-9))
          << z;
    }
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

// 20 x 6 x 4 m, without its lid.
HydrostaticMesh open_box() {
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

TEST(WaveBuoyancy, TakesOpenBodiesWhoseEdgesAreFarAboveTheCrests) {
  // Crests of 0.2 m.
  InSea box(open_box(), {.systems = {RegularWave{0.4, 1.79, 0.0, 0.0}}});
  EXPECT_EQ(box.wave_mesh.boundary_edges.size(), 4U);
  for (std::int64_t utime = 0; utime < 2'000'000; utime += 130'000) {
    box.sea.set_time(utime, 0.0);
    EXPECT_EQ(box.at(1.0).result.status, BuoyancyStatus::kOk) << utime;
    // An edge of 20 m, 1 cm over the crests, which are 5 m long.
    EXPECT_EQ(box.at(-1.79).result.status, BuoyancyStatus::kOk) << utime;
    // Each crest reaches 2 cm over the edge somewhere.
    EXPECT_EQ(box.at(-1.82).result.status, BuoyancyStatus::kOpenEdgeWet) << utime;
  }
}

// A box of 1 m in regular waves over a bed.
struct OverBed : InSea {
  OverBed(double depth, RegularWave wave)
      : InSea(mesh_of(BoxShape{{1, 1, 1}, {1, 1, 1}}), {.depth = depth, .systems = {wave}}, 400'000) {}
};

TEST(WaveBuoyancy, SaysThatABodyReachesBelowTheBed) {
  const OverBed body(5.0, {0.4, 3.0, 0.0, 0.0});
  EXPECT_FALSE(body.at(-4.49).below_bed);
  EXPECT_TRUE(body.at(-4.51).below_bed);
  WaveBuoyancyResult outcome;
  ASSERT_TRUE(OverBed(5.0, {0.01, 1.0, 0.0, 0.0}).try_from_bounds(-1000.0, outcome));
  EXPECT_TRUE(outcome.below_bed);
}

// Below the bed the waves are those at the bed: no vertical force besides the weight of the water, and a
// horizontal one that does not depend on the depth.
TEST(WaveBuoyancy, BelowTheBedIsThatOfTheWavesAtTheBed) {
  const RegularWave wave{0.4, 3.0, 0.0, 0.0};
  const OverBed body(2.0, wave);
  const Water& water = body.prepared.water();
  const double weight = water.density * water.gravity * body.mesh.volume;
  const double k = body.prepared.prepared().wave_number[0];
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
