// Random matrices and vectors for tests of hydrodynamic loads.
#pragma once

#include <random>

#include "base/spatial.h"

namespace buoyancy {

inline double random_number(std::mt19937& random) {
  return std::uniform_real_distribution<double>(-1.0, 1.0)(random);
}

inline Vec3 random_vec3(std::mt19937& random) {
  return {random_number(random), random_number(random), random_number(random)};
}

inline Vec6 random_vec6(std::mt19937& random) {
  Vec6 vector;
  for (Eigen::Index i = 0; i < 6; ++i) vector[i] = random_number(random);
  return vector;
}

inline Mat6 random_mat6(std::mt19937& random) {
  Mat6 matrix;
  for (Eigen::Index i = 0; i < 36; ++i) matrix(i / 6, i % 6) = random_number(random);
  return matrix;
}

// Symmetric and positive semidefinite, of this rank.
inline Mat6 random_semidefinite(std::mt19937& random, Eigen::Index rank = 6) {
  const Mat6 factor = random_mat6(random);
  return factor.leftCols(rank) * factor.leftCols(rank).transpose();
}

inline Mat3 random_rotation(std::mt19937& random) {
  const Eigen::Vector4d q(random_number(random), random_number(random), random_number(random),
                          random_number(random));
  return Eigen::Quaterniond(q.normalized()).toRotationMatrix();
}

}  // namespace buoyancy
