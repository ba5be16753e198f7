// Bullet moves a crate, buoyancyd tells it how the water pushes.
//
//   buoyancyd --scene scenes/box.toml &
//   bullet_crate [LCM URL [STEP [RETRIES]]]
//
// Bullet calculates with 64 bits here (package libbullet-dev, pkg-config bullet-float64): with 32 a body 1 km
// from the origin would know its height to 0.1 mm only.
#include <btBulletDynamicsCommon.h>

#include "client/examples/crate.h"

namespace {

btVector3 as_bullet(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

// Bullet's world, without a ground and without its own damping.
class World {
 public:
  World() {
    dynamics_.setGravity(btVector3(0, 0, -crate::kGravity));
    body_.setActivationState(DISABLE_DEACTIVATION);  // put to sleep it would not feel the water
    dynamics_.addRigidBody(&body_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() { dynamics_.removeRigidBody(&body_); }

  // Bullet's origin of a body is its centre of mass. The scene gives no reference_point, so the service means
  // the mesh's origin: here they are one. Otherwise set reference_point to the centre of mass, and send the
  // pose of the mesh's origin.
  buoyancy::BodyState state() const {
    const btVector3& p = body_.getWorldTransform().getOrigin();
    const btQuaternion q = body_.getWorldTransform().getRotation();
    return {.body_id = crate::kBodyId,
            .position = {p.x(), p.y(), p.z()},
            .quaternion_wxyz = {q.w(), q.x(), q.y(), q.z()},
            .linear_velocity = {},  // read only with a lead_time
            .angular_velocity = {}};
  }

  void step_with(const buoyancy::BodyWrench& water, double step) {
    body_.applyCentralForce(as_bullet(water.force) - crate::kLinearDamping * body_.getLinearVelocity());
    body_.applyTorque(as_bullet(water.torque) - crate::kAngularDamping * body_.getAngularVelocity());
    // 0 sub-steps: exactly this step. With sub-steps Bullet would move the body several times on one wrench.
    dynamics_.stepSimulation(step, 0);
  }

  double height() const { return body_.getWorldTransform().getOrigin().z(); }
  double tilt_cosine() const { return body_.getWorldTransform().getBasis()[2].z(); }

 private:
  static btRigidBody::btRigidBodyConstructionInfo construction(btBoxShape& shape) {
    btVector3 inertia;
    shape.calculateLocalInertia(crate::kMass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(crate::kMass, nullptr, &shape, inertia);
    const auto& [w, x, y, z] = crate::kTurned;
    info.m_startWorldTransform.setRotation(btQuaternion(x, y, z, w).normalized());
    info.m_startWorldTransform.setOrigin(btVector3(crate::kStart[0], crate::kStart[1], crate::kStart[2]));
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
