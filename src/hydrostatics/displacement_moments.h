// Converts the surface moments of the wetted surface to the integrals over the displaced volume and over the
// waterplane, and these to the hydrostatic stiffness. It is templated on the number type: the product uses
// double, the tests also use dual numbers and rationals.
//
// With S, N, P the moments about a point o at height z_o over the water, k up, y = x - o, and the sums
// (Nk)_j = N_jk k_k (docs/mathematics.md, "Conversion to volume integrals"):
//   V = k . Nk + z_o k . S,   U_j = k_i k_k P_ijk + z_o (Nk)_j,   H = 1/2 (k_i k_j k_k P_ijk + 2 z_o k . Nk +
//   z_o^2 k . S), M = U - k H,   A = -k . S,   a = V k - Nk,   J = k M^T + M k^T - P_ijk k_k.
// No cap is needed: wetted surface and waterplane are closed together, so the cap's contribution follows from
// the wetted surface.
#pragma once

#include "base/vec3.h"
#include "geometry/surface_moments.h"

namespace buoyancy {

// Moments about a point o, in any frame's axes; y = x - o.
template <typename T>
struct DisplacementMoments {
  T volume = T(0);                                        // [m^3] V
  Vec3T<T> moment = Vec3T<T>::Constant(T(0));             // [m^4] M, integral of y over the displaced volume
  T waterplane_area = T(0);                               // [m^2] A
  Vec3T<T> waterplane_moment = Vec3T<T>::Constant(T(0));  // [m^3] a, integral of y over the waterplane
  Mat3T<T> waterplane_second_moments = Mat3T<T>::Constant(T(0));  // [m^4] J, same integral of y y^T

  // The same moments about o + t.
  DisplacementMoments moved(const Vec3T<T>& t) const {
    DisplacementMoments result = *this;
    result.moment -= volume * t;
    result.waterplane_moment -= waterplane_area * t;
    result.waterplane_second_moments -= t * waterplane_moment.transpose();
    result.waterplane_second_moments -= result.waterplane_moment * t.transpose();
    return result;
  }

  // The same moments in the axes that R maps to.
  DisplacementMoments rotated(const Mat3T<T>& R) const {
    return {volume, R * moment, waterplane_area, R * waterplane_moment,
            R * waterplane_second_moments * R.transpose()};
  }
};

// wet: moments of the wetted surface about o. height: [m], of o over the water. up: unit vector.
template <typename T>
DisplacementMoments<T> displacement_moments(const SurfaceMoments<T>& wet, const T& height,
                                            const Vec3T<T>& up) {
  const Vec3T<T>& k = up;
  const T k_S = k.dot(wet.S);
  const Vec3T<T> N_k = wet.N * k;
  const T k_N_k = k.dot(N_k);
  Mat3T<T> P_k = Mat3T<T>::Constant(T(0));  // P_ijk k_k
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int l = 0; l < 3; ++l) P_k(i, j) += wet.second(i, j, l) * k(l);
    }
  }
  const Vec3T<T> k_P_k = P_k * k;
  const T twice_H = k.dot(k_P_k) + height * (T(2) * k_N_k + height * k_S);

  DisplacementMoments<T> result;
  result.volume = k_N_k + height * k_S;
  result.moment = k_P_k + height * N_k - (twice_H / T(2)) * k;
  result.waterplane_area = -k_S;
  result.waterplane_moment = result.volume * k - N_k;
  result.waterplane_second_moments = k * result.moment.transpose() + result.moment * k.transpose() - P_k;
  return result;
}

template <typename T>
Mat3T<T> cross_matrix(const Vec3T<T>& v) {  // [v], so that [v] x = v x x
  Mat3T<T> matrix;
  matrix << T(0), -v(2), v(1), v(2), T(0), -v(0), -v(1), v(0), T(0);
  return matrix;
}

// -d(F, tau)/d(p, theta) / (rho g) of buoyancy alone, rows (F, tau), columns (p, theta): p translates the
// body, theta rotates it about o and the frame's axes, tau is about o, and o moves with the body. With
// b = a x k this is
//   [[A k k^T, k b^T], [b k^T, [k] J [k]^T - [k] [M]]].
// It is not symmetric where the centre of buoyancy does not lie above or below o, since a rotation about k
// then rotates tau as well.
template <typename T>
Eigen::Matrix<T, 6, 6> stiffness(const DisplacementMoments<T>& about_o, const Vec3T<T>& up) {
  const Vec3T<T> b = about_o.waterplane_moment.cross(up);
  const Mat3T<T> k = cross_matrix(up);
  Eigen::Matrix<T, 6, 6> result;
  result.template block<3, 3>(0, 0) = about_o.waterplane_area * (up * up.transpose());
  result.template block<3, 3>(0, 3) = up * b.transpose();
  result.template block<3, 3>(3, 0) = b * up.transpose();
  result.template block<3, 3>(3, 3) =
      k * about_o.waterplane_second_moments * k.transpose() - k * cross_matrix(about_o.moment);
  return result;
}

}  // namespace buoyancy
