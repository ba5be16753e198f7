// `hierarchical` against `exact`, brute force and rational arithmetic, on every instruction set of this
// processor.
#include "hydrostatics/hierarchical.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "hydrostatics/exact.h"
#include "hydrostatics/wet_tree_sum.h"
#include "tests/hydrostatics/exact_oracle.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/rational.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Forces a target for one scope.
class ForcedTarget {
 public:
  explicit ForcedTarget(const std::string& name) { EXPECT_TRUE(force_simd_target(name)) << name; }
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;
  ~ForcedTarget() { force_simd_target(""); }
};

TEST(SimdTargets, AreForcedByNameAndIncludeTheScalarTwin) {
  const std::vector<std::string> targets = simd_targets();
  EXPECT_NE(std::find(targets.begin(), targets.end(), "SCALAR"), targets.end());
  EXPECT_EQ(simd_target(), targets.front()) << "the best one is used unless another is forced";
  for (const std::string& target : targets) {
    const ForcedTarget forced(target);
    EXPECT_EQ(simd_target(), target);
  }
  EXPECT_FALSE(force_simd_target("AVX1024"));
  EXPECT_EQ(simd_target(), targets.front());
}

TEST(Hierarchical, EqualsBruteForceOnEveryMeshPoseAndInstructionSet) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    const BoundingBox box = bounding_box(named.mesh);
    const double gate = mesh.volume_gate();
    const double lever = mesh.largest_lever(mesh.center_B);
    for (const std::string& target : simd_targets()) {
      const ForcedTarget forced(target);
      RandomPoses random(21);
      double volume = 0.0;
      double torque = 0.0;
      double moment = 0.0;
      for (int i = 0; i < 400; ++i) {
        Water water{.level = 0.25, .density = 1.0, .gravity = 1.0};
        if (i % 4 == 3) water.up_W = random.direction();
        const Pose pose = i % 2 == 0 ? random.crossing(box, water) : random.adversarial(named.mesh, water);
        const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
        const Displacement brute = exact(mesh, plane);
        const Displacement fast = hierarchical(mesh, plane);
        volume = std::max(volume, std::abs(fast.volume - brute.volume));
        torque = std::max(torque, (fast.torque - brute.torque).norm());
        moment = std::max(moment, (fast.moment - brute.moment).norm());
      }
      EXPECT_LE(volume, 2 * gate) << named.name << ", " << target;
      EXPECT_LE(torque, 2 * gate * lever) << named.name << ", " << target;
      EXPECT_LE(moment, 4 * gate * lever) << named.name << ", " << target;
    }
  }
}

TEST(Hierarchical, KeepsNineDigitsOfACapOfAMillionthOfTheVolumeAtAnyTilt) {
  const TriangleMesh sphere = make_shape(RockShape{.frequency = 8, .roughness = 0.0});
  ASSERT_EQ(sphere.triangles.size(), 1280U);
  const HydrostaticMesh mesh = make_hydrostatic_mesh({sphere, {}});
  for (const std::string& target : simd_targets()) {
    const ForcedTarget forced(target);
    RandomPoses random(22);
    for (int i = 0; i < 60; ++i) {
      Pose pose{Vec3::Zero(), random.rotation()};
      // Lower the body by bisection until a millionth of it is wet.
      double dry = 1.01;
      double wet = 0.9;
      for (int step = 0; step < 60; ++step) {
        pose.p_WB.z() = 0.5 * (dry + wet);
        const double volume = hierarchical(mesh, water_plane_in_body(pose, {}, mesh.center_B)).volume;
        (volume < 1e-6 * mesh.volume ? dry : wet) = pose.p_WB.z();
      }
      const double volume = hierarchical(mesh, water_plane_in_body(pose, {}, mesh.center_B)).volume;
      const double truth = exact_displacement<Rational>(sphere, pose, {}).volume.convert_to<double>();
      EXPECT_NEAR(truth, 1e-6 * mesh.volume, 1e-9 * mesh.volume);
      EXPECT_LE(std::abs(volume - truth), 1e-11 * truth) << target;
    }
  }
}

TEST(Hierarchical, StaysWithinFourEpsilonOfTheWaterplaneWhenItGrazes) {
  const TriangleMesh sphere = make_shape(RockShape{.frequency = 8, .roughness = 0.0});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({sphere, {}});
  RandomPoses random(23);
  for (int i = 0; i < 100; ++i) {
    Pose pose{Vec3::Zero(), random.rotation()};
    double lowest = 0.0;
    for (std::size_t v = 0; v < sphere.vertex_count(); ++v) {
      lowest = std::min(lowest, (pose.q_WB * sphere.vertex(static_cast<std::int32_t>(v))).z());
    }
    const double draft = std::pow(10.0, random.uniform(-12, -4));
    pose.p_WB.z() = -lowest - draft;
    const auto oracle = exact_displacement<Rational>(sphere, pose, {});
    const double truth = oracle.volume.convert_to<double>();
    const double waterplane = 3.0 * truth / draft;  // a cone's; more than any wet cap of the same draft has
    const double volume = hierarchical(mesh, water_plane_in_body(pose, {}, mesh.center_B)).volume;
    EXPECT_LE(std::abs(volume - truth), 4 * kEpsilon * mesh.diagonal * waterplane) << draft;
  }
}

TEST(Hierarchical, AnswersWhollyWetBodiesWithTheSameBitsAtEveryDepth) {
  const HydrostaticMesh mesh = make_hydrostatic_mesh({make_shape(RockShape{.frequency = 8}), {}});
  RandomPoses random(24);
  const Eigen::Quaterniond rotation = random.rotation();
  const Displacement shallow =
      hierarchical(mesh, water_plane_in_body({Vec3(0, 0, -3), rotation}, {}, mesh.center_B));
  for (const double depth : {10.0, 1e4, 1e9}) {
    const Displacement deep =
        hierarchical(mesh, water_plane_in_body({Vec3(7, 0, -depth), rotation}, {}, mesh.center_B));
    EXPECT_EQ(deep.volume, shallow.volume);
    EXPECT_EQ(deep.torque, shallow.torque);
    EXPECT_EQ(deep.moment, shallow.moment);
  }
}

TEST(Hierarchical, VisitsAWaterlineAndNotTheMesh) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 122});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  TreeQuery query{};
  query.k = query.k_high = {0, 0, 1};
  query.u = {1, 0, 0};
  query.v = {0, 1, 0};
  const WetTreeSum sum = sum_wet_tree(*mesh.tree, query);
  EXPECT_GT(sum.leaves_clipped, 100);
  EXPECT_LT(sum.leaves_clipped, 900) << "of " << mesh.tree->leaves.size();
  EXPECT_LT(sum.nodes_visited, 900) << "of " << mesh.tree->nodes.size();
}

}  // namespace
}  // namespace buoyancy
