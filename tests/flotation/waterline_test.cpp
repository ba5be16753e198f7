#include "flotation/waterline.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hydrostatics/hydrostatics.h"
#include "tests/flotation/bodies.h"
#include "tests/hydrostatics/forced_target.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

const Water kWater;

// The waterplane from its edges is that from all moments of the wetted surface.
TEST(Waterline, HasTheMomentsOfTheWaterplane) {
  for (const Shape& shape : {Shape(RockShape{.frequency = 9, .roughness = 0.5, .seed = 5}),
                             Shape(TorusKnotShape{}), Shape(BoxShape{{3, 2, 1}, {4, 3, 2}})}) {
    const HydrostaticMesh mesh =
        make_hydrostatic_mesh({moved_and_scaled(make_shape(shape), Vec3(5, -7, 3), 1.7), {}});
    const BoundingBox box{mesh.center_B + mesh.box_min, mesh.center_B + mesh.box_max};
    RandomPoses random(6);
    int compared = 0;
    for (int i = 0; i < 60; ++i) {
      const Pose pose = random.crossing(box, kWater);
      const auto expected = hydrostatics(mesh, pose, kWater, mesh.center_B, std::nullopt);
      if (!(expected->waterplane_area > 1e-6)) continue;
      ++compared;
      const WaterPlane plane = water_plane_in_body(pose, kWater, mesh.center_B);
      const Vec3 e1_B = pose.q_WB.conjugate() * expected->waterplane_axes_W[0];
      const Vec3 centroid_B = pose.q_WB.conjugate() * expected->waterplane_centroid_W - mesh.center_B;
      const Waterline found =
          waterline(mesh, plane, {.u = e1_B, .v = plane.up_B.cross(e1_B), .origin = centroid_B});
      const double tolerance = 1e-12 * mesh.area;
      const double length = mesh.diagonal;
      EXPECT_NEAR(found.area, expected->waterplane_area, tolerance);
      EXPECT_NEAR(found.u, 0.0, tolerance * length);
      EXPECT_NEAR(found.v, 0.0, tolerance * length);
      EXPECT_NEAR(found.vv, expected->waterplane_second_moments[0], tolerance * length * length);
      EXPECT_NEAR(found.uu, expected->waterplane_second_moments[1], tolerance * length * length);
      EXPECT_NEAR(found.uv, 0.0, tolerance * length * length);
      EXPECT_LT(found.min_u, 0.0);
      EXPECT_GT(found.max_v, 0.0);
    }
    EXPECT_GT(compared, 20);
  }
}

// Leaves of float32 and of double, with and without cut triangles, in vectors of one to eight numbers.
TEST(Waterline, IsTheSameOnEveryInstructionSet) {
  for (const Shape& shape : {Shape(RockShape{.frequency = 12, .roughness = 0.4, .seed = 9}),
                             Shape(CylinderShape{0.5, 2, 40, 9})}) {
    const HydrostaticMesh mesh = mesh_of(shape);
    const BoundingBox box{mesh.center_B + mesh.box_min, mesh.center_B + mesh.box_max};
    RandomPoses random(8);
    int compared = 0;
    for (int i = 0; i < 40; ++i) {
      const WaterPlane plane = water_plane_in_body(random.crossing(box, kWater), kWater, mesh.center_B);
      const Vec3 u_B = plane.up_B.unitOrthogonal();
      const WaterlineAxes axes{.u = u_B, .v = plane.up_B.cross(u_B), .origin = Vec3(0.1, 0.2, 0.3)};
      const auto on = [&](const std::string& target) {
        const ForcedTarget forced(target);
        return waterline(mesh, plane, axes);
      };
      const Waterline expected = on(simd_targets().back());
      if (expected.min_u > expected.max_u) continue;
      ++compared;
      for (const std::string& target : simd_targets()) {
        SCOPED_TRACE(target);
        const Waterline found = on(target);
        EXPECT_NEAR(found.area, expected.area, 1e-14);
        EXPECT_NEAR(found.u, expected.u, 1e-14);
        EXPECT_NEAR(found.v, expected.v, 1e-14);
        EXPECT_NEAR(found.uu, expected.uu, 1e-14);
        EXPECT_NEAR(found.uv, expected.uv, 1e-14);
        EXPECT_NEAR(found.vv, expected.vv, 1e-14);
        EXPECT_NEAR(found.min_u, expected.min_u, 1e-14);
        EXPECT_NEAR(found.max_u, expected.max_u, 1e-14);
        EXPECT_NEAR(found.min_v, expected.min_v, 1e-14);
        EXPECT_NEAR(found.max_v, expected.max_v, 1e-14);
      }
    }
    EXPECT_GT(compared, 15);
  }
}

// A mesh that a scene scales keeps the file's coordinates in its tree.
TEST(Waterline, IsInMetresForAScaledMesh) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 6, .roughness = 0.4, .seed = 7});
  const HydrostaticMesh mesh =
      make_hydrostatic_mesh({moved_and_scaled(rock, Vec3::Zero(), 0.01), {}}, WithTree::kYes, 0.01);
  ASSERT_EQ(mesh.tree->scale, 0.01);
  const Pose pose{Vec3(0, 0, 0.002), Eigen::Quaterniond(0.8, 0.6, 0.0, 0.0)};
  const auto expected = hydrostatics(mesh, pose, kWater, mesh.center_B, std::nullopt);
  const WaterPlane plane = water_plane_in_body(pose, kWater, mesh.center_B);
  const Vec3 u_B = pose.q_WB.conjugate() * expected->waterplane_axes_W[0];
  const Vec3 centroid_B = pose.q_WB.conjugate() * expected->waterplane_centroid_W - mesh.center_B;
  const Waterline found =
      waterline(mesh, plane, {.u = u_B, .v = plane.up_B.cross(u_B), .origin = centroid_B});
  EXPECT_NEAR(found.area, expected->waterplane_area, 1e-16);
  EXPECT_NEAR(found.u, 0.0, 1e-18);
  EXPECT_NEAR(found.vv, expected->waterplane_second_moments[0], 1e-20);
  EXPECT_NEAR(found.uu, expected->waterplane_second_moments[1], 1e-20);
}

TEST(Waterline, HasTheExtentOfABoxAndNoneInTheDry) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{6, 2, 1}, {3, 2, 2}});
  const WaterlineAxes axes;
  const Waterline found = waterline(mesh, WaterPlane{.up_B = Vec3::UnitZ(), .h_c = 0.1}, axes);
  EXPECT_DOUBLE_EQ(found.max_u - found.min_u, 6.0);
  EXPECT_DOUBLE_EQ(found.max_v - found.min_v, 2.0);
  EXPECT_NEAR(found.area, 12.0, 1e-14);
  for (const double level : {-3.0, 3.0}) {
    const Waterline none = waterline(mesh, WaterPlane{.up_B = Vec3::UnitZ(), .h_c = level}, axes);
    EXPECT_EQ(none.area, 0.0);
    EXPECT_GT(none.min_u, none.max_u);
  }
}

}  // namespace
}  // namespace buoyancy
