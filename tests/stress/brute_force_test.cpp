// The stress catalogue, "Invariants": the descent of the tree against the sum over all triangles.
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"

namespace buoyancy {
namespace {

// A tetrahedron whose faces are replaced by pyramids, in turn, until it has `faces` faces; if that number is
// odd, the last face has zero area.
TriangleMesh pyramids(int faces) {
  TriangleMesh mesh;
  for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1)}) {
    mesh.add_vertex(corner);
  }
  mesh.triangles = {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}};
  for (std::size_t next = 0; static_cast<int>(mesh.triangles.size()) + 1 < faces; ++next) {
    const auto [a, b, c] = mesh.triangles[next];
    const Vec3 middle = (mesh.vertex(a) + mesh.vertex(b) + mesh.vertex(c)) / 3.0;
    const std::int32_t top = mesh.add_vertex(1.25 * middle);
    mesh.triangles[next] = {a, b, top};
    mesh.triangles.push_back({b, c, top});
    mesh.triangles.push_back({c, a, top});
  }
  if (faces % 2 == 1) mesh.triangles.push_back({0, 1, 1});
  return mesh;
}

// Meshes whose trees have leaves of every size: up to 24 faces form one leaf, 25 to 27 two. No leaf is
// smaller, since a closed mesh has at least four faces and larger ones are cut into equal leaves.
std::vector<StressedBody> bodies_of_every_leaf_size() {
  std::vector<StressedBody> bodies = stressed_bodies();
  for (int faces = 4; faces <= kLeafTriangles + 3; ++faces) {
    bodies.emplace_back("pyramids of " + std::to_string(faces) + " faces", pyramids(faces));
  }
  return bodies;
}

TEST(StressInvariants, HierarchicalMatchesBruteForce) {
  StressCase stress("hierarchical = brute force, every instruction set, every leaf size",
                    "every triangle, no tree", "bound of each");
  std::set<int> leaf_sizes;
  for (const StressedBody& body : bodies_of_every_leaf_size()) {
    for (const auto& leaf : body.mesh.tree->leaves) leaf_sizes.insert(leaf.triangles);
    for (const auto& leaf : body.mesh.tree->double_leaves) leaf_sizes.insert(leaf.triangles);
    const Solver brute(body.mesh, Method::kExact);
    const double weight = kStressWater.density * kStressWater.gravity;
    RandomPoses random(110);
    for (int i = 0; i < tries(500); ++i) {
      Water water = kStressWater;
      const Pose pose = stressed_pose(random, body, i, water);
      const Vec3 reference_B = reference_near(random, body);
      const BuoyancyResult one = buoyancy(brute, pose, water, reference_B);
      if (one.immersion == Immersion::kSubmerged) continue;  // evaluated without the tree
      for (const std::string& target : simd_targets()) {
        ASSERT_TRUE(force_simd_target(target));
        for (const double tolerance : {0.0, 1e-9, 1e-3}) {
          const Solver solver(body.mesh, Method::kHierarchical, tolerance);
          const BuoyancyResult other = buoyancy(solver, pose, water, reference_B);
          const std::string where = body.name + ", " + target + ", tolerance " + format_shortest(tolerance);
          const double force_bound = one.force_error_bound + other.force_error_bound;
          const double torque_bound = one.torque_error_bound + other.torque_error_bound;
          stress.check(weight * std::abs(other.volume - one.volume), force_bound, "volume, " + where);
          stress.check((other.torque_W - one.torque_W).norm(), torque_bound, "torque, " + where);
        }
      }
    }
  }
  force_simd_target("");
  for (int size = 4; size <= kLeafTriangles; ++size) {
    stress.require(leaf_sizes.contains(size), "leaves of " + std::to_string(size));
  }
}

}  // namespace
}  // namespace buoyancy
