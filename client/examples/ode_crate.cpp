// The crate of bullet_crate.cpp in another engine, ODE (package libode-dev, in double precision): only the
// code that reads a pose and applies a wrench differs.
//
//   buoyancyd --scene scenes/box.toml &
//   ode_crate [LCM URL [STEP [RETRIES]]]
#include <ode/ode.h>

#include "client/examples/crate.h"

static_assert(sizeof(dReal) == sizeof(double), "single-precision ODE stores poses with 7 digits only");

namespace {

class World {
 public:
  World() {
    dInitODE();
    world_ = dWorldCreate();
    dWorldSetGravity(world_, 0, 0, -crate::kGravity);
    body_ = dBodyCreate(world_);
    dMass mass;
    dMassSetBoxTotal(&mass, crate::kMass, crate::kSize[0], crate::kSize[1], crate::kSize[2]);
    dBodySetMass(body_, &mass);
    dBodySetPosition(body_, crate::kInitialPosition[0], crate::kInitialPosition[1],
                     crate::kInitialPosition[2]);
    const auto& [w, x, y, z] = crate::kInitialOrientation;
    dQuaternion orientation{w, x, y, z};
    dSafeNormalize4(orientation);
    dBodySetQuaternion(body_, orientation);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    dWorldDestroy(world_);
    dCloseODE();
  }

  // ODE's body origin is the centre of mass; bullet_crate.cpp explains what to do if the mesh's origin
  // differs.
  buoyancy::BodyState state() const {
    const dReal* p = dBodyGetPosition(body_);
    const dReal* q = dBodyGetQuaternion(body_);
    return {.body_id = crate::kBodyId,
            .position = {p[0], p[1], p[2]},
            .quaternion_wxyz = {q[0], q[1], q[2], q[3]},
            .linear_velocity = {},  // used only with a lead_time
            .angular_velocity = {}};
  }

  void step_with(const buoyancy::BodyWrench& water, double step) {
    const dReal* v = dBodyGetLinearVel(body_);
    const dReal* w = dBodyGetAngularVel(body_);
    dBodyAddForce(body_, water.force[0] - crate::kLinearDamping * v[0],
                  water.force[1] - crate::kLinearDamping * v[1],
                  water.force[2] - crate::kLinearDamping * v[2]);
    dBodyAddTorque(body_, water.torque[0] - crate::kAngularDamping * w[0],
                   water.torque[1] - crate::kAngularDamping * w[1],
                   water.torque[2] - crate::kAngularDamping * w[2]);
    dWorldStep(world_, step);
  }

  double height() const { return dBodyGetPosition(body_)[2]; }
  double tilt_cosine() const { return dBodyGetRotation(body_)[10]; }  // row 2, column 2; rows have 4 entries

 private:
  dWorldID world_;
  dBodyID body_;
};

}  // namespace

int main(int argc, char** argv) {
  World world;
  return crate::float_crate(world, crate::Arguments(argc, argv));
}
