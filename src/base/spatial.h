// Six-dimensional vectors and matrices of rigid-body mechanics: linear part first, angular part second.
//
// A twist is (velocity of a point, angular velocity), a wrench (force, torque about a point). A matrix that
// maps twists to wrenches, such as an added mass or a damping, belongs to a point and to axes.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "base/vec3.h"

namespace buoyancy {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// Returns the matrix of a cross product: cross_matrix(a) * b = a x b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 matrix;
  matrix << 0.0, -a.z(), a.y(),  //
      a.z(), 0.0, -a.x(),        //
      -a.y(), a.x(), 0.0;
  return matrix;
}

// Returns the twist at another point of the rigid body. offset: [m], from the twist's point to the other.
inline Vec6 twist_at(const Vec6& twist, const Vec3& offset) {
  Vec6 moved = twist;
  moved.head<3>() += twist.tail<3>().cross(offset);
  return moved;
}

// Returns the wrench about another point. offset: [m], from the wrench's point to the other.
inline Vec6 wrench_about(const Vec6& wrench, const Vec3& offset) {
  Vec6 moved = wrench;
  moved.tail<3>() += wrench.head<3>().cross(offset);
  return moved;
}

// Returns a matrix from twists to wrenches, moved to another point. offset: [m], from the matrix's point to
// the other.
Mat6 matrix_at(const Mat6& matrix, const Vec3& offset);

// Returns a matrix from twists to wrenches, given in axes B, in axes W.
Mat6 rotated(const Mat6& matrix, const Mat3& R_WB);

// Returns the skew-symmetric Coriolis and centripetal matrix C of a symmetric mass matrix. With the momentum
// (p, l) = mass * twist and twist = (v, w), C twist = (w x p, v x p + w x l). Kirchhoff's equations are
// mass * dtwist/dt + C twist = wrench, in axes that turn with the body (T. I. Fossen, Handbook of Marine
// Craft Hydrodynamics and Motion Control, section 6.3).
Mat6 coriolis_matrix(const Mat6& mass, const Vec6& twist);

// Returns the derivative of coriolis_matrix(mass, twist) * twist with respect to the twist.
Mat6 coriolis_derivative(const Mat6& mass, const Vec6& twist);

}  // namespace buoyancy
