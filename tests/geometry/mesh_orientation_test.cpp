#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/mesh_validation.h"
#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

MeshReport report_of(const TriangleMesh& mesh) {
  const MeshValidation validation = validate_mesh({mesh, {}}, "mesh", {});
  EXPECT_TRUE(validation.mesh) << validation.refusal->message();
  return validation.report;
}

TEST(MeshOrientation, TurnsOnlyInsideOutComponent) {
  const MeshReport report = report_of(joined(cube_mesh(2), inside_out(cube_mesh(1, Vec3(9, 0, 0)))));
  EXPECT_DOUBLE_EQ(report.volume, 9.0);
  EXPECT_FALSE(report.flipped);
  ASSERT_EQ(report.components.size(), 2U);
  EXPECT_FALSE(report.components[0].flipped);
  EXPECT_TRUE(report.components[1].flipped);
  EXPECT_DOUBLE_EQ(report.components[1].volume, 1.0);
  EXPECT_FALSE(report.components[1].cavity);
}

TEST(MeshOrientation, TurnsLargerInsideOutComponent) {
  const MeshReport report = report_of(joined(inside_out(cube_mesh(2)), cube_mesh(1, Vec3(9, 0, 0))));
  EXPECT_DOUBLE_EQ(report.volume, 9.0);
  EXPECT_TRUE(report.components[0].flipped);
  EXPECT_FALSE(report.components[1].flipped);
}

TEST(MeshOrientation, KeepsCavity) {
  const MeshReport report = report_of(joined(cube_mesh(2), inside_out(cube_mesh(1, Vec3(0.2, 0, 0)))));
  EXPECT_DOUBLE_EQ(report.volume, 7.0);
  EXPECT_TRUE(report.components[1].cavity);
  EXPECT_FALSE(report.components[1].flipped);
  EXPECT_FALSE(report.components[1].nested);
}

TEST(MeshOrientation, TurnsInsideOutShellWithItsCavity) {
  const MeshReport report = report_of(joined(inside_out(cube_mesh(2)), cube_mesh(1)));
  EXPECT_DOUBLE_EQ(report.volume, 7.0);
  EXPECT_TRUE(report.flipped);
  EXPECT_TRUE(report.components[1].cavity);
}

TEST(MeshOrientation, KeepsCavityNextToInsideOutSolid) {
  const MeshReport report = report_of(
      joined(joined(cube_mesh(2), inside_out(cube_mesh(1))), inside_out(cube_mesh(3, Vec3(9, 0, 0)))));
  EXPECT_DOUBLE_EQ(report.volume, 27.0 + 7.0);
  EXPECT_TRUE(report.components[0].flipped);
  EXPECT_TRUE(report.components[2].cavity);
  EXPECT_FALSE(report.flipped);
}

TEST(MeshOrientation, ReportsNestedSolid) {
  const MeshReport report = report_of(joined(cube_mesh(2), cube_mesh(1)));
  EXPECT_DOUBLE_EQ(report.volume, 9.0);
  EXPECT_TRUE(report.components[1].nested);
  EXPECT_FALSE(report.components[1].cavity);
}

TEST(MeshOrientation, TurnsInsideOutSolidInCavity) {
  const TriangleMesh shell = joined(cube_mesh(3), inside_out(cube_mesh(2)));
  EXPECT_DOUBLE_EQ(report_of(joined(shell, cube_mesh(1))).volume, 27.0 - 8.0 + 1.0);
  const MeshReport report = report_of(joined(shell, inside_out(cube_mesh(1))));
  EXPECT_DOUBLE_EQ(report.volume, 27.0 - 8.0 + 1.0);
  EXPECT_TRUE(report.components[2].flipped);
  EXPECT_FALSE(report.components[2].nested);
}

TEST(MeshOrientation, DistinguishesNestedBoxesFromNestedSolids) {
  // A small cube in the hole of a ring lies inside the ring's box but outside the ring.
  const TriangleMesh ring = make_shape(TorusKnotShape{1.0, 0.1, 1, 1, 60, 12});
  const MeshReport outside = report_of(joined(ring, inside_out(cube_mesh(0.1))));
  EXPECT_TRUE(outside.components[1].flipped);
  EXPECT_FALSE(outside.components[1].cavity);
}

TEST(MeshOrientation, IgnoresFacesBehindRayOrigin) {
  // The cube lies beyond the slanted face, inside that face's box.
  TriangleMesh corner = tetrahedron_mesh();
  corner = moved_mesh(corner, 10.0 * Mat3::Identity(), Vec3::Zero());
  const MeshReport report = report_of(joined(corner, inside_out(cube_mesh(1, Vec3(6, 3, 3)))));
  EXPECT_TRUE(report.components[1].flipped);
  EXPECT_FALSE(report.components[1].cavity);
}

TEST(MeshOrientation, HandlesRaysThroughEdgesAndVertices) {
  // All vertices lie on one grid, so that every ray from an inner vertex meets edges and vertices of the
  // outer mesh.
  const TriangleMesh outer = make_shape(BoxShape{{4, 4, 4}, {8, 8, 8}});
  const TriangleMesh inner = make_shape(BoxShape{{2, 2, 2}, {4, 4, 4}});
  EXPECT_DOUBLE_EQ(report_of(joined(outer, inside_out(inner))).volume, 64.0 - 8.0);
  const TriangleMesh adjacent = moved_mesh(inner, Mat3::Identity(), {6, 0, 0});
  EXPECT_DOUBLE_EQ(report_of(joined(outer, inside_out(adjacent))).volume, 64.0 + 8.0);
}

TEST(MeshOrientation, DoesNotNestIntersectingComponents) {
  const MeshReport report = report_of(joined(cube_mesh(2), cube_mesh(1, Vec3(0, 0, 0.9))));
  EXPECT_FALSE(report.components[1].nested);
  EXPECT_DOUBLE_EQ(report.volume, 9.0);
}

TEST(MeshOrientation, DoesNotNestIntersectingComponentsWithNestedBoxes) {
  const TriangleMesh corner = moved_mesh(tetrahedron_mesh(), 10.0 * Mat3::Identity(), Vec3::Zero());
  EXPECT_TRUE(report_of(joined(corner, cube_mesh(1, Vec3(2, 2, 2)))).components[1].nested);
  EXPECT_FALSE(report_of(joined(corner, cube_mesh(2, Vec3(3.4, 3.4, 3.4)))).components[1].nested);
}

TEST(MeshOrientation, HandlesManyCavities) {
  TriangleMesh sponge = cube_mesh(20);
  int cavities = 0;
  for (int x = -8; x <= 8; x += 2) {
    for (int y = -8; y <= 8; y += 2) {
      for (int z = -8; z <= 8; z += 2, ++cavities) {
        sponge = joined(std::move(sponge), inside_out(cube_mesh(1, Vec3(x, y, z))));
      }
    }
  }
  const MeshReport report = report_of(sponge);
  ASSERT_EQ(report.components.size(), static_cast<std::size_t>(cavities) + 1);
  EXPECT_NEAR(report.volume, 8000.0 - cavities, 1e-9);
  EXPECT_TRUE(report.components.back().cavity);
}

}  // namespace
}  // namespace buoyancy
