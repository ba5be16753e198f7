// `hierarchical` with a tolerance: the published bound holds and is no larger than requested.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/hierarchical.h"
#include "hydrostatics/pruned_node.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

const Water kUnitWater{.up_W = Vec3::UnitZ(), .level = 0.25, .density = 1.0, .gravity = 1.0};

// The largest ratios over a set of poses: bound over requested tolerance, and true errors over bound.
struct Worst {
  double bound = 0.0, force = 0.0, torque = 0.0;
};

Worst over_random_poses(const TriangleMesh& source, const HydrostaticMesh& mesh, double tolerance, int poses,
                        std::uint64_t seed) {
  const Solver within(mesh, Method::kHierarchical, tolerance);
  const Solver exactly(mesh, Method::kHierarchical);
  const BoundingBox box = bounding_box(source);
  const double rounding = mesh.volume_tolerance();
  RandomPoses random(seed);
  Worst worst;
  for (int i = 0; i < poses; ++i) {
    Water water = kUnitWater;
    if (i % 4 == 3) water.up_W = random.direction();
    const Pose pose = i % 5 == 4 ? random.adversarial(source, water) : random.crossing(box, water);
    const Vec3 reference_B = box.center() + 0.5 * mesh.diagonal * random.vector(0, 1);
    const BuoyancyResult result = buoyancy(within, pose, water, reference_B);
    const BuoyancyResult truth = buoyancy(exactly, pose, water, reference_B);
    if (result.immersion == Immersion::kDry) continue;
    const double min_bound = mesh.meets_volume_tolerance() ? 4.0 * rounding : mesh.max_rounding_bound();
    const double allowed = std::max(tolerance * mesh.volume, min_bound);
    worst.bound = std::max(worst.bound, result.force_error_bound / allowed);
    worst.bound =
        std::max(worst.bound, result.torque_error_bound / (allowed * mesh.max_lever_arm(reference_B)));
    // The truth has an error of its own, at most G_V.
    worst.force = std::max(worst.force,
                           (result.force_W - truth.force_W).norm() / (result.force_error_bound + rounding));
    worst.force =
        std::max(worst.force, std::abs(result.volume - truth.volume) / (result.force_error_bound + rounding));
    worst.torque =
        std::max(worst.torque, (result.torque_W - truth.torque_W).norm() /
                                   (result.torque_error_bound + rounding * mesh.max_lever_arm(reference_B)));
  }
  return worst;
}

TEST(Tolerance, HoldsOnEveryInstructionSet) {
  // Smaller tolerances prune no nodes.
  const std::map<int, std::vector<double>> tolerances_by_frequency{{16, {1e-2, 5e-2}}, {70, {1e-3, 1e-2}}};
  for (const auto& [frequency, tolerances] : tolerances_by_frequency) {
    const TriangleMesh rock = make_shape(RockShape{.frequency = frequency});
    const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
    for (const std::string& target : simd_targets()) {
      ASSERT_TRUE(force_simd_target(target));
      for (const double tolerance : tolerances) {
        const Worst worst = over_random_poses(rock, mesh, tolerance, 400, 42);
        EXPECT_LE(worst.bound, 1.0) << target << ", " << tolerance;
        EXPECT_LE(worst.force, 1.0) << target << ", " << tolerance;
        EXPECT_LE(worst.torque, 1.0) << target << ", " << tolerance;
        EXPECT_GT(worst.force, 1e-3) << "no node was pruned: the test is void";
      }
    }
    force_simd_target("");
  }
}

TEST(Tolerance, UsesRoughPlaneOnlyWithinTolerance) {
  const HydrostaticMesh mesh = make_hydrostatic_mesh({make_shape(RockShape{.frequency = 16}), {}});
  const Solver exactly(mesh, Method::kHierarchical);
  const Solver within(mesh, Method::kHierarchical, 1e-6);
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(0.9, 0.1, 0.3, -0.2).normalized();
  const auto plane_error = [&](const Solver& solver, double distance) {
    return solver.plane_in_body({Vec3(distance, -distance, 0.3), rotation}, kUnitWater).error;
  };
  EXPECT_EQ(plane_error(exactly, 0.0), 0.0);
  EXPECT_GT(plane_error(within, 0.0), 0.0);
  EXPECT_LT(plane_error(within, 1e5), 1e-8 * mesh.diagonal);
  EXPECT_EQ(plane_error(within, 1e9), 0.0) << "exact where plain double exceeds the allowed error";

  // The published bound covers the plane's error in all cases.
  RandomPoses random(43);
  for (int i = 0; i < 400; ++i) {
    Water water = kUnitWater;
    water.up_W = random.direction();
    const Vec3 aside = random.far_vector(0, 10);
    Pose pose{aside - (water.up_W.dot(aside) - random.uniform(-1, 1)) * water.up_W, random.rotation()};
    const BuoyancyResult result = buoyancy(within, pose, water, mesh.center_B);
    const BuoyancyResult truth = buoyancy(exactly, pose, water, mesh.center_B);
    const double rounding = mesh.volume_tolerance();
    EXPECT_LE((result.force_W - truth.force_W).norm(), result.force_error_bound + rounding);
    EXPECT_LE((result.torque_W - truth.torque_W).norm(),
              result.torque_error_bound + rounding * mesh.max_lever_arm(mesh.center_B));
    EXPECT_LE(result.force_error_bound, 1e-6 * mesh.volume);
  }
}

// Nested tetrahedra: the water crosses nearly all nodes, many of which are inner nodes.
TriangleMesh nested_tetrahedra(int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const double size = 1.0 + 1.0 / count * i;
    mesh = joined(std::move(mesh),
                  moved_mesh(tetrahedron_mesh(), size * Mat3::Identity(), Vec3::Constant(-0.25 * size)));
  }
  return mesh;
}

TEST(Tolerance, ReservesRoomForLargerTree) {
  const HydrostaticMesh small = make_hydrostatic_mesh({make_shape(RockShape{.frequency = 8}), {}});
  const HydrostaticMesh large = make_hydrostatic_mesh({nested_tetrahedra(2030), {}});
  BudgetLists lists;
  for (const HydrostaticMesh* const mesh : {&small, &large, &small}) {
    lists.reserve(*mesh->tree);
    EXPECT_GE(lists.inner.size(), mesh->tree->nodes.size());
    EXPECT_GE(lists.next_inner.size(), mesh->tree->nodes.size());
    EXPECT_GE(lists.open.child.size(), mesh->tree->areas.size());
  }

  const Pose pose{Vec3(0, 0, 0.3), Eigen::Quaterniond::Identity()};
  for (const HydrostaticMesh* const mesh : {&small, &large}) {
    const Solver within(*mesh, Method::kHierarchical, 0.1);
    const Solver exactly(*mesh, Method::kHierarchical);
    const BuoyancyResult result = buoyancy(within, pose, kUnitWater, Vec3::Zero());
    const BuoyancyResult truth = buoyancy(exactly, pose, kUnitWater, Vec3::Zero());
    EXPECT_LE((result.force_W - truth.force_W).norm(), result.force_error_bound);
  }
}

TEST(Tolerance, HasNoEffectBelowRoundingBound) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 16});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  const Pose pose{Vec3(0, 0, 0.3), Eigen::Quaterniond(0.9, 0.1, 0.3, -0.2).normalized()};
  const WaterPlane plane = water_plane_in_body(pose, kUnitWater, mesh.center_B);
  const Displacement exactly = hierarchical(mesh, plane);
  const Displacement barely = hierarchical(mesh, plane, 1e-16);
  EXPECT_EQ(exactly.truncation_bound, 0.0);
  EXPECT_EQ(barely.truncation_bound, 0.0);
  EXPECT_EQ(barely.volume, exactly.volume);
  EXPECT_EQ(barely.moment, exactly.moment);
  EXPECT_EQ(barely.torque, exactly.torque);
}

TEST(Tolerance, VisitsFewerNodesWhenLarger) {
  const HydrostaticMesh mesh = make_hydrostatic_mesh({make_shape(RockShape{.frequency = 122}), {}});
  TreeQuery query{};
  query.k = query.k_high = {0, 0, 1};
  query.axes = {2, 0, 1};
  query.half_diagonal = 0.5 * mesh.diagonal;
  std::int64_t visited = sum_wetted_tree(*mesh.tree, query).nodes_visited;
  for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
    query.budget = tolerance * mesh.volume;
    const WettedTreeSum sum = sum_wetted_tree(*mesh.tree, query);
    EXPECT_LT(sum.nodes_visited, visited);
    EXPECT_LE(sum.pruned.error, query.budget);
    EXPECT_GT(sum.nodes_pruned, 0);
    visited = sum.nodes_visited;
  }
  EXPECT_LT(visited, 100) << "at 1e-2 the result hardly depends on the mesh";
}

TEST(Tolerance, BoundsErrorOfCentreOfBuoyancy) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 39});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  RandomPoses random(43);
  for (int i = 0; i < 200; ++i) {
    const Pose pose = random.crossing(bounding_box(rock), kUnitWater);
    const WaterPlane plane = water_plane_in_body(pose, kUnitWater, mesh.center_B);
    const Displacement truth = hierarchical(mesh, plane);
    const Displacement within = hierarchical(mesh, plane, 1e-3);
    EXPECT_LE((within.moment - truth.moment).norm(), 2e-3 * mesh.volume * mesh.diagonal);
  }
}

}  // namespace
}  // namespace buoyancy
