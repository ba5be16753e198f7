// Tests the meshes and poses of the benchmarks.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bench/benchmark_meshes.h"
#include "bench/pose_sweep.h"
#include "bench/trajectory_poses.h"
#include "bench/unit_water.h"
#include "geometry/mesh_validation.h"
#include "hydrostatics/buoyancy.h"

namespace buoyancy::bench {
namespace {

Vec3 centroid_W(const HydrostaticMesh& mesh, const Pose& pose) {
  return pose.p_WB + pose.q_WB * (mesh.center_B + mesh.centroid);
}

TEST(ShuffledMesh, PermutesTrianglesReproducibly) {
  const BenchmarkMesh model = rock(8);
  const BenchmarkMesh first = shuffled(model);
  EXPECT_EQ(first.name, "rock shuffled");
  EXPECT_EQ(first.source.triangles, shuffled(model).source.triangles);
  std::vector<Triangle> triangles = model.source.triangles;
  std::vector<Triangle> permuted = first.source.triangles;
  std::size_t fixed_points = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) fixed_points += triangles[i] == permuted[i] ? 1 : 0;
  EXPECT_LT(fixed_points, 10U);  // a random permutation has about one
  std::sort(triangles.begin(), triangles.end());
  std::sort(permuted.begin(), permuted.end());
  EXPECT_EQ(triangles, permuted);
}

TEST(RockUv, IsClosedRockWithSliversAtPoles) {
  const BenchmarkMesh model = rock_uv(60, 41);
  EXPECT_EQ(model.name, "rock uv");
  EXPECT_EQ(model.source.triangles.size(), 4800U);
  EXPECT_TRUE(validate_mesh({model.source, {}}, "rock uv").mesh);
  EXPECT_NEAR(model.mesh.volume, rock(16).mesh.volume, 0.01 * model.mesh.volume);
  double max_ratio = 0.0;
  for (const Triangle& triangle : model.mesh.surface.triangles) {
    // The first corner lies opposite the longest edge.
    const Vec3 a = model.mesh.vertex(triangle[0]);
    const Vec3 b = model.mesh.vertex(triangle[1]);
    const Vec3 c = model.mesh.vertex(triangle[2]);
    max_ratio = std::max(max_ratio, (c - b).squaredNorm() / (b - a).cross(c - a).norm());
  }
  EXPECT_GT(max_ratio, 8.0);
}

TEST(BenchmarkMesh, SubstitutesNamedRockForMissingModel) {
  const BenchmarkMesh substitute = model_or_rock("bunny", "no such file.ply", 5);
  EXPECT_EQ(substitute.name, "rock for bunny");
  EXPECT_EQ(substitute.source.triangles.size(), 500U);
}

TEST(PoseSweep, RunsFromAlmostDryToAlmostSubmerged) {
  const BenchmarkMesh model = rock(16);
  const Solver solver(model.mesh, Method::kExact);
  const auto wet_share = [&](const Pose& pose) {
    return buoyancy(solver, pose, kUnitWater, Vec3::Zero()).volume / model.mesh.volume;
  };
  const std::vector<Pose> poses = sweep_of_poses(model.source);
  ASSERT_EQ(poses.size(), 100U);
  EXPECT_GT(wet_share(poses.front()), 0.0);
  EXPECT_LT(wet_share(poses.front()), 1e-3);
  EXPECT_GT(wet_share(poses.back()), 1.0 - 1e-3);
  EXPECT_LT(wet_share(poses.back()), 1.0);
}

TEST(TrajectoryPoses, StartsInEquilibrium) {
  for (const BenchmarkMesh& model : {rock(16), torus_knot()}) {
    const Solver solver(model.mesh, Method::kExact);
    const Vec3 centroid_B = model.mesh.center_B + model.mesh.centroid;
    const BuoyancyResult result = buoyancy(solver, floating_pose(solver), kUnitWater, centroid_B);
    EXPECT_NEAR(result.force_W.z() / model.mesh.volume, 0.5, 1e-9) << model.name;
    EXPECT_LE(result.torque_W.norm(), 1e-8 * model.mesh.volume * model.mesh.diagonal) << model.name;
  }
}

TEST(TrajectoryPoses, ClosesOrbitWithStepsOfOneThousandth) {
  const BenchmarkMesh model = torus_knot();
  const Pose floating = floating_pose(Solver(model.mesh, Method::kExact));
  const std::vector<Pose> poses = coherent_poses(model.mesh, floating);
  ASSERT_EQ(poses.size(), 100U);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& here = poses[i];
    const Pose& next = poses[(i + 1) % poses.size()];
    const double moved = (centroid_W(model.mesh, next) - centroid_W(model.mesh, here)).norm();
    EXPECT_NEAR(moved / model.mesh.diagonal, kCoherentStep, 1e-9);
    EXPECT_NEAR(here.q_WB.angularDistance(next.q_WB), kCoherentStep, 1e-2 * kCoherentStep);
  }
}

}  // namespace
}  // namespace buoyancy::bench
