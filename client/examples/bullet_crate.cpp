// Example of a simulator that uses buoyancyd: Bullet moves a crate, buoyancyd computes the buoyancy.
//
//   buoyancyd --scene scenes/box.toml &
//   bullet_crate [LCM URL [STEP [RETRIES]]]
//
// This example uses Bullet in double precision (package libbullet-dev, pkg-config bullet-float64): in single
// precision the height of a body 1 km from the origin is known to 0.1 mm only.
#include <btBulletDynamicsCommon.h>

#include "client/examples/crate.h"

namespace {

btVector3 to_bullet(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

// A Bullet world without a ground and without Bullet's own damping.
class World {
 public:
  World() {
    dynamics_.setGravity(btVector3(0, 0, -crate::kGravity));
    body_.setActivationState(DISABLE_DEACTIVATION);  // a sleeping body would ignore the water
    dynamics_.addRigidBody(&body_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() { dynamics_.removeRigidBody(&body_); }

  // Bullet's body origin is the centre of mass. The scene sets no reference_point, so the service uses the
  // mesh's origin; here the two coincide. Otherwise set reference_point to the centre of mass, and send the
  // pose of the mesh's origin.
  buoyancy::BodyState state() const {
    const btVector3& p = body_.getWorldTransform().getOrigin();
    const btQuaternion q = body_.getWorldTransform().getRotation();
    return {.body_id = crate::kBodyId,
            .position = {p.x(), p.y(), p.z()},
            .quaternion_wxyz = {q.w(), q.x(), q.y(), q.z()},
            .linear_velocity = {},  // used only with a lead_time
            .angular_velocity = {}};
  }

  void step_with(const buoyancy::BodyWrench& water, double step) {
    body_.applyCentralForce(to_bullet(water.force) - crate::kLinearDamping * body_.getLinearVelocity());
    body_.applyTorque(to_bullet(water.torque) - crate::kAngularDamping * body_.getAngularVelocity());
    // 0 sub-steps: Bullet makes exactly this step. With sub-steps it would use one wrench several times.
    dynamics_.stepSimulation(step, 0);
  }

  double height() const { return body_.getWorldTransform().getOrigin().z(); }
  double tilt_cosine() const { return body_.getWorldTransform().getBasis()[2].z(); }

 private:
  static btRigidBody::btRigidBodyConstructionInfo construction(btBoxShape& shape) {
    btVector3 inertia;
    shape.calculateLocalInertia(crate::kMass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(crate::kMass, nullptr, &shape, inertia);
    const auto& [w, x, y, z] = crate::kInitialOrientation;
    info.m_startWorldTransform.setRotation(btQuaternion(x, y, z, w).normalized());
    info.m_startWorldTransform.setOrigin(
        btVector3(crate::kInitialPosition[0], crate::kInitialPosition[1], crate::kInitialPosition[2]));
    return info;
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld dynamics_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btBoxShape shape_{0.5 * btVector3(crate::kSize[0], crate::kSize[1], crate::kSize[2])};
  btRigidBody body_{construction(shape_)};
};

}  // namespace

int main(int argc, char** argv) {
  World world;
  return crate::float_crate(world, crate::Arguments(argc, argv));
}
