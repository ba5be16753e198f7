#include "hydrostatics/load_difference.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/mass_properties.h"
#include "geometry/volume_difference.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kDensity = 1000.0;
constexpr double kGravity = 10.0;
constexpr int kPoses = 10'000;

HydrostaticMesh prepared(const TriangleMesh& mesh) {
  return make_hydrostatic_mesh(ValidatedMesh{mesh, {}});
}

LoadDifference difference(const TriangleMesh& a, const TriangleMesh& b) {
  return largest_load_difference(prepared(a), prepared(b), kDensity, kGravity, kPoses);
}

double largest_distance_from_origin(const TriangleMesh& mesh) {
  double largest = 0.0;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    largest = std::max(largest, mesh.vertex(static_cast<std::int32_t>(i)).norm());
  return largest;
}

TriangleMesh dented(TriangleMesh mesh, RandomPoses& random) {
  const std::size_t i = random.pick(mesh.vertex_count());
  mesh.x[i] *= 0.7;
  mesh.y[i] *= 0.7;
  mesh.z[i] *= 0.7;
  return mesh;
}

TEST(LoadDifference, IsBelowTheWeightOfTheVolumeBetween) {
  RandomPoses random(23);
  const TriangleMesh rock = rock_mesh();
  const TriangleMesh box = box_mesh({-1.0, -0.5, -0.4}, {1.0, 0.5, 0.4});
  const TriangleMesh hull = make_shape(WigleyShape{.segments = 24, .levels = 8});
  const std::vector<std::pair<TriangleMesh, TriangleMesh>> pairs{
      {rock, dented(rock, random)},
      {rock, moved_and_scaled(rock, Vec3::Zero(), 1.01)},
      {box, moved_and_scaled(box, {0.01, 0.02, -0.03})},
      {hull, make_shape(WigleyShape{.beam = 1.05, .segments = 24, .levels = 8})},
      {rock, box},
  };
  for (const auto& pair : pairs) {
    const LoadDifference found = difference(pair.first, pair.second);
    const VolumeDifference between = symmetric_difference(pair.first, pair.second);
    const double weight = kDensity * kGravity * (between.value + between.error);
    EXPECT_LE(found.force, weight + found.force_error);
    EXPECT_GE(found.force, 0.05 * weight);
    const double reach =
        std::max(largest_distance_from_origin(pair.first), largest_distance_from_origin(pair.second));
    EXPECT_LE(found.torque, weight * reach + found.torque_error);
    EXPECT_GT(found.torque, found.torque_error);
  }
}

// A mesh inside another differs most where all that is between is under water.
TEST(LoadDifference, IsThatOfWhatIsBetweenNestedMeshes) {
  const TriangleMesh inner = box_mesh({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  const TriangleMesh outer = box_mesh({-1.1, -1.0, -1.0}, {1.0, 1.0, 1.0});
  const LoadDifference found = difference(inner, outer);
  const double weight = kDensity * kGravity * 0.1 * 2.0 * 2.0;
  EXPECT_LE(found.force, weight + found.force_error);
  EXPECT_GE(found.force, 0.99 * weight);
  // Its centre is 1.05 m from the origin, at most so far from the vertical through it.
  EXPECT_NEAR(found.torque, 1.05 * weight, 0.03 * weight);
}

TEST(LoadDifference, IsZeroForTheSameMesh) {
  const LoadDifference found = difference(rock_mesh(), rock_mesh());
  EXPECT_EQ(found.force, 0.0);
  EXPECT_EQ(found.torque, 0.0);
  EXPECT_GT(found.force_error, 0.0);
}

TEST(LoadDifference, IsZeroWithoutPoses) {
  const HydrostaticMesh mesh = prepared(rock_mesh());
  EXPECT_EQ(largest_load_difference(mesh, mesh, kDensity, kGravity, 0).force_error, 0.0);
}

}  // namespace
}  // namespace buoyancy
