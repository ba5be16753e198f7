#include "flotation/displaced_parts.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/flotation/bodies.h"

namespace buoyancy {
namespace {

TEST(DisplacedParts, AddUpToTheBody) {
  const HydrostaticMesh pontoon = mesh_of(BoxShape{{10, 2, 2}, {2, 2, 2}});
  const HydrostaticMesh flooded = mesh_of(BoxShape{{1, 1, 1}, {1, 1, 1}});
  const HydrostaticMesh bridge = mesh_of(BoxShape{{4, 4, 0.5}, {1, 1, 1}});
  const std::vector<PlacedMesh> meshes{
      {.mesh = &pontoon, .position_B = Vec3(0, 3, 0)},
      {.mesh = &pontoon, .position_B = Vec3(0, -3, 0)},
      {.mesh = &bridge, .position_B = Vec3(0, 0, 2)},
      {.mesh = &flooded, .position_B = Vec3(2, 3, -0.5), .signed_permeability = -0.5}};
  const FloatingBody body = FloatingBody::make(meshes, 1000.0, Vec3::Zero()).value();
  Pose pose;
  pose.p_WB = Vec3(7, -2, 0.25);
  const Water water;
  const std::vector<DisplacedPart> parts = displaced_parts(body, pose, water);
  ASSERT_EQ(parts.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(parts[i].volume, 10.0 * 2.0 * 0.75, 1e-12);
    EXPECT_LT((parts[i].center_B - Vec3(0, i == 0 ? 3 : -3, -0.625)).norm(), 1e-12);
  }
  EXPECT_EQ(parts[2].volume, 0.0);
  EXPECT_TRUE(parts[2].center_B.hasNaN());
  EXPECT_NEAR(parts[3].volume, -0.5 * 0.75, 1e-12);
  EXPECT_LT((parts[3].center_B - Vec3(2, 3, -0.625)).norm(), 1e-12);

  pose.q_WB = Eigen::Quaterniond(0.9, 0.2, -0.1, 0.3).normalized();
  double sum = 0.0;
  for (const DisplacedPart& part : displaced_parts(body, pose, water)) sum += part.volume;
  EXPECT_NEAR(sum, floating_state(body, pose, water)->hydrostatics.volume, 1e-12);
}

}  // namespace
}  // namespace buoyancy
