#include "geometry/mass_properties.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

Mat3 box_inertia(const Vec3& size) {
  const Vec3 squares = size.cwiseProduct(size);
  return size.prod() / 12.0 * (squares.sum() * Mat3::Identity() - Mat3(squares.asDiagonal()));
}

void expect_near(const Mat3& value, const Mat3& expected, double tolerance) {
  EXPECT_LE((value - expected).cwiseAbs().maxCoeff(), tolerance) << value << "\nexpected\n" << expected;
}

TEST(MassProperties, MatchClosedFormOfBox) {
  const MassProperties box = mass_properties(box_mesh(Vec3(1, 2, 3), Vec3(2, 4, 7)));
  EXPECT_NEAR(box.volume, 8.0, 1e-14);
  EXPECT_LE((box.centroid_B - Vec3(1.5, 3, 5)).norm(), 1e-14);
  expect_near(box.inertia_B, box_inertia({1, 2, 4}), 1e-13);
}

TEST(MassProperties, MatchClosedFormOfTetrahedron) {
  // Corner tetrahedron: volume 1/6, centroid 1/4, second moments 1/60 and 1/120 about the corner.
  const MassProperties corner = mass_properties(tetrahedron_mesh());
  EXPECT_NEAR(corner.volume, 1.0 / 6.0, 1e-16);
  EXPECT_LE((corner.centroid_B - Vec3::Constant(0.25)).norm(), 1e-15);
  const double square = 1.0 / 60.0 - 1.0 / 96.0;
  const double product = 1.0 / 120.0 - 1.0 / 96.0;
  Mat3 inertia = Mat3::Constant(-product);
  inertia.diagonal().setConstant(2.0 * square);
  expect_near(corner.inertia_B, inertia, 1e-16);
}

TEST(MassProperties, RotateAndTranslateWithTheMesh) {
  const Mat3 rotation = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const Vec3 translation_B(3, -4, 5);
  const MassProperties box =
      mass_properties(moved_mesh(box_mesh(Vec3(-0.5, -1, -2), Vec3(0.5, 1, 2)), rotation, translation_B));
  EXPECT_NEAR(box.volume, 8.0, 1e-13);
  EXPECT_LE((box.centroid_B - translation_B).norm(), 1e-14);
  expect_near(box.inertia_B, rotation * box_inertia({1, 2, 4}) * rotation.transpose(), 1e-13);
}

TEST(MassProperties, StayAccurateFarFromOrigin) {
  const Vec3 far(1e6, -1e6, 1e6);
  const MassProperties box = mass_properties(box_mesh(far, far + Vec3(1, 2, 4)));
  EXPECT_NEAR(box.volume, 8.0, 1e-14);
  EXPECT_EQ(box.centroid_B, far + Vec3(0.5, 1, 2));
  expect_near(box.inertia_B, box_inertia({1, 2, 4}), 1e-13);
}

TEST(MassProperties, SubtractCavities) {
  const MassProperties shell =
      mass_properties(joined(cube_mesh(2), inside_out(cube_mesh(1, Vec3(0.25, 0, 0)))));
  EXPECT_NEAR(shell.volume, 7.0, 1e-14);
  EXPECT_NEAR(shell.centroid_B.x(), -0.25 / 7.0, 1e-15);
}

TEST(MassProperties, ConvergeQuadraticallyForSphere) {
  const double exact = 8.0 / 15.0 * 3.14159265358979323846;
  const double coarse = mass_properties(sphere_mesh(20)).inertia_B(0, 0) - exact;
  const double fine = mass_properties(sphere_mesh(40)).inertia_B(0, 0) - exact;
  EXPECT_LT(fine, 0.0);
  EXPECT_NEAR(coarse / fine, 4.0, 0.15);
}

TEST(MassProperties, AreZeroForEmptyMeshAndSheet) {
  EXPECT_EQ(mass_properties(TriangleMesh{}).volume, 0.0);
  TriangleMesh sheet = tetrahedron_mesh();
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_EQ(mass_properties(sheet).volume, 0.0);
  EXPECT_EQ(mass_properties(sheet).centroid_B, Vec3(0.5, 0.5, 0.0));
}

}  // namespace
}  // namespace buoyancy
