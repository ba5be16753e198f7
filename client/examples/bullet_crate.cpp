// Example of a simulator that uses buoyancyd: Bullet moves a crate, buoyancyd computes the buoyancy.
//
//   buoyancyd --scene scenes/box.toml &
//   bullet_crate [--loads] [LCM URL [STEP [RETRIES [HEIGHT]]]]
//
// With scenes/crate.toml and --loads, drag and added mass come from the service as well. Bullet's bodies have
// a scalar mass, so that added mass enters by way of a compensated wrench (client/coupled_load.h). That is
// exact as long as nothing touches the crate.
//
// This example uses Bullet in double precision (package libbullet-dev, pkg-config bullet-float64): in single
// precision the height of a body 1 km from the origin is known to 0.1 mm only.
#include <btBulletDynamicsCommon.h>

#include "client/examples/crate.h"

namespace {

btVector3 to_bullet(const buoyancy::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

std::array<double, 3> to_array(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

// A Bullet world without a ground and without Bullet's own damping.
class World {
 public:
  explicit World(const crate::Start& start) : body_(construction(shape_, start)) {
    // The compensated wrench contains the weight: Bullet's gravity would ignore the added mass.
    dynamics_.setGravity(btVector3(0, 0, 0));
    body_.setActivationState(DISABLE_DEACTIVATION);  // a sleeping body would ignore the water
    dynamics_.addRigidBody(&body_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() { dynamics_.removeRigidBody(&body_); }

  // Bullet's body origin is the centre of mass. The scene sets no reference_point, so the service uses the
  // mesh's origin; here the two coincide. Otherwise set reference_point to the centre of mass, and send the
  // pose and the velocity of the mesh's origin.
  buoyancy::BodyState state() const {
    const btVector3& p = body_.getWorldTransform().getOrigin();
    const btQuaternion q = body_.getWorldTransform().getRotation();
    return {.body_id = crate::kBodyId,
            .position = to_array(p),
            .quaternion_wxyz = {q.w(), q.x(), q.y(), q.z()},
            .linear_velocity = to_array(body_.getLinearVelocity()),
            .angular_velocity = to_array(body_.getAngularVelocity())};
  }

  void step_with(const buoyancy::Vec6& wrench_W, double step) {
    body_.applyCentralForce(to_bullet(wrench_W.head<3>()));
    body_.applyTorque(to_bullet(wrench_W.tail<3>()));
    // 0 sub-steps: Bullet makes exactly this step. With sub-steps it would use one wrench several times.
    dynamics_.stepSimulation(step, 0);
  }

  double height() const { return body_.getWorldTransform().getOrigin().z(); }
  double tilt_cosine() const { return body_.getWorldTransform().getBasis()[2].z(); }

 private:
  static btRigidBody::btRigidBodyConstructionInfo construction(btBoxShape& shape, const crate::Start& start) {
    btVector3 inertia;
    shape.calculateLocalInertia(crate::kMass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(crate::kMass, nullptr, &shape, inertia);
    const auto& [w, x, y, z] = start.orientation;
    info.m_startWorldTransform.setRotation(btQuaternion(x, y, z, w).normalized());
    info.m_startWorldTransform.setOrigin(btVector3(start.position[0], start.position[1], start.position[2]));
    return info;
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld dynamics_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btBoxShape shape_{0.5 * btVector3(crate::kSize[0], crate::kSize[1], crate::kSize[2])};
  btRigidBody body_;
};

}  // namespace

int main(int argc, char** argv) {
  const crate::Arguments arguments(argc, argv);
  World world(arguments.start());
  return crate::float_crate(world, arguments);
}
