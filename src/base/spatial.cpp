#include "base/spatial.h"

namespace buoyancy {

Mat6 matrix_at(const Mat6& matrix, const Vec3& offset) {
  // With the matrix x and the twist (v, w) at the new point, the twist at the old point is (v + x w, w), and
  // the torque about the new point is tau - x F. Products of 6 x 6 matrices would take long to compile.
  const Mat3 x = cross_matrix(offset);
  const Mat3 force_v = matrix.topLeftCorner<3, 3>();
  const Mat3 torque_v = matrix.bottomLeftCorner<3, 3>();
  const Mat3 force_w = matrix.topRightCorner<3, 3>() + force_v * x;
  const Mat3 torque_w = matrix.bottomRightCorner<3, 3>() + torque_v * x;
  Mat6 moved;
  moved.topLeftCorner<3, 3>() = force_v;
  moved.topRightCorner<3, 3>() = force_w;
  moved.bottomLeftCorner<3, 3>() = torque_v - x * force_v;
  moved.bottomRightCorner<3, 3>() = torque_w - x * force_w;
  return moved;
}

Mat6 rotated(const Mat6& matrix, const Mat3& R_WB) {
  Mat6 turned;
  for (const Eigen::Index row : {0, 3}) {
    for (const Eigen::Index column : {0, 3}) {
      turned.block<3, 3>(row, column) = R_WB * matrix.block<3, 3>(row, column) * R_WB.transpose();
    }
  }
  return turned;
}

Mat6 coriolis_matrix(const Mat6& mass, const Vec6& twist) {
  const Vec6 momentum = mass * twist;
  const Mat3 p = cross_matrix(momentum.head<3>());
  Mat6 coriolis;
  coriolis.topLeftCorner<3, 3>().setZero();
  coriolis.topRightCorner<3, 3>() = -p;
  coriolis.bottomLeftCorner<3, 3>() = -p;
  coriolis.bottomRightCorner<3, 3>() = -cross_matrix(momentum.tail<3>());
  return coriolis;
}

Mat6 coriolis_derivative(const Mat6& mass, const Vec6& twist) {
  // By the product rule, the twist varies at fixed momentum, and the momentum at fixed twist.
  const Mat3 v = cross_matrix(twist.head<3>());
  const Mat3 w = cross_matrix(twist.tail<3>());
  Mat6 derivative = coriolis_matrix(mass, twist);
  derivative.topRows<3>() += w * mass.topRows<3>();
  derivative.bottomRows<3>() += v * mass.topRows<3>() + w * mass.bottomRows<3>();
  return derivative;
}

}  // namespace buoyancy
