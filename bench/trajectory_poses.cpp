#include "trajectory_poses.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hydrostatics/buoyancy.h"
#include "unit_water.h"

namespace buoyancy::bench {
namespace {

// Pose with the centroid at centroid_W.
Pose pose_about_centroid(const HydrostaticMesh& mesh, const Eigen::Quaterniond& q_WB,
                         const Vec3& centroid_W) {
  return {centroid_W - q_WB * (mesh.center_B + mesh.centroid), q_WB};
}

// Pose of this attitude with half of the volume submerged.
Pose half_submerged(const Solver& solver, const Eigen::Quaterniond& q_WB) {
  const HydrostaticMesh& mesh = solver.mesh();
  double low = -mesh.diagonal;  // height of the centroid at which the body is fully submerged
  double high = mesh.diagonal;  // height of the centroid at which the body is dry
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    const Pose pose = pose_about_centroid(mesh, q_WB, {0, 0, middle});
    const bool too_deep = buoyancy(solver, pose, kUnitWater, Vec3::Zero()).volume > 0.5 * mesh.volume;
    (too_deep ? low : high) = middle;
  }
  return pose_about_centroid(mesh, q_WB, {0, 0, low});
}

}  // namespace

Pose floating_pose(const Solver& solver) {
  const HydrostaticMesh& mesh = solver.mesh();
  const Vec3 centroid_B = mesh.center_B + mesh.centroid;
  const auto torque = [&](const Pose& p) { return buoyancy(solver, p, kUnitWater, centroid_B).torque_W; };
  // Step size of the rotation: initially for a metacentric height of L/5, then for the stiffness along the
  // last step (Barzilai-Borwein).
  double angle_per_torque = 5.0 / (mesh.volume * mesh.diagonal);
  Pose pose = half_submerged(solver, Eigen::Quaterniond::Identity());
  Vec3 torque_W = torque(pose);
  for (int i = 0; i < 200 && torque_W.norm() > 1e-9 * mesh.volume * mesh.diagonal; ++i) {
    const double angle = std::min(angle_per_torque * torque_W.norm(), 0.3);
    const Vec3 turn_W = angle * torque_W.normalized();
    const Eigen::AngleAxisd turn(angle, torque_W.normalized());
    pose = half_submerged(solver, (turn * pose.q_WB).normalized());
    const Vec3 before_W = torque_W;
    torque_W = torque(pose);
    const double torque_drop = turn_W.dot(before_W - torque_W);
    if (torque_drop > 0.0) angle_per_torque = angle * angle / torque_drop;
  }
  return pose;
}

std::vector<Pose> coherent_poses(const HydrostaticMesh& mesh, const Pose& floating, int count) {
  const double phase_step = 2.0 * std::numbers::pi / count;
  const double amplitude = kCoherentStep / (2.0 * std::sin(0.5 * phase_step));  // [L] and [rad]
  const Vec3 rest_W = floating.p_WB + floating.q_WB * (mesh.center_B + mesh.centroid);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const double phase = phase_step * i;
    const Vec3 circle_W = Vec3(std::cos(phase), 0.0, std::sin(phase));
    const Eigen::AngleAxisd tilt(amplitude, Vec3(std::cos(phase), std::sin(phase), 0.0));
    poses.push_back(pose_about_centroid(mesh, (tilt * floating.q_WB).normalized(),
                                        rest_W + amplitude * mesh.diagonal * circle_W));
  }
  return poses;
}

}  // namespace buoyancy::bench
