#include "geometry/volume_difference.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {
namespace {

struct Pair {
  TriangleMesh a, b;
  double difference = 0.0;  // [m^3], from a formula
};

// A mesh that is star-shaped about the origin, and a larger one of the same shape.
Pair scaled(const TriangleMesh& mesh, double scale) {
  const TriangleMesh larger = mapped(mesh, [&](const Vec3& point) { return Vec3(scale * point); });
  return {mesh, larger, volume_of(larger) - volume_of(mesh)};
}

Pair rotated(Pair pair, const Eigen::Quaterniond& q, const Vec3& by) {
  const auto move = [&](const Vec3& point) { return Vec3(q * point + by); };
  pair.a = mapped(pair.a, move);
  pair.b = mapped(pair.b, move);
  return pair;
}

Pair random_boxes(RandomPoses& random) {
  const auto size = [&] {
    return Vec3{random.uniform(0.2, 1.2), random.uniform(0.2, 1.2), random.uniform(0.2, 1.2)};
  };
  const Vec3 a = size();
  const Vec3 b = size();
  const Vec3 offset = random.vector(0.0, 1.0);
  const Vec3 common =
      ((0.5 * a).cwiseMin(offset + 0.5 * b) - (-0.5 * a).cwiseMax(offset - 0.5 * b)).cwiseMax(Vec3::Zero());
  return {box_mesh(-0.5 * a, 0.5 * a), box_mesh(offset - 0.5 * b, offset + 0.5 * b),
          a.prod() + b.prod() - 2.0 * common.prod()};
}

Pair random_hulls(RandomPoses& random) {
  const TriangleMesh hull = make_shape(WigleyShape{.segments = 32, .levels = 8});
  const double factor = 1.0 + random.uniform(0.001, 0.2);
  const TriangleMesh wider =
      mapped(hull, [&](const Vec3& point) { return Vec3(point.x(), factor * point.y(), point.z()); });
  return {hull, wider, volume_of(wider) - volume_of(hull)};
}

// A vertex pushed out along its normal: tetrahedra over the faces around it are added.
Pair random_bump(RandomPoses& random) {
  Pair pair{sphere_mesh(24), {}, 0.0};
  pair.b = pair.a;
  const auto i = random.pick(pair.a.vertex_count());
  const double factor = 1.0 + std::pow(10.0, random.uniform(-5.0, -1.0));
  pair.b.x[i] *= factor;
  pair.b.y[i] *= factor;
  pair.b.z[i] *= factor;
  for (const Triangle& face : pair.a.triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (static_cast<std::size_t>(face[corner]) != i) continue;
      const Vec3 here = pair.a.vertex(face[corner]);
      const Vec3 rise = pair.b.vertex(face[corner]) - here;
      pair.difference += rise.dot((pair.a.vertex(face[(corner + 1) % 3]) - here)
                                      .cross(pair.a.vertex(face[(corner + 2) % 3]) - here)) /
                         6.0;
    }
  }
  return pair;
}

// A side of a box moved out by little, and the whole turned by little: a layer along the columns.
Pair random_layer(RandomPoses& random) {
  const TriangleMesh box = make_shape(BoxShape{.segments = {8, 8, 8}});
  const double thickness = std::pow(10.0, random.uniform(-4.0, -2.0));
  const Pair pair{box,
                  mapped(box,
                         [&](const Vec3& point) {
                           return Vec3(point + (point.x() > 0.49 ? thickness : 0.0) * Vec3::UnitX());
                         }),
                  thickness};
  const double angle = std::pow(10.0, random.uniform(-8.0, -0.5));
  return rotated(pair, Eigen::Quaterniond(Eigen::AngleAxisd(angle, random.direction())), Vec3::Zero());
}

// make_pair(random): a pair with a known difference.
template <typename MakePair>
void expect_within_error(std::uint64_t seed, const MakePair& make_pair) {
  constexpr int kPairs = 40;
  RandomPoses random(seed);
  double sum_of_shares = 0.0;
  for (int i = 0; i < kPairs; ++i) {
    const Pair pair = make_pair(random);
    const VolumeDifference found = symmetric_difference(pair.a, pair.b);
    // What the formula itself may be off, from the rounding of coordinates.
    const double rounding = 1e-13 * (volume_of(pair.a) + volume_of(pair.b));
    EXPECT_LE(std::abs(found.value - pair.difference), found.error + rounding) << i;
    EXPECT_LE(found.error, 0.25 * pair.difference + 1e-11) << i;
    EXPECT_NEAR(found.value, pair.difference, 0.05 * pair.difference + 1e-11) << i;
    if (pair.difference > 1e-9) sum_of_shares += found.error / pair.difference;
  }
  EXPECT_LE(sum_of_shares, 0.03 * kPairs);
}

// A third as they are, since faces along the columns are special.
Pair mostly_rotated(const Pair& pair, RandomPoses& random) {
  if (random.pick(3) == 0) return pair;
  const Eigen::Quaterniond turn = random.rotation();
  return rotated(pair, turn, random.direction());
}

TEST(VolumeDifference, IsWithinItsErrorForBoxes) {
  expect_within_error(11, [](RandomPoses& random) { return mostly_rotated(random_boxes(random), random); });
}

TEST(VolumeDifference, IsWithinItsErrorForScaledSpheres) {
  expect_within_error(12, [](RandomPoses& random) {
    const TriangleMesh sphere = sphere_mesh(12 + static_cast<std::int32_t>(random.pick(24)));
    return mostly_rotated(scaled(sphere, 1.0 + std::pow(10.0, random.uniform(-4.0, -0.5))), random);
  });
}

TEST(VolumeDifference, IsWithinItsErrorForScaledRocks) {
  expect_within_error(13, [](RandomPoses& random) {
    const TriangleMesh rock = rock_mesh(4 + static_cast<std::int32_t>(random.pick(6)));
    return mostly_rotated(scaled(rock, 1.0 + std::pow(10.0, random.uniform(-4.0, -0.5))), random);
  });
}

TEST(VolumeDifference, IsWithinItsErrorForStretchedHulls) {
  expect_within_error(14, [](RandomPoses& random) { return mostly_rotated(random_hulls(random), random); });
}

TEST(VolumeDifference, IsWithinItsErrorForLayersAlongTheColumns) {
  expect_within_error(15, random_layer);
}

TEST(VolumeDifference, IsWithinItsErrorForBumps) {
  expect_within_error(16, [](RandomPoses& random) { return mostly_rotated(random_bump(random), random); });
}

TEST(VolumeDifference, IsExactForBoxesAlongTheAxes) {
  const TriangleMesh box = box_mesh({0.0, 0.0, 0.0}, {2.0, 1.0, 1.0});
  for (const double move : {1e-9, 1e-3, 0.3, 1.0, 2.5}) {
    const TriangleMesh moved =
        mapped(box, [&](const Vec3& point) { return Vec3(point + move * Vec3::UnitX()); });
    const VolumeDifference found = symmetric_difference(box, moved);
    EXPECT_NEAR(found.value, 2.0 * std::min(move, 2.0), 1e-13) << move;
    EXPECT_LE(found.error, 1e-11) << move;
  }
}

TEST(VolumeDifference, IsZeroForTheSameTriangles) {
  TriangleMesh mesh = rock_mesh();
  const TriangleMesh other = unwelded(mesh);
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  for (Triangle& face : mesh.triangles) std::rotate(face.begin(), face.begin() + 1, face.end());
  const VolumeDifference found = symmetric_difference(mesh, other);
  EXPECT_EQ(found.value, 0.0);
  EXPECT_EQ(found.error, 0.0);
}

TEST(VolumeDifference, IsNextToNothingForOtherTrianglesOfTheSameSurface) {
  RandomPoses random(18);
  const Pair pair = rotated({box_mesh({0, 0, 0}, {2, 1, 1}), {}, 0.0}, random.rotation(), Vec3::Zero());
  TriangleMesh turned = pair.a;
  turned.triangles[0] = {0, 2, 3};  // the other diagonal of a face
  turned.triangles[1] = {0, 3, 1};
  const VolumeDifference found = symmetric_difference(pair.a, turned);
  EXPECT_LE(found.value, found.error);
  EXPECT_LE(found.error, 1e-12);
}

TEST(VolumeDifference, IsBothVolumesOfDisjointMeshes) {
  const TriangleMesh rock = rock_mesh();
  const TriangleMesh sphere =
      mapped(sphere_mesh(20), [](const Vec3& point) { return Vec3(point + Vec3(3.0, 2.0, 1.0)); });
  const VolumeDifference found = symmetric_difference(rock, sphere);
  const double truth = volume_of(rock) + volume_of(sphere);
  EXPECT_LE(std::abs(found.value - truth), found.error);
  EXPECT_LE(found.error, 1e-2 * truth);
  EXPECT_NEAR(symmetric_difference(sphere, rock).value, found.value, 1e-12);
}

TEST(VolumeDifference, FindsManySmallChanges) {
  const TriangleMesh sphere = sphere_mesh(48);
  TriangleMesh bumpy = sphere;
  RandomPoses random(19);
  double truth = 0.0;
  for (int i = 0; i < 100; ++i) {
    const std::size_t vertex = random.pick(sphere.vertex_count());
    TriangleMesh bump = bumpy;
    bump.x[vertex] *= 1.001;
    bump.y[vertex] *= 1.001;
    bump.z[vertex] *= 1.001;
    truth += volume_of(bump) - volume_of(bumpy);
    bumpy = bump;
  }
  const VolumeDifference found = symmetric_difference(sphere, bumpy);
  EXPECT_LE(std::abs(found.value - truth), found.error);
  EXPECT_LE(found.error, 1e-2 * truth);
}

}  // namespace
}  // namespace buoyancy
