// `hierarchical` against `exact`, brute force and rational arithmetic, on every instruction set of this
// processor.
#include "hydrostatics/hierarchical.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/paper_methods.h"
#include "hydrostatics/solver.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/agreement.h"
#include "tests/hydrostatics/forced_target.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

TEST(SimdTargets, CanBeForcedByName) {
  const std::vector<std::string> targets = simd_targets();
  ASSERT_FALSE(targets.empty());
  EXPECT_EQ(simd_target(), targets.front()) << "the best one is used unless another is forced";
  for (const std::string& target : targets) {
    const ForcedTarget forced(target);
    EXPECT_EQ(simd_target(), target);
  }
  EXPECT_FALSE(force_simd_target("AVX1024"));
  EXPECT_EQ(simd_target(), targets.front());
}

TEST(Hierarchical, MatchesExactOnEveryInstructionSet) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    for (const Agreement& found : agreement_with_exact(named.mesh, mesh, kAgreementPoses, 21)) {
      EXPECT_LE(found.volume, 2.0) << named.name << ", " << found.target;
      EXPECT_LE(found.torque, 2.0) << named.name << ", " << found.target;
      EXPECT_LE(found.moment, 4.0) << named.name << ", " << found.target;
    }
  }
}

TEST(Hierarchical, MatchesExactOnScaledMeshes) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 8});
  for (const double distance : {0.0, 0.7, 300.0}) {
    const TriangleMesh file = rounded_to_float32(moved_and_scaled(rock, distance * Vec3(1, -0.5, 0.25)));
    for (const double scale : {1e-3, 0.0254, 1.0 / 3.0, 1000.0}) {
      const TriangleMesh source = moved_and_scaled(file, Vec3::Zero(), scale);
      const HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}}, WithTree::kYes, scale);
      EXPECT_EQ(mesh.tree->scale, scale);
      EXPECT_TRUE(mesh.tree->double_leaves.empty()) << "the file's coordinates are float32 numbers";
      for (const Agreement& found : agreement_with_exact(source, mesh, 60, 27)) {
        EXPECT_LE(found.volume, 2.0) << distance << ", " << scale << ", " << found.target;
        EXPECT_LE(found.torque, 2.0) << distance << ", " << scale << ", " << found.target;
        EXPECT_LE(found.moment, 4.0) << distance << ", " << scale << ", " << found.target;
      }
    }
  }
}

TEST(Hierarchical, KeepsDoubleTreeWhereScaleIsNotTheFiles) {
  const TriangleMesh source = moved_and_scaled(make_shape(RockShape{.frequency = 8}), Vec3::Zero(), 0.1);
  const HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}}, WithTree::kYes, 0.3);
  EXPECT_EQ(mesh.tree->scale, 1.0);
  EXPECT_TRUE(mesh.tree->leaves.empty());
}

TEST(Hierarchical, KeepsDigitsOfMillionthVolumeCap) {
  const TriangleMesh sphere = make_shape(RockShape{.frequency = 8, .roughness = 0.0});
  ASSERT_EQ(sphere.triangles.size(), 1280U);
  const HydrostaticMesh mesh = make_hydrostatic_mesh({sphere, {}});
  for (const std::string& target : simd_targets()) {
    const ForcedTarget forced(target);
    RandomPoses random(22);
    for (int i = 0; i < 60; ++i) {
      Pose pose{Vec3::Zero(), random.rotation()};
      // Bisection lowers the body until a millionth of its volume is submerged.
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

TEST(Hierarchical, BoundsGrazingErrorByWaterplaneArea) {
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
    const double waterplane = 3.0 * truth / draft;  // that of a cone, larger than any wet cap's of this draft
    const double volume = hierarchical(mesh, water_plane_in_body(pose, {}, mesh.center_B)).volume;
    EXPECT_LE(std::abs(volume - truth), 4 * kEpsilon * mesh.diagonal * waterplane) << draft;
  }
}

TEST(Hierarchical, IsBitIdenticalAtEveryDepthWhenSubmerged) {
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

TEST(Hierarchical, VisitsOnlyNodesNearWaterline) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 122});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  TreeQuery query{};
  query.k = query.k_high = {0, 0, 1};
  query.axes = {2, 0, 1};
  const WettedTreeSum sum = sum_wetted_tree(*mesh.tree, query);
  EXPECT_GT(sum.leaves_clipped, 100);
  EXPECT_LT(sum.leaves_clipped, 900) << "of " << mesh.tree->num_leaves();
  EXPECT_LT(sum.nodes_visited, 900) << "of " << mesh.tree->nodes.size();
}

TEST(Hierarchical, GivesSameResultsOnEightThreads) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 16});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  std::vector<Pose> poses;
  poses.reserve(200);
  RandomPoses random(26);
  for (int i = 0; i < 200; ++i) poses.push_back(random.crossing(bounding_box(rock), {}));
  for (const Method method : kAllMethods) {
    for (const double tolerance : {0.0, 1e-3}) {
      const Solver solver(mesh, method, tolerance);
      std::vector<Displacement> alone;
      alone.reserve(poses.size());
      for (const Pose& pose : poses) {
        alone.push_back(solver.displacement(water_plane_in_body(pose, {}, mesh.center_B)));
      }
      std::array<int, 8> different{};
      std::vector<std::thread> threads;
      threads.reserve(different.size());
      for (int& count : different) {
        threads.emplace_back([&] {
          for (std::size_t i = 0; i < poses.size(); ++i) {
            const Displacement found = solver.displacement(water_plane_in_body(poses[i], {}, mesh.center_B));
            count += static_cast<int>(found.volume != alone[i].volume || found.torque != alone[i].torque);
          }
        });
      }
      for (std::thread& thread : threads) thread.join();
      EXPECT_EQ(different, (std::array<int, 8>{})) << to_string(method) << ", tolerance " << tolerance;
    }
  }
}

// FNV-1a hash of the bits of results.
class BitHash {
 public:
  void add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte) hash_ = (hash_ ^ (bits >> (8 * byte) & 0xFFU)) * 0x100000001B3U;
  }
  void add(const Vec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

// A box, bulged and twisted by sums, products and a quotient only, so that its bits do not depend on the
// mathematical library.
TriangleMesh bulged_box() {
  return mapped(make_shape(BoxShape{.size = {2, 2, 2}, .segments = {14, 14, 14}}), [](const Vec3& v) {
    const double x = v.x();
    const double y = v.y();
    const double z = v.z();
    const double stretch = 1.0 + 0.25 * (x * y - z * z) / (1.0 + x * x + y * y);
    // Not by vectors, whose products and sums Eigen joins.
    return Vec3(x * stretch + 0.2 * y * z, y * stretch - 0.1 * x * z, z * stretch);
  });
}

TEST(Hierarchical, IsBitIdenticalAcrossCompilersAndBuildTypes) {
  const TriangleMesh source = bulged_box();
  const HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}});
  const std::map<std::string, std::uint64_t> golden{{"AVX3", 0xf0cb2f6d94bc5ecf},
                                                    {"AVX2", 0xf8ebf569bd85e4e5},
                                                    {"SSE4", 0xc2063524bac06932},
                                                    {"SSSE3", 0xc2063524bac06932},
                                                    {"SCALAR", 0x174f2ad79158f28}};
  for (const std::string& target : simd_targets()) {
    const auto known = golden.find(target.substr(0, target.find('_')));  // AVX3_DL and others compute as AVX3
    if (known == golden.end()) continue;  // no golden value has been recorded for this instruction set
    const ForcedTarget forced(target);
    BitHash hash;
    for (int i = 0; i < 64; ++i) {
      const double a = 0.05 * i;
      const Pose pose{Vec3(3.0 * a, -a, 0.06 * (i % 32) - 0.9),
                      Eigen::Quaterniond(1.0 - 0.3 * a, 0.5 - a, 0.2 * a, 0.7 * a - 0.1)};
      const WaterPlane plane = water_plane_in_body(pose, {}, mesh.center_B);
      for (const double tolerance : {0.0, 1e-2}) {
        const Displacement found = hierarchical(mesh, plane, tolerance);
        hash.add(found.volume);
        hash.add(found.moment);
        hash.add(found.torque);
        hash.add(found.truncation_bound);
      }
    }
    EXPECT_EQ(hash.value(), known->second)
        << target << ": if the change of bits is intended, the new value is 0x" << std::hex << hash.value();
  }
}

}  // namespace
}  // namespace buoyancy
