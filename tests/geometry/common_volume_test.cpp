#include "geometry/common_volume.h"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/mass_properties.h"
#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {
namespace {

double common(const TriangleMesh& a, const TriangleMesh& b, const Vec3& offset = Vec3::Zero()) {
  return common_volume({&a, Vec3::Zero()}, {&b, offset});
}

double outside(const TriangleMesh& a, const TriangleMesh& b, const Vec3& offset = Vec3::Zero()) {
  return volume_outside({&a, Vec3::Zero()}, {&b, offset});
}

const TriangleMesh kBox = make_shape(BoxShape{.size = {2.0, 1.0, 1.0}});
const TriangleMesh kFineBox = make_shape(BoxShape{.size = {2.0, 1.0, 1.0}, .segments = {8, 5, 3}});

TEST(CommonVolume, IsExactForBoxesAlongTheAxes) {
  EXPECT_NEAR(common(kBox, kFineBox), 2.0, 1e-12);
  EXPECT_NEAR(common(kBox, kFineBox, {0.5, 0.25, -0.125}), 1.5 * 0.75 * 0.875, 1e-12);
  EXPECT_NEAR(outside(kBox, kFineBox, {0.5, 0.25, -0.125}), 2.0 - 1.5 * 0.75 * 0.875, 1e-12);
  EXPECT_NEAR(outside(kBox, kFineBox), 0.0, 1e-12);
  EXPECT_NEAR(outside(kBox, kFineBox, {0.0, 1e-4, 0.0}), 2e-4, 1e-12);
}

TEST(CommonVolume, IsZeroForMeshesThatTouch) {
  EXPECT_LE(common(kBox, kFineBox, {2.0, 0.0, 0.0}), 1e-15);
  EXPECT_LE(common(kBox, kFineBox, {0.0, 1.0, 0.0}), 1e-15);
  EXPECT_LE(common(kBox, kFineBox, {0.0, 0.0, -1.0}), 1e-15);
  EXPECT_EQ(common(kBox, kFineBox, {5.0, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(outside(kBox, kFineBox, {5.0, 0.0, 0.0}), 2.0, 1e-12);
}

// Two unit balls at a distance share a lens.
TEST(CommonVolume, IsTheLensOfTwoSpheres) {
  const TriangleMesh ball = make_shape(SphereShape{.radius = 1.0, .segments = 64});
  for (const double distance : {0.2, 0.7, 1.3, 1.9}) {
    const double half = 1.0 - 0.5 * distance;
    const double lens = 2.0 * M_PI * half * half * (3.0 - half) / 3.0;
    EXPECT_NEAR(common(ball, ball, distance * Vec3(0.6, 0.0, 0.8)), lens, 1e-2) << distance;
  }
}

TEST(CommonVolume, IsThatOfWhateverIsInside) {
  RandomPoses random(91);
  const TriangleMesh hull = make_shape(SphereShape{.radius = 4.0, .segments = 24});
  for (const Shape& shape : {Shape(TorusKnotShape{}), Shape(RockShape{.frequency = 6}), Shape(ConeShape{}),
                             Shape(BoxShape{.size = {1.0, 2.0, 3.0}})}) {
    for (int i = 0; i < 4; ++i) {
      const Eigen::Quaterniond turn = random.rotation();
      const TriangleMesh inner = turned(make_shape(shape), turn, random.direction());
      const double volume = mass_properties(inner).volume;
      EXPECT_NEAR(common(inner, hull), volume, 2e-3 * volume);
      EXPECT_LE(outside(inner, hull), 1e-12);
      const TriangleMesh moved = turned(inner, Eigen::Quaterniond::Identity(), 0.3 * random.direction());
      EXPECT_NEAR(common(inner, moved) + outside(inner, moved), volume, 4e-3 * volume);
    }
  }
}

// The inside of a surface that does not enter the box of the other, and what only looks like it.
TEST(CommonVolume, TellsInsideFromOutsideWhereSurfacesDoNotMeet) {
  const TriangleMesh small = box_mesh(Vec3::Constant(-0.1), Vec3::Constant(0.1));
  const TriangleMesh large = box_mesh(Vec3::Constant(-1.0), Vec3::Constant(1.0));
  const TriangleMesh hollow = joined(large, inside_out(box_mesh(Vec3::Constant(-0.5), Vec3::Constant(0.5))));
  EXPECT_EQ(outside(small, large), 0.0);
  EXPECT_EQ(outside(small, large, {-0.9, 0.0, 0.0}), 0.0) << "they touch";
  EXPECT_NEAR(outside(small, hollow), 0.008, 1e-12);
  EXPECT_EQ(outside(small, hollow, {0.75, 0.1, 0.0}), 0.0);
  EXPECT_NEAR(outside(small, hollow, {0.5, 0.0, 0.0}), 0.004, 1e-12);
  EXPECT_NEAR(outside(small, inside_out(large)), 0.008, 1e-12);
  // A face at a slant, whose box meets that of the other mesh.
  const TriangleMesh slanted = turned(large, Eigen::Quaterniond(2.0, 0.0, 0.0, 1.0).normalized());
  EXPECT_EQ(outside(small, slanted, {-0.6, 0.5, 0.0}), 0.0);
  EXPECT_NEAR(outside(small, slanted, {-1.05, -1.05, 0.0}), 0.008, 1e-12);
}

// The same surface in other triangles, turned so that no face lies along a column.
TEST(CommonVolume, FindsNothingOutsideTheSameSurface) {
  RandomPoses random(92);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Quaterniond q = random.rotation();
    EXPECT_LE(outside(turned(kBox, q), turned(kFineBox, q)), 1e-6) << i;
  }
}

TEST(CommonVolume, OfAMeshWithItself) {
  const TriangleMesh box = box_mesh(Vec3::Zero(), {2.0, 1.0, 1.0});
  EXPECT_EQ(overlap_volume(box), 0.0);
  const TriangleMesh overlapping = joined(box, box_mesh({1.5, 0.0, 0.0}, {3.0, 1.0, 1.0}));
  EXPECT_NEAR(overlap_volume(overlapping).value(), 0.5, 1e-12);
  // Three times the same counts twice too often.
  EXPECT_NEAR(overlap_volume(joined(joined(box, box), box)).value(), 4.0, 1e-12);
  const TriangleMesh inner = sphere_mesh(24, 0.5);
  const double of_inner = mass_properties(inner).volume;
  EXPECT_NEAR(overlap_volume(joined(sphere_mesh(24), inner)).value(), of_inner, 2e-3 * of_inner);
  TriangleMesh layers = box;
  for (int i = 1; i < 16; ++i) layers = joined(layers, box);
  EXPECT_NEAR(overlap_volume(layers).value(), 15.0 * 2.0, 1e-11) << "32 crossings";
  EXPECT_EQ(overlap_volume(joined(layers, box)), std::nullopt);
  EXPECT_EQ(overlap_volume(joined(sphere_mesh(24), inside_out(sphere_mesh(24, 0.5)))), 0.0);
}

}  // namespace
}  // namespace buoyancy
