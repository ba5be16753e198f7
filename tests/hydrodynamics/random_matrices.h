// Random matrices and vectors for tests of hydrodynamic loads. Random: a generator of random bits.
#pragma once

#include <random>

#include "base/spatial.h"

namespace buoyancy {

template <typename Random>
double random_number(Random& random) {
  return std::uniform_real_distribution<double>(-1.0, 1.0)(random);
}

template <typename Random>
Vec3 random_vec3(Random& random) {
  return {random_number(random), random_number(random), random_number(random)};
}

template <typename Random>
Vec6 random_vec6(Random& random) {
  Vec6 vector;
  for (Eigen::Index i = 0; i < 6; ++i) vector[i] = random_number(random);
  return vector;
}

template <typename Random>
Mat6 random_mat6(Random& random) {
  Mat6 matrix;
  for (Eigen::Index i = 0; i < 36; ++i) matrix(i / 6, i % 6) = random_number(random);
  return matrix;
}

// Symmetric and positive semidefinite, of this rank.
template <typename Random>
Mat6 random_semidefinite(Random& random, Eigen::Index rank = 6) {
  const Mat6 factor = random_mat6(random);
  return factor.leftCols(rank) * factor.leftCols(rank).transpose();
}

template <typename Random>
Mat6 random_definite(Random& random) {
  return random_semidefinite(random) + 0.1 * Mat6::Identity();
}

template <typename Random>
Mat3 random_rotation(Random& random) {
  const Eigen::Vector4d q{random_number(random), random_number(random), random_number(random),
                          random_number(random)};
  return Eigen::Quaterniond(q.normalized()).toRotationMatrix();
}

}  // namespace buoyancy
