// The stress catalogue, "Waves": seas and bodies at the edges of what wave loads have to take. The gate is
// the bound that is published with the load.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/forced_target.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"
#include "tests/truth/reference_load.h"
#include "tests/waves/seas.h"
#include "wave_loads/wave_load.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

struct WaveBodyUnderTest {
  std::string name;
  TriangleMesh source;
  HydrostaticMesh mesh;
  PatchTree tree;

  WaveBodyUnderTest(std::string body_name, TriangleMesh from)
      : name(std::move(body_name)),
        source(std::move(from)),
        mesh(make_hydrostatic_mesh({source, {}})),
        tree(build_patch_tree(mesh.surface)) {}
};

const std::vector<WaveBodyUnderTest>& wave_bodies() {
  static const std::vector<WaveBodyUnderTest> bodies = [] {
    std::vector<WaveBodyUnderTest> made;
    made.reserve(4);
    made.emplace_back("box", make_shape(BoxShape{}));
    made.emplace_back("rock", make_shape(RockShape{0.6, 8, 0.4, 7}));
    made.emplace_back("torus knot", make_shape(TorusKnotShape{.tubular = 60, .radial = 6}));
    made.emplace_back("Wigley hull", make_shape(WigleyShape{2.0, 0.4, 0.25, 0.1, 16, 6}));
    return made;
  }();
  return bodies;
}

// Random poses across the surface at X = (x1, x2), above the bed.
Pose pose_across(RandomPoses& random, const WaveBodyUnderTest& body, const Sea& sea,
                 const SeaSnapshot& snapshot, double x1, double x2) {
  Pose pose;
  pose.q_WB = random.rotation();
  double zeta = snapshot.elevation(x1, x2) + random.uniform(-0.3, 0.3) * body.mesh.diagonal;
  if (!std::isinf(sea.depth())) zeta = std::max(zeta, 0.5 * body.mesh.diagonal - sea.depth());
  const HorizontalAxes& axes = sea.axes();
  pose.p_WB = x1 * axes.e1_W + x2 * axes.e2_W + (sea.water().level + zeta) * sea.water().up_W -
              pose.q_WB * body.mesh.center_B;
  return pose;
}

struct Situation {
  const WaveBodyUnderTest& body;
  const Sea& sea;
  std::int64_t utime;
  Pose pose;
  double tolerance;
};

// Calls visit(instruction set, load) for every instruction set.
template <typename Visit>
void visit_loads(const Situation& at, const Visit& visit) {
  SeaSnapshot snapshot(at.sea);
  snapshot.set_time(at.utime);
  const SeaExpansion expansion(at.sea);
  const WaveBody body{&at.body.mesh, &at.body.tree, at.tolerance};
  for (const std::string& target : simd_targets()) {
    const ForcedTarget forced(target);
    visit(at.body.name + " on " + target, wave_load(body, expansion, snapshot, at.pose, Vec3::Zero()));
  }
}

// Compares loads with adaptive integration, which has to be ten times as accurate as the bound.
void check_by_reference(StressCase& stress, const Situation& at) {
  const ReferenceSea reference(at.sea, at.utime, 0.0, at.pose, at.body.mesh.center_B);
  double bound = kInfinity;
  double torque_bound = kInfinity;
  double volume_bound = kInfinity;
  visit_loads(at, [&](const std::string&, const WaveLoad& load) {
    bound = std::min(bound, load.force_bound);
    torque_bound = std::min(torque_bound, load.torque_bound);
    volume_bound = std::min(volume_bound, load.volume_bound);
  });
  const ReferenceLoad truth = reference_load(at.body.source, at.body.mesh.center_B, reference, Vec3::Zero(),
                                             {.force_error = 0.05 * bound,
                                              .torque_error = 0.05 * torque_bound,
                                              .volume_error = 0.05 * volume_bound});
  stress.require(truth.resolved, at.body.name + ": accuracy of the oracle");
  visit_loads(at, [&](const std::string& where, const WaveLoad& load) {
    stress.check((load.force - truth.force).norm(), load.force_bound + truth.force_error, where + ", force");
    stress.check((load.torque - truth.torque).norm(), load.torque_bound + truth.torque_error,
                 where + ", torque");
    stress.check(std::abs(load.volume - truth.volume), load.volume_bound + truth.volume_error,
                 where + ", volume");
  });
}

// Compares loads with those of the water at rest, from which they may differ by `allowed` times the surface.
void check_by_still_water(StressCase& stress, const Situation& at, double allowed) {
  const Solver solver(at.body.mesh, Method::kHierarchical);
  const BuoyancyResult still = buoyancy(solver, at.pose, at.sea.water(), Vec3::Zero());
  const double lever = at.body.mesh.max_lever_arm(Vec3::Zero());
  visit_loads(at, [&](const std::string& where, const WaveLoad& load) {
    const double slack = allowed * at.body.mesh.area + still.force_error_bound;
    stress.check((at.pose.q_WB * load.force - still.force_W).norm(), load.force_bound + slack,
                 where + ", force");
    stress.check((at.pose.q_WB * load.torque - still.torque_W).norm(), load.torque_bound + slack * lever,
                 where + ", torque");
    stress.check(std::abs(load.volume - still.volume), 2.0 * load.force_bound + slack,
                 where + ", volume (twice the bound)");
  });
}

// A wave's angular frequency in water of gravity 1, which these seas have.
double frequency_of(double length, double depth = kInfinity) {
  const double k = 2.0 * kPi / length;
  return std::sqrt(k * (std::isinf(depth) ? 1.0 : std::tanh(k * depth)));
}

constexpr WavePressure kPressures[] = {WavePressure::kWheeler, WavePressure::kHydrostatic};

TEST(StressWaves, TakesAmplitudesOfZero) {
  StressCase stress("waves: amplitudes of 0, before a ramp begins", "hierarchical in still water",
                    "the load's bound");
  RandomPoses random(1);
  for (const WavePressure pressure : kPressures) {
    SeaDescription description = sea_of({WaveComponents{{0.2, frequency_of(3.0), 30.0, 0.0}}}, pressure);
    description.ramp = 10.0;
    description.time_origin = 1'000'000;
    const Sea sea = Sea::make(description, kStressWater).value();
    SeaSnapshot snapshot(sea);
    snapshot.set_time(0);
    for (const WaveBodyUnderTest& body : wave_bodies()) {
      for (const double tolerance : {1e-3, 1e-5}) {
        const Pose pose = pose_across(random, body, sea, snapshot, 1.0, 2.0);
        check_by_still_water(stress, {body, sea, 0, pose, tolerance}, 0.0);
      }
    }
  }
}

TEST(StressWaves, TakesTinyAmplitudes) {
  StressCase stress("waves: one component of 1e-12 m, of 1e-300 m", "hierarchical in still water",
                    "the load's bound + 2 a A_s");
  RandomPoses random(2);
  for (const WavePressure pressure : kPressures) {
    for (const double amplitude : {1e-12, 1e-300}) {
      const Sea sea = Sea::make(sea_of({WaveComponents{{amplitude, frequency_of(3.0), 30.0, 0.0}}}, pressure),
                                kStressWater)
                          .value();
      const SeaSnapshot snapshot(sea);
      for (const WaveBodyUnderTest& body : wave_bodies()) {
        for (const double tolerance : {1e-3, 1e-5}) {
          const Pose pose = pose_across(random, body, sea, snapshot, 1.0, 2.0);
          check_by_still_water(stress, {body, sea, 0, pose, tolerance}, 2.0 * amplitude);
        }
      }
    }
  }
}

TEST(StressWaves, TakesWavesOfATenthOfAMillimetre) {
  StressCase stress("waves: ripples of 1e-4 m and 1e-6 m high on bodies of 1 m",
                    "hierarchical in still water", "the load's bound + 2 a A_s");
  RandomPoses random(3);
  for (const WavePressure pressure : kPressures) {
    const Sea sea =
        Sea::make(sea_of({WaveComponents{{5e-7, frequency_of(1e-4), 30.0, 0.0}}}, pressure), kStressWater)
            .value();
    const SeaSnapshot snapshot(sea);
    for (const WaveBodyUnderTest& body : wave_bodies()) {
      const Pose pose = pose_across(random, body, sea, snapshot, 1.0, 2.0);
      check_by_still_water(stress, {body, sea, 0, pose, 1e-3}, 1e-6);
    }
  }
}

TEST(StressWaves, TakesVeryLongWaves) {
  StressCase stress("waves: 1e6 m long, 2,000 m high", "adaptive integration of the sea", "the load's bound");
  RandomPoses random(4);
  for (const WavePressure pressure : kPressures) {
    const Sea sea =
        Sea::make(sea_of({WaveComponents{{1e3, frequency_of(1e6), 30.0, 70.0}}}, pressure), kStressWater)
            .value();
    const SeaSnapshot snapshot(sea);
    for (const WaveBodyUnderTest& body : wave_bodies()) {
      for (const double tolerance : {1e-2, 1e-5}) {
        const Pose pose = pose_across(random, body, sea, snapshot, 1e5 * random.uniform(-1.0, 1.0), 2.0);
        check_by_reference(stress, {body, sea, 0, pose, tolerance});
      }
    }
  }
}

TEST(StressWaves, TakesBodiesFarAwayToday) {
  StressCase stress("waves: body 1e6 m away, utime of 2026, up an axis and tilted",
                    "adaptive integration of the sea", "the load's bound");
  RandomPoses random(5);
  Water tilted = kStressWater;
  tilted.up_W = Vec3(0.3, -0.5, 0.7).normalized();
  for (const Water& water : {kStressWater, tilted}) {
    const Sea sea = Sea::make(sea_of({WaveComponents{{0.1, frequency_of(3.0), 30.0, 70.0},
                                                     {0.05, frequency_of(1.5), -110.0, 10.0}}}),
                              water)
                        .value();
    const std::int64_t utime = 1'790'000'000'123'456;
    SeaSnapshot snapshot(sea);
    snapshot.set_time(utime);
    for (const WaveBodyUnderTest& body : wave_bodies()) {
      for (const double tolerance : {1e-3, 1e-5}) {
        const double x1 = 1e6 * random.uniform(-1.0, 1.0);
        const double x2 = 1e6 * random.uniform(-1.0, 1.0);
        const Pose pose = pose_across(random, body, sea, snapshot, x1, x2);
        check_by_reference(stress, {body, sea, utime, pose, tolerance});
      }
    }
  }
}

TEST(StressWaves, TakesWaterHardlyDeeperThanItsTroughs) {
  StressCase stress("waves: water deeper than its troughs by 1 %, by 1e-6", "adaptive integration of the sea",
                    "the load's bound");
  RandomPoses random(6);
  for (const double excess : {1e-2, 1e-6}) {
    const double depth = 0.4 * (1.0 + excess);
    const Sea sea = Sea::make(sea_of({WaveComponents{{0.3, frequency_of(8.0, depth), 30.0, 70.0},
                                                     {0.1, frequency_of(5.0, depth), -110.0, 10.0}}},
                                     WavePressure::kWheeler, depth),
                              kStressWater)
                        .value();
    const SeaSnapshot snapshot(sea);
    for (const WaveBodyUnderTest& body : wave_bodies()) {
      for (int turn = 0; turn < 2; ++turn) {
        const Pose pose = pose_across(random, body, sea, snapshot, random.uniform(-9.0, 9.0), turn);
        check_by_reference(stress, {body, sea, 0, pose, 1e-3});
      }
    }
  }
}

TEST(StressWaves, TakesSteepSeas) {
  StressCase stress("waves: too steep for linear theory (ak 1.2)", "adaptive integration of the sea",
                    "the load's bound");
  RandomPoses random(7);
  const Sea sea =
      Sea::make(sea_of({WaveComponents{{1.2 * 3.0 / (2.0 * kPi), frequency_of(3.0), 30.0, 70.0}}}),
                kStressWater)
          .value();
  const SeaSnapshot snapshot(sea);
  for (const WaveBodyUnderTest& body : wave_bodies()) {
    for (int turn = 0; turn < 3; ++turn) {
      const Pose pose = pose_across(random, body, sea, snapshot, random.uniform(-9.0, 9.0), turn);
      check_by_reference(stress, {body, sea, 0, pose, 1e-3});
    }
  }
}

TEST(StressWaves, TakesDegenerateTrianglesAndNeedles) {
  StressCase stress("waves: slivers, collinear triangles, needles of 1 : 8192, plates of 1 : 1000",
                    "adaptive integration of the sea", "the load's bound");
  RandomPoses random(8);
  std::vector<WaveBodyUnderTest> bodies;
  bodies.reserve(4);
  // An edge is split so close to its end that the point is the end in float32, and in its middle.
  for (const double share : {1e-12, 0.5}) {
    TriangleMesh box = make_shape(BoxShape{});
    const Triangle face = box.triangles[0];
    const std::int32_t middle =
        box.add_vertex(box.vertex(face[0]) + share * (box.vertex(face[1]) - box.vertex(face[0])));
    box.triangles[0] = {face[0], middle, face[2]};
    box.triangles.push_back({middle, face[1], face[2]});
    // The other side of the edge keeps it: a triangle of no area closes the gap.
    box.triangles.push_back({face[0], face[1], middle});
    bodies.emplace_back(share < 0.5 ? "box with a sliver" : "box with a collinear triangle", std::move(box));
  }
  bodies.emplace_back("needle", make_shape(BoxShape{.size = {8192, 1, 1}, .segments = {40, 1, 1}}));
  bodies.emplace_back("plate", make_shape(BoxShape{.size = {1, 1, 1e-3}, .segments = {6, 6, 1}}));
  for (const WaveBodyUnderTest& body : bodies) {
    const double size = body.mesh.diagonal;
    const Sea sea = Sea::make(sea_of({WaveComponents{{0.02 * size, frequency_of(3.0 * size), 30.0, 70.0},
                                                     {0.01 * size, frequency_of(1.5 * size), -110.0, 10.0}}}),
                              kStressWater)
                        .value();
    const SeaSnapshot snapshot(sea);
    for (int turn = 0; turn < 3; ++turn) {
      const Pose pose = pose_across(random, body, sea, snapshot, random.uniform(-9.0, 9.0), turn);
      check_by_reference(stress, {body, sea, 0, pose, 1e-2});
    }
  }
}

TEST(StressWaves, BoundsHoldWhereTolerancesCannotBeMet) {
  StressCase stress("waves: a tolerance of 1e-9, which float32 meshes cannot meet",
                    "adaptive integration of the sea", "the load's bound");
  RandomPoses random(9);
  const Sea sea =
      Sea::make(sea_of({WaveComponents{{0.1, frequency_of(6.0), 30.0, 70.0}}}), kStressWater).value();
  const SeaSnapshot snapshot(sea);
  for (const WaveBodyUnderTest& body : wave_bodies()) {
    const Pose pose = pose_across(random, body, sea, snapshot, 1.0, 2.0);
    check_by_reference(stress, {body, sea, 0, pose, 1e-9});
  }
}

}  // namespace
}  // namespace buoyancy
