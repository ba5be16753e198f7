#include "client/coupled_load.h"

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

TEST(CoupledLoad, TakesMatricesAndMotionFromMessages) {
  BodyState state;
  state.quaternion_wxyz = {0.0, 0.0, 0.0, 2.0};  // half a turn about z
  state.linear_velocity = {1, 2, 3};
  state.angular_velocity = {4, 5, 6};
  BodyLoads loads;
  loads.added_mass[1][4] = 7.0;
  loads.damping[5][0] = 8.0;
  const CoupledBody body = coupled_body({}, {0, 0, 9}, state, loads);
  EXPECT_TRUE(body.motion.R_WB.isApprox(Vec3(-1, -1, 1).asDiagonal().toDenseMatrix()));
  EXPECT_EQ(body.motion.velocity_W, Vec3(1, 2, 3));
  EXPECT_EQ(body.motion.angular_velocity_W, Vec3(4, 5, 6));
  EXPECT_EQ(body.reference_B.z(), 9.0);
  EXPECT_EQ(body.water.added_mass_W(1, 4), 7.0);
  EXPECT_EQ(body.water.damping_W(5, 0), 8.0);

  BodyWrench wrench;
  wrench.force = {1, 2, 3};
  wrench.torque = {4, 5, 6};
  EXPECT_EQ(wrench_of(wrench), (Vec6() << 1, 2, 3, 4, 5, 6).finished());
}

}  // namespace
}  // namespace buoyancy
