#include "simulation/rigid_body.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>

#include "messages/conversions.h"
#include "tests/simulation/in_process_run.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

// A box of 1 x 2 x 3 m. client: the lines of its [body.client].
Scene box_with(const std::string& client) {
  return scene_of(
      "[water]\ndensity = 1000\nlevel = 2\n[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 2, 3] }\n"
      "reference_point = [0.5, -1, 0.25]\n[body.client]\n" +
      client);
}

RigidBody rigid_body_of(const Scene& scene) {
  const Expected<RigidBody> rigid = make_rigid_body(scene.bodies().front(), scene.water());
  if (!rigid) throw std::runtime_error(rigid.error().message());
  return *rigid;
}

Mat3 inertia_B(const RigidBody& body) {
  return body.principal_axes_B * body.principal_inertia.asDiagonal() * body.principal_axes_B.transpose();
}

TEST(RigidBody, DerivesMassPropertiesFromMesh) {
  const RigidBody body = rigid_body_of(box_with("density = 500\n"));
  EXPECT_NEAR(body.mass, 3000.0, 1e-9);
  EXPECT_LT(body.center_of_mass_B.norm(), 1e-15);
  const Mat3 expected = Vec3(4 + 9, 1 + 9, 1 + 4).asDiagonal() * (3000.0 / 12.0);
  EXPECT_LT((inertia_B(body) - expected).norm(), 1e-8);
  EXPECT_NEAR(body.principal_inertia[0], 1250.0, 1e-9);
}

TEST(RigidBody, DefaultsToHalfTheWaterDensity) {
  EXPECT_NEAR(rigid_body_of(box_with("")).mass, 3000.0, 1e-9);
}

TEST(RigidBody, UsesGivenMassProperties) {
  const RigidBody body = rigid_body_of(
      box_with("mass = 10\ncenter_of_mass = [0.1, 0.2, 0.3]\ninertia = [3, 4, 5, 0.1, 0.2, 0.3]\n"));
  EXPECT_EQ(body.mass, 10.0);
  EXPECT_EQ(body.center_of_mass_B, Vec3(0.1, 0.2, 0.3));
  Mat3 expected;
  expected << 3, 0.1, 0.2, 0.1, 4, 0.3, 0.2, 0.3, 5;
  EXPECT_LT((inertia_B(body) - expected).norm(), 1e-14);
}

TEST(RigidBody, ScalesMeshInertiaToGivenMass) {
  const RigidBody body = rigid_body_of(box_with("mass = 12\n"));
  EXPECT_NEAR(body.principal_inertia[2], 13.0, 1e-12);
}

TEST(RigidBody, ConvertsStateToAndFromBodyOrigin) {
  const Scene scene = box_with(
      "center_of_mass = [0.1, -0.4, 0.7]\ninertia = [3, 4, 5, 0.1, 0.2, 0.3]\nposition = [5, 6, 7]\n"
      "orientation = [0.5, 0.5, -0.5, 0.5]\nlinear_velocity = [1, 2, 3]\nangular_velocity = [-0.3, 0.2, "
      "0.9]\n");
  const RigidBody body = rigid_body_of(scene);
  const RigidBodyState state = initial_state(body, scene.bodies().front().dynamics);
  const Vec3 center_from_origin_W = state.q_WB * body.center_of_mass_B;
  EXPECT_LT((state.center_W - Vec3(5, 6, 7) - center_from_origin_W).norm(), 1e-14);
  EXPECT_LT((state.velocity_W - Vec3(1, 2, 3) - Vec3(-0.3, 0.2, 0.9).cross(center_from_origin_W)).norm(),
            1e-14);

  const BodyState message = to_body_state(42, body, state);
  EXPECT_EQ(message.body_id, 42);
  EXPECT_LT((to_vec3(message.position) - Vec3(5, 6, 7)).norm(), 1e-14);
  EXPECT_LT((to_vec3(message.linear_velocity) - Vec3(1, 2, 3)).norm(), 1e-14);
  EXPECT_LT((to_vec3(message.angular_velocity) - Vec3(-0.3, 0.2, 0.9)).norm(), 1e-14);
  EXPECT_EQ(message.quaternion_wxyz, (std::array{0.5, 0.5, -0.5, 0.5}));
}

TEST(RigidBody, TransfersTorqueToCentreOfMass) {
  const Scene scene = box_with("center_of_mass = [0.1, -0.4, 0.7]\n");
  const RigidBody body = rigid_body_of(scene);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  const auto random_vector = [&] { return Vec3{uniform(random), uniform(random), uniform(random)}; };
  for (int i = 0; i < 100; ++i) {
    RigidBodyState state;
    state.center_W = random_vector();
    state.q_WB = Eigen::Quaterniond{uniform(random), uniform(random), uniform(random), uniform(random)};
    state.q_WB.normalize();
    const Pose pose = pose_of(body, state);
    const Vec3 reference_W = pose.p_WB + pose.q_WB * body.reference_B;
    // A force with its point of application.
    const Vec3 force_W = random_vector();
    const Vec3 point_W = random_vector();
    BodyWrench wrench;
    wrench.force = to_array(force_W);
    wrench.torque = to_array((point_W - reference_W).cross(force_W));

    const Load load = total_load(body, state, wrench, scene.water());
    EXPECT_LT((load.torque_W - (point_W - state.center_W).cross(force_W)).norm(), 1e-13);
    EXPECT_LT((load.force_W - force_W + Vec3(0, 0, body.mass * kStandardGravity)).norm(), 1e-9);
  }
}

TEST(RigidBody, ComputesKineticEnergy) {
  RigidBody body = rigid_body_of(box_with("mass = 12\n"));
  RigidBodyState state;
  state.velocity_W = {3, 0, 4};
  EXPECT_DOUBLE_EQ(kinetic_energy(body, state), 0.5 * 12 * 25);
  state.velocity_W = Vec3::Zero();
  state.angular_momentum_W = {0, 0, 5.0 * 2.0};  // I_zz = 5, w = 2
  EXPECT_NEAR(kinetic_energy(body, state), 0.5 * 5.0 * 4.0, 1e-12);
}

TEST(RigidBody, RejectsZeroMass) {
  Scene scene =
      scene_of("[water]\ndensity = 0\n[[body]]\nid = 3\nshape = { type = \"box\" }\n[body.client]\n");
  const Expected<RigidBody> rigid = make_rigid_body(scene.bodies().front(), scene.water());
  ASSERT_FALSE(rigid);
  EXPECT_THAT(rigid.error().message(), HasSubstr("body 3"));
}

}  // namespace
}  // namespace buoyancy
