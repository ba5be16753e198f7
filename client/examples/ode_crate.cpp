// The crate of bullet_crate.cpp in another engine, ODE (package libode-dev, in double precision): only the
// code that reads a pose and applies a wrench differs.
//
//   buoyancyd --scene scenes/box.toml &
//   ode_crate [--loads] [LCM URL [STEP [RETRIES [HEIGHT]]]]
#include <ode/ode.h>

#include "client/examples/crate.h"

static_assert(sizeof(dReal) == sizeof(double), "single-precision ODE stores poses with 7 digits only");

namespace {

class World {
 public:
  explicit World(const crate::Start& start) {
    dInitODE();
    world_ = dWorldCreate();  // without gravity: the compensated wrench contains the weight
    body_ = dBodyCreate(world_);
    dMass mass;
    dMassSetBoxTotal(&mass, crate::kMass, crate::kSize[0], crate::kSize[1], crate::kSize[2]);
    dBodySetMass(body_, &mass);
    dBodySetPosition(body_, start.position[0], start.position[1], start.position[2]);
    const auto& [w, x, y, z] = start.orientation;
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
    const dReal* v = dBodyGetLinearVel(body_);
    const dReal* w = dBodyGetAngularVel(body_);
    return {.body_id = crate::kBodyId,
            .position = {p[0], p[1], p[2]},
            .quaternion_wxyz = {q[0], q[1], q[2], q[3]},
            .linear_velocity = {v[0], v[1], v[2]},
            .angular_velocity = {w[0], w[1], w[2]}};
  }

  void step_with(const buoyancy::Vec6& wrench_W, double step) {
    dBodyAddForce(body_, wrench_W[0], wrench_W[1], wrench_W[2]);
    dBodyAddTorque(body_, wrench_W[3], wrench_W[4], wrench_W[5]);
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
  const crate::Arguments arguments(argc, argv);
  World world(arguments.start());
  return crate::float_crate(world, arguments);
}
