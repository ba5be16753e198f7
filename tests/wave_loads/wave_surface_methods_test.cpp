#include "wave_loads/wave_surface_methods.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "hydrostatics/buoyancy.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/forced_target.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/support/allocation_count.h"
#include "tests/wave_loads/body_in_sea.h"
#include "tests/waves/seas.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

HydrostaticMesh rock(double radius, std::int32_t frequency) {
  return mesh_of(RockShape{radius, frequency, 0.4, 3});
}

HydrostaticMesh box(double size, std::int32_t segments) {
  return mesh_of(BoxShape{{size, 1.5 * size, 0.8 * size}, {segments, segments, segments}});
}

Pose tilted(double height) {
  Pose pose;
  pose.p_WB = {31.0, -12.0, height};
  pose.q_WB = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized();
  return pose;
}

constexpr std::int64_t kUtime = 12'345'678;

// The definitions of both methods, written for one point after the other, in double.
class Definition {
 public:
  Definition(const HydrostaticMesh& mesh, const SeaSnapshot& sea, const Pose& pose, const Vec3& reference_B)
      : mesh_(mesh), sea_(sea), pose_(pose), reference_B_(reference_B) {
    up_B_ = pose.q_WB.conjugate() * sea.sea().water().up_W;
  }

  WaveLoad fast_surface() {
    load_ = {};
    for (const Triangle& t : mesh_.surface.triangles) {
      const Vec3 a = mesh_.vertex(t[0]), b = mesh_.vertex(t[1]), c = mesh_.vertex(t[2]);
      add_point((a + b + c) / 3.0, 0.5 * (b - a).cross(c - a));
    }
    return load_;
  }

  WaveLoad exact_surface() {
    load_ = {};
    for (const Triangle& t : mesh_.surface.triangles) {
      // The polygon that is left of the triangle, clipped edge by edge.
      std::vector<Vec3> wet;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 from = mesh_.vertex(t[i]), to = mesh_.vertex(t[(i + 1) % 3]);
        const double s = water_at(from).height, next = water_at(to).height;
        if (s < 0.0) wet.push_back(from);
        if ((s < 0.0) != (next < 0.0)) wet.push_back(from + s / (s - next) * (to - from));
      }
      for (std::size_t i = 2; i < wet.size(); ++i) add_piece(wet[0], wet[i - 1], wet[i]);
    }
    return load_;
  }

 private:
  WaterAtPoint water_at(const Vec3& y) const {
    return sea_.at(pose_.p_WB + pose_.q_WB * Vec3(y + mesh_.center_B));
  }

  void add_piece(const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 third = (q - p).cross(r - p) / 6.0;
    add_point((4.0 * p + q + r) / 6.0, third);
    add_point((p + 4.0 * q + r) / 6.0, third);
    add_point((p + q + 4.0 * r) / 6.0, third);
  }

  void add_point(const Vec3& y, const Vec3& area) {
    const Water& water = sea_.sea().water();
    const WaterAtPoint here = water_at(y);
    if (here.height >= 0.0) return;
    const Vec3 force = -here.pressure / (water.density * water.gravity) * area;
    load_.force += force;
    load_.torque += (y + mesh_.center_B - reference_B_).cross(force);
    const double column = here.height * up_B_.dot(area);
    load_.volume += column;
    load_.moment += column * (y - 0.5 * here.height * up_B_);
  }

  const HydrostaticMesh& mesh_;
  const SeaSnapshot& sea_;
  const Pose& pose_;
  Vec3 reference_B_, up_B_;
  WaveLoad load_;
};

void expect_near(const WaveLoad& load, const WaveLoad& expected, double tolerance) {
  EXPECT_NEAR((load.force - expected.force).norm(), 0.0, tolerance);
  EXPECT_NEAR((load.torque - expected.torque).norm(), 0.0, tolerance);
  EXPECT_NEAR(load.volume, expected.volume, tolerance);
  EXPECT_NEAR((load.moment - expected.moment).norm(), 0.0, tolerance);
}

struct Setting {
  std::string name;
  WavePressure pressure;
  double depth;
};

class WaveSurfaceMethods : public ::testing::TestWithParam<Setting> {
 protected:
  SeaDescription sea(double height) const {
    return sea_of({wind_sea(height, 3.0)}, GetParam().pressure, GetParam().depth);
  }
};

TEST_P(WaveSurfaceMethods, MatchTheirDefinitionsOnAllTargets) {
  const HydrostaticMesh mesh = rock(1.0, 5);
  const TestSea at(sea(0.5), kUtime);
  const Vec3 reference_B(0.4, -0.2, 0.7);
  for (const double height : {-1.5, -0.2, 0.5}) {
    const Pose pose = tilted(height);
    Definition definition(mesh, at.snapshot, pose, reference_B);
    const WaveLoad fast = definition.fast_surface();
    const WaveLoad exact = definition.exact_surface();
    EXPECT_GT(fast.volume, 0.01);
    for (const std::string& target : simd_targets()) {
      SCOPED_TRACE(target);
      const ForcedTarget forced(target);
      expect_near(fast_surface_in_waves(mesh, at.snapshot, pose, reference_B), fast, 2e-7 * mesh.volume);
      expect_near(exact_surface_in_waves(mesh, at.snapshot, pose, reference_B), exact, 2e-7 * mesh.volume);
    }
  }
}

TEST_P(WaveSurfaceMethods, ExactSurfaceInDoubleHasNoSinglePrecisionError) {
  const HydrostaticMesh mesh = rock(1.0, 5);
  const TestSea at(sea(0.5), kUtime);
  // Nothing is cut: the test's own definition may halve a quadrangle along the other diagonal.
  const Pose deep = tilted(-1.6);
  const Vec3 reference_B(0.4, -0.2, 0.7);
  expect_near(exact_surface_in_double(mesh, at.snapshot, deep, reference_B),
              Definition(mesh, at.snapshot, deep, reference_B).exact_surface(), 1e-12);
}

TEST_P(WaveSurfaceMethods, SumInDoubleWhereWavesAreHighForTheBody) {
  const HydrostaticMesh mesh = rock(0.05, 5);
  const TestSea at(sea(0.5), kUtime);
  Pose pose = tilted(0.0);
  pose.p_WB.z() = at.snapshot.elevation(pose.p_WB.x(), pose.p_WB.y());
  const Vec3 reference_B(0.04, -0.02, 0.07);
  Definition definition(mesh, at.snapshot, pose, reference_B);
  const WaveLoad fast = definition.fast_surface();
  const WaveLoad exact = definition.exact_surface();
  EXPECT_GT(fast.volume, 0.1 * mesh.volume);
  // Quadrangles are halved along either diagonal. With sums in float32 the errors are 1e-6 and more.
  constexpr double kTolerance = 1e-9;
  for (const std::string& target : simd_targets()) {
    SCOPED_TRACE(target);
    const ForcedTarget forced(target);
    expect_near(fast_surface_in_waves(mesh, at.snapshot, pose, reference_B), fast, kTolerance * mesh.volume);
    expect_near(exact_surface_in_waves(mesh, at.snapshot, pose, reference_B), exact,
                kTolerance * mesh.volume);
  }
}

TEST_P(WaveSurfaceMethods, ConvergeToTheTruth) {
  const TestSea at(sea(0.5), kUtime);
  const Pose pose = tilted(-0.1);
  const Vec3 reference_B(0.4, -0.2, 0.7);
  const HydrostaticMesh coarse = box(1.5, 1);
  const ReferenceLoad truth = true_wave_load(coarse, at.sea, kUtime, pose, 1e-7, reference_B);
  ASSERT_TRUE(truth.resolved);
  struct Errors {
    double force, torque, volume;
  };
  const auto errors = [&truth](const WaveLoad& load) {
    return Errors{(load.force - truth.force).norm(), (load.torque - truth.torque).norm(),
                  std::abs(load.volume - truth.volume)};
  };
  const HydrostaticMesh few = box(1.5, 4);
  const HydrostaticMesh many = box(1.5, 16);
  // Four times as many segments: the errors fall with the second and with the fourth power.
  const Errors fast_few = errors(fast_surface_in_waves(few, at.snapshot, pose, reference_B));
  const Errors fast_many = errors(fast_surface_in_waves(many, at.snapshot, pose, reference_B));
  EXPECT_LT(fast_many.force, fast_few.force / 6.0);
  EXPECT_LT(fast_many.torque, fast_few.torque / 6.0);
  EXPECT_LT(fast_many.force, 2e-3 * coarse.volume);
  const Errors exact_few = errors(exact_surface_in_waves(few, at.snapshot, pose, reference_B));
  const Errors exact_many = errors(exact_surface_in_waves(many, at.snapshot, pose, reference_B));
  EXPECT_LT(exact_many.force, exact_few.force / 100.0 + 1e-7);
  EXPECT_LT(exact_many.torque, exact_few.torque / 100.0 + 1e-7);
  EXPECT_LT(exact_many.volume, 1e-6);
  EXPECT_LT(exact_many.force, 1e-6 * coarse.volume);
}

INSTANTIATE_TEST_SUITE_P(Seas, WaveSurfaceMethods,
                         ::testing::Values(Setting{"wheeler", WavePressure::kWheeler, kInfinity},
                                           Setting{"hydrostatic", WavePressure::kHydrostatic, kInfinity},
                                           Setting{"shallow", WavePressure::kWheeler, 3.0},
                                           // Only the longest waves reach the bed.
                                           Setting{"deeper", WavePressure::kWheeler, 12.0}),
                         [](const auto& setting) { return setting.param.name; });

TEST(WaveSurfaceMethods, InStillWaterMatchThePlanarMethods) {
  const HydrostaticMesh mesh = rock(1.0, 10);
  Water water;
  water.up_W = Vec3(0.2, -0.3, 0.9).normalized();
  water.level = 0.7;
  const TestSea at(sea_of({wind_sea(0.0, 3.0)}), 0, water);
  Pose pose = tilted(0.0);
  pose.p_WB -= (water.up_W.dot(pose.p_WB) - 0.5) * water.up_W;
  const Vec3 reference_B(0.4, -0.2, 0.7);
  const WaveLoad load = exact_surface_in_waves(mesh, at.snapshot, pose, reference_B);
  const Solver solver(mesh, Method::kExactSurface);
  const BuoyancyResult plane = buoyancy(solver, pose, water, reference_B);
  const double weight = water.density * water.gravity;
  EXPECT_NEAR((pose.q_WB * load.force - plane.force_W / weight).norm(), 0.0, 1e-13);
  EXPECT_NEAR((pose.q_WB * load.torque - plane.torque_W / weight).norm(), 0.0, 1e-13);
  EXPECT_NEAR(load.volume, plane.volume, 1e-13);
  const Displacement displacement = solver.displacement(water_plane_in_body(pose, water, mesh.center_B));
  EXPECT_NEAR((load.moment - displacement.moment).norm(), 0.0, 1e-13);
}

TEST(WaveSurfaceMethods, OfADeepBodyAreTheWeightOfItsWater) {
  const HydrostaticMesh mesh = box(1.0, 8);
  const TestSea at(sea_of({wind_sea(0.5, 3.0)}), kUtime);
  const Pose pose = tilted(-500.0);
  for (const auto method : {fast_surface_in_waves, exact_surface_in_waves}) {
    const WaveLoad load = method(mesh, at.snapshot, pose, Vec3::Zero());
    EXPECT_NEAR((load.force - mesh.volume * (pose.q_WB.conjugate() * Vec3::UnitZ())).norm(), 0.0, 1e-9);
    EXPECT_NEAR(load.volume, mesh.volume, 1e-3 * mesh.volume);
  }
}

TEST(WaveSurfaceMethods, OfADryBodyAreZeroAndSayHowExact) {
  const HydrostaticMesh mesh = rock(1.0, 5);
  const TestSea at(sea_of({wind_sea(0.5, 3.0)}), kUtime);
  const double crest = at.sea.max_elevation();
  for (const auto method : {fast_surface_in_waves, exact_surface_in_waves}) {
    const WaveLoad dry = method(mesh, at.snapshot, tilted(crest + 3.0), Vec3::Zero());
    EXPECT_EQ(dry.force, Vec3::Zero());
    EXPECT_EQ(dry.volume, 0.0);
    EXPECT_EQ(dry.force_bound, 0.0);
    EXPECT_EQ(dry.torque_bound, 0.0);
    // It could be wet, and is not.
    const WaveLoad above = method(mesh, at.snapshot, tilted(crest - 0.5), Vec3::Zero());
    EXPECT_EQ(above.force, Vec3::Zero());
    EXPECT_EQ(above.force_bound, kInfinity);
    EXPECT_EQ(above.torque_bound, kInfinity);
  }
}

TEST(WaveSurfaceMethods, AllocateNothingAfterTheFirstQuery) {
  const HydrostaticMesh large = rock(1.0, 20);
  const HydrostaticMesh small = rock(0.02, 10);  // summed in double
  TestSea at(sea_of({wind_sea(0.5, 3.0)}), kUtime);
  for (const auto method : {fast_surface_in_waves, exact_surface_in_waves}) {
    method(large, at.snapshot, tilted(-0.1), Vec3::Zero());
    method(small, at.snapshot, tilted(-0.1), Vec3::Zero());
    const AllocationCount allocations;
    at.snapshot.set_time(1'000'000);
    const WaveLoad load = method(large, at.snapshot, tilted(-0.2), Vec3::Zero());
    method(small, at.snapshot, tilted(-0.1), Vec3::Zero());
    EXPECT_GT(load.volume, 0.0);
    EXPECT_EQ(allocations.count(), 0);
  }
}

}  // namespace
}  // namespace buoyancy
