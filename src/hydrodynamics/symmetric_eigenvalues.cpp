#include "hydrodynamics/symmetric_eigenvalues.h"

#include <cmath>
#include <limits>

namespace buoyancy {

SymmetricEigen6 symmetric_eigen(Mat6 matrix) {
  constexpr int kMaxSweeps = 30;
  SymmetricEigen6 eigen;
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool diagonal = true;
    for (int p = 0; p < 5; ++p) {
      for (int q = p + 1; q < 6; ++q) {
        const double off = matrix(p, q);
        const double scale = std::abs(matrix(p, p)) + std::abs(matrix(q, q));
        if (std::abs(off) <= std::numeric_limits<double>::epsilon() * 0x1p-4 * scale) continue;
        diagonal = false;
        const double theta = (matrix(q, q) - matrix(p, p)) / (2.0 * off);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::hypot(t, 1.0);
        const double s = t * c;
        const auto rotate = [&](double& a, double& b) {
          const double old = a;
          a = c * old - s * b;
          b = s * old + c * b;
        };
        for (int k = 0; k < 6; ++k) rotate(matrix(k, p), matrix(k, q));
        for (int k = 0; k < 6; ++k) rotate(matrix(p, k), matrix(q, k));
        for (int k = 0; k < 6; ++k) rotate(eigen.vectors(k, p), eigen.vectors(k, q));
        matrix(p, q) = matrix(q, p) = 0.0;
      }
    }
    if (diagonal) break;
  }
  eigen.values = matrix.diagonal();
  return eigen;
}

}  // namespace buoyancy
