#include "hydrodynamics/coupled_mass.h"

#include "hydrodynamics/linear_algebra.h"

namespace buoyancy {
namespace {

// From the reference point to the centre of mass, in W's axes.
Vec3 lever_to_center_W(const CoupledBody& body) {
  return body.motion.R_WB * (body.mass.center_of_mass_B - body.reference_B);
}

Mat3 inertia_W(const RigidBodyMass& mass, const Mat3& R_WB) {
  return R_WB * mass.inertia_B * R_WB.transpose();
}

// The rigid-body term about the centre of mass.
Vec3 gyroscopic_torque(const Mat3& inertia, const Vec3& w) {
  return w.cross(inertia * w);
}

// Returns the acceleration of the centre of mass and the angular acceleration.
Vec6 acceleration_of_center(const CoupledBody& body, const Vec6& wrench_W, double step) {
  const Vec3 lever = lever_to_center_W(body);
  const Mat3& R_WB = body.motion.R_WB;
  const Vec3& w = body.motion.angular_velocity_W;
  const Vec3 v = body.motion.velocity_W + w.cross(R_WB * body.mass.center_of_mass_B);
  const Mat3 inertia = inertia_W(body.mass, R_WB);
  const Mat6 added = matrix_at(body.water.added_mass_W, lever);

  Vec6 right = wrench_about(wrench_W, lever) + added.leftCols<3>() * w.cross(v);
  right.tail<3>() -= gyroscopic_torque(inertia, w);
  Mat6 left = added;
  left.diagonal().head<3>().array() += body.mass.mass;
  left.bottomRightCorner<3, 3>() += inertia;
  if (step > 0.0) {
    Mat6 damping = matrix_at(body.water.damping_W, lever);
    const Mat3 w_cross = cross_matrix(w);
    damping.leftCols<3>() -= added.leftCols<3>() * w_cross;
    damping.rightCols<3>() += added.leftCols<3>() * cross_matrix(v);
    damping.bottomRightCorner<3, 3>() += w_cross * inertia - cross_matrix(inertia * w);
    left += step * damping;
  }
  return solve(left, right);
}

}  // namespace

Mat6 mass_matrix_W(const RigidBodyMass& mass, const Mat3& R_WB, const Vec3& point_B) {
  Mat6 matrix = Mat6::Zero();
  matrix.diagonal().head<3>().setConstant(mass.mass);
  matrix.bottomRightCorner<3, 3>() = inertia_W(mass, R_WB);
  return matrix_at(matrix, R_WB * (point_B - mass.center_of_mass_B));
}

Vec6 weight_W(const CoupledBody& body, const Vec3& gravity_W) {
  Vec6 weight;
  weight.head<3>() = body.mass.mass * gravity_W;
  weight.tail<3>() = lever_to_center_W(body).cross(weight.head<3>());
  return weight;
}

Vec6 coupled_acceleration(const CoupledBody& body, const Vec6& wrench_W, double step) {
  // The acceleration of another point differs by alpha x d + w x (w x d). Over an implicit step, the second
  // term is taken at the step's start.
  const Vec3& w = body.motion.angular_velocity_W;
  const Vec3 to_reference = -lever_to_center_W(body);
  Vec6 acceleration = twist_at(acceleration_of_center(body, wrench_W, step), to_reference);
  acceleration.head<3>() += w.cross(w.cross(to_reference));
  return acceleration;
}

Vec6 compensated_wrench(const CoupledBody& body, const Vec6& wrench_W, double step) {
  const Vec6 acceleration = acceleration_of_center(body, wrench_W, step);
  const Mat3 inertia = inertia_W(body.mass, body.motion.R_WB);
  Vec6 wrench;
  wrench.head<3>() = body.mass.mass * acceleration.head<3>();
  wrench.tail<3>() =
      inertia * acceleration.tail<3>() + gyroscopic_torque(inertia, body.motion.angular_velocity_W);
  return wrench;
}

}  // namespace buoyancy
