// Tests the check of the results before the timing, and the computations of the report.
#include <cmath>

#include <gtest/gtest.h>

#include "bench/median.h"
#include "bench/memory_read_baseline.h"
#include "bench/pose_sweep.h"
#include "bench/report.h"
#include "tests/support/contains.h"

namespace buoyancy::bench {
namespace {

constexpr std::size_t kPoses = 12;

PoseSet sweep_with_reference(const BenchmarkMesh& model) {
  return with_reference_results("independent", sweep_of_poses(model.source, kPoses), model.source);
}

TEST(MeasureErrors, StaysWithinPublishedBounds) {
  const BenchmarkMesh model = rock(8);
  const PoseSet set = sweep_with_reference(model);
  for (const Method method : kAllMethods) {
    const auto errors = measure_errors(model, Solver(model.mesh, method), set);
    ASSERT_TRUE(errors) << errors.error().message();
    if (is_exact(method)) {
      EXPECT_LE(errors->force, errors->bound) << to_string(method);
      EXPECT_LT(errors->bound, 1e-12) << to_string(method);
    } else {
      EXPECT_GT(errors->force, 1e-6) << to_string(method);
      EXPECT_LE(errors->force, errors->bound) << to_string(method);
    }
  }
}

TEST(MeasureErrors, NamesMeshMethodAndPoseOfViolatedBound) {
  const BenchmarkMesh model = rock(8);
  PoseSet set = sweep_with_reference(model);
  set.truth[7].force_W.z() += 2e-13 * model.mesh.volume;
  const auto force = measure_errors(model, Solver(model.mesh, Method::kExact), set);
  ASSERT_FALSE(force);
  EXPECT_TRUE(contains(force.error().message(), "rock of 1280 triangles, exact, independent pose 7"));
  EXPECT_TRUE(contains(force.error().actual, "force is off by"));

  set = sweep_with_reference(model);
  set.truth[3].torque_W.x() += 2e-13 * model.mesh.volume * model.mesh.diagonal;
  const auto torque = measure_errors(model, Solver(model.mesh, Method::kHierarchical), set);
  ASSERT_FALSE(torque);
  EXPECT_TRUE(contains(torque.error().message(), "hierarchical at tolerance 0 on "));
  EXPECT_TRUE(contains(torque.error().actual, "torque is off by"));
}

TEST(MemoryReadBaseline, ReadsEveryCoordinateAndIndex) {
  TriangleMesh mesh;
  for (int i = 0; i < 16; ++i) mesh.add_vertex({0, 0, 0});
  mesh.triangles.assign(32, {0, 0, 0});
  EXPECT_EQ(read_vertices_and_indices(mesh), 0U);
  for (std::vector<double>* coordinate : {&mesh.x, &mesh.y, &mesh.z}) {
    for (double& value : *coordinate) {
      value = 1.0;
      EXPECT_NE(read_vertices_and_indices(mesh), 0U);
      value = 0.0;
    }
  }
  for (Triangle& triangle : mesh.triangles) {
    for (std::int32_t& index : triangle) {
      index = 1;
      EXPECT_NE(read_vertices_and_indices(mesh), 0U);
      index = 0;
    }
  }
}

TEST(Median, AveragesTwoMiddleValuesOfEvenCount) {
  EXPECT_EQ(median({3.0}), 3.0);
  EXPECT_EQ(median({9.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({9.0, 1.0, 2.0, 4.0}), 3.0);
}

TEST(FittedExponent, RecoversPowerLaw) {
  std::vector<Measurement> measurements(3);
  std::vector<const Measurement*> pointers;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    measurements[i].triangles = 1000 << (3 * i);
    measurements[i].median_ns = 7.0 * std::pow(static_cast<double>(measurements[i].triangles), 0.6);
    pointers.push_back(&measurements[i]);
  }
  EXPECT_NEAR(fitted_exponent(pointers), 0.6, 1e-12);
}

}  // namespace
}  // namespace buoyancy::bench
