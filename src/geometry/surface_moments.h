// Surface moments: the integrals over a piece of oriented surface from which all hydrostatics follow.
//
// About a centre c, with outward unit normal n and y = x - c:
//   S_k   = integral of n_k dA             [m^2]
//   N_ik  = integral of y_i n_k dA         [m^3]
//   P_ijk = integral of y_i y_j n_k dA     [m^4], symmetric in i and j
// They are additive over pieces that share a centre, and a change of centre needs no new integration. Over a
// closed surface S = 0, N = V I and P_ijk = V (m_i d_jk + m_j d_ik), where m is the volume's centroid about
// c. The integrals of a flat triangle are polynomials in its corners: exact except for the rounding of T.
// Source: docs/mathematics.md, "Surface moments". T: any field type that Eigen supports (double, rationals,
// intervals, dual numbers).
#pragma once

#include <array>

#include "base/vec3.h"

namespace buoyancy {

// Row of P that holds the symmetric pair (i, j): xx, yy, zz, xy, xz, yz.
inline constexpr std::array<std::array<int, 3>, 3> kSymmetricPair{{{0, 3, 4}, {3, 1, 5}, {4, 5, 2}}};

template <typename T>
struct SurfaceMoments {
  Vec3T<T> S = Vec3T<T>::Constant(T(0));
  Mat3T<T> N = Mat3T<T>::Constant(T(0));  // N(i, k)
  Eigen::Matrix<T, 6, 3> P = Eigen::Matrix<T, 6, 3>::Constant(T(0));

  const T& second(int i, int j, int k) const { return P(pair(i, j), k); }  // P_ijk
  T& second(int i, int j, int k) { return P(pair(i, j), k); }

  // Requires both about the same centre.
  SurfaceMoments& operator+=(const SurfaceMoments& other) {
    S += other.S;
    N += other.N;
    P += other.P;
    return *this;
  }

  // Returns the moments of the same piece of surface about the centre c + t.
  SurfaceMoments moved(const Vec3T<T>& t) const {
    SurfaceMoments result = *this;
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) {
        result.N(i, k) -= t(i) * S(k);
        for (int j = i; j < 3; ++j) {
          result.second(i, j, k) += t(i) * t(j) * S(k) - t(i) * N(j, k) - t(j) * N(i, k);
        }
      }
    }
    return result;
  }

 private:
  static int pair(int i, int j) {
    return kSymmetricPair[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
};

// Returns the moments of the triangle abc, counter-clockwise seen from outside, about the origin of its
// corners' coordinates.
template <typename T>
SurfaceMoments<T> moments_of_triangle(const Vec3T<T>& a, const Vec3T<T>& b, const Vec3T<T>& c) {
  const Vec3T<T> ab = b - a;
  const Vec3T<T> ac = c - a;
  const Vec3T<T> sum = a + b + c;
  SurfaceMoments<T> moments;
  moments.S(0) = (ab(1) * ac(2) - ab(2) * ac(1)) / T(2);
  moments.S(1) = (ab(2) * ac(0) - ab(0) * ac(2)) / T(2);
  moments.S(2) = (ab(0) * ac(1) - ab(1) * ac(0)) / T(2);
  for (int i = 0; i < 3; ++i) {
    const T mean = sum(i) / T(3);  // mean of y_i over the triangle
    for (int k = 0; k < 3; ++k) moments.N(i, k) = mean * moments.S(k);
    for (int j = i; j < 3; ++j) {
      const T mean_square = (a(i) * a(j) + b(i) * b(j) + c(i) * c(j) + sum(i) * sum(j)) / T(12);
      for (int k = 0; k < 3; ++k) moments.second(i, j, k) = mean_square * moments.S(k);
    }
  }
  return moments;
}

}  // namespace buoyancy
