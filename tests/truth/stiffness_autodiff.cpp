#include "tests/truth/stiffness_autodiff.h"

#include <algorithm>
#include <limits>

#include "hydrostatics/displacement_moments.h"
#include "tests/truth/wetted_moments_reference.h"

namespace buoyancy {

DualPlane dual_water_plane(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                           const Vec3& reference_B) {
  using DualVec = Vec3T<Dual>;
  const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
  const DualVec up_W = water.up_W.cast<Dual>();
  DualPlane dual;
  dual.c_from_r = (mesh.center_B - reference_B).cast<Dual>();
  DualVec p;
  DualVec theta;
  for (std::size_t i = 0; i < 3; ++i) {
    p(static_cast<Eigen::Index>(i)) = Dual::parameter(i);
    theta(static_cast<Eigen::Index>(i)) = Dual::parameter(3 + i);
  }
  // The body rotated by theta has R = (1 + [theta] + ..) R_WB; a point y about c is at
  // p_r + p + R (y + c - r), so that k = R^T up and h_c = level - up . (p_r + p) - k . (c - r).
  Mat3T<Dual> turn = Mat3T<Dual>::Constant(Dual(0.0));
  turn.diagonal().setConstant(Dual(1.0));
  dual.R_WB = (turn + cross_matrix(theta)) * pose.q_WB.toRotationMatrix().cast<Dual>();
  dual.up_B = dual.R_WB.transpose() * up_W;
  for (int i = 0; i < 3; ++i) dual.up_B(i).value = plane.up_B(i);
  dual.h_c = -(up_W.dot(p) + dual.up_B.dot(dual.c_from_r));
  dual.h_c.value = plane.h_c;  // the value that cancellation spoils in the sum above
  return dual;
}

Mat6 stiffness_autodiff(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                        const Vec3& reference_B) {
  using DualVec = Vec3T<Dual>;
  const DualPlane plane = dual_water_plane(mesh, pose, water, reference_B);
  const auto displaced = displacement_moments<Dual>(
      wetted_moments_reference<Dual>(mesh.surface, plane.up_B, plane.h_c), -plane.h_c, plane.up_B);
  const DualVec force_B = displaced.volume * plane.up_B;
  const DualVec torque_B = displaced.moment.cross(plane.up_B) + plane.c_from_r.cross(force_B);
  const Dual weight(water.density * water.gravity);
  const DualVec force_W = weight * (plane.R_WB * force_B);
  const DualVec torque_W = weight * (plane.R_WB * torque_B);
  Mat6 result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 6; ++column) {
      result(row, column) = -force_W(row).slope[static_cast<std::size_t>(column)];
      result(row + 3, column) = -torque_W(row).slope[static_cast<std::size_t>(column)];
    }
  }
  return result;
}

double max_difference(const Mat6& found, const Mat6& expected, bool waterplane) {
  double max = 0.0;
  for (const int row : {0, 3}) {
    for (const int column : {0, 3}) {
      if (!waterplane && row + column < 6) continue;
      const Mat3 truth = expected.block<3, 3>(row, column);
      const double difference = (found.block<3, 3>(row, column) - truth).norm();
      if (difference > 0.0) max = std::max(max, difference / truth.norm());
    }
  }
  return max;
}

double stiffness_tolerance(const HydrostaticMesh& mesh, double waterplane_area) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  return waterplane_area > 0.0 ? std::max(1e-9, 32.0 * kEpsilon * mesh.area / waterplane_area) : 1e-9;
}

}  // namespace buoyancy
