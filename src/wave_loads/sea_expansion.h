// What the expansions of a sea need of its components, prepared once per sea (docs/wave_mathematics.md,
// "Expansions").
//
// Lengths are in units of 1 / k_max, so that powers of wave numbers stay below one. About the centre c of a
// cell, with xi = k_max (x - c),
//   f   = sum over terms (l, m) of a_lm C_lm(xi) + b_lm S_lm(xi),   C_lm + i S_lm = |xi|^l P_l^m e^(i m
//   angle) / (l + m)! eta = sum over terms (p, q) of e_pq xi_1^p xi_2^q
// A term's coefficient is the sum over components of `table` times one of the component's weights at c.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "waves/sea.h"

namespace buoyancy {

inline constexpr int kDegree = 8;       // of the polynomials that are evaluated
inline constexpr int kNormDegree = 10;  // up to this degree, what is left out is bounded by its norm

// Places of the terms. Harmonics: degree l from l^2 on, C_l0, C_l1, S_l1, C_l2, ... Monomials: degree l from
// l (l + 1) / 2 on, xi_1^l, xi_1^(l-1) xi_2, ...
constexpr std::size_t harmonics_to(int degree) {
  const auto n = static_cast<std::size_t>(degree) + 1;
  return n * n;
}
constexpr std::size_t monomials_to(int degree) {
  const auto n = static_cast<std::size_t>(degree);
  return (n + 1) * (n + 2) / 2;
}
constexpr std::size_t cosine_place(int l, int m) {
  const auto n = static_cast<std::size_t>(l);
  return n * n + (m == 0 ? 0 : 2 * static_cast<std::size_t>(m) - 1);
}
constexpr std::size_t sine_place(int l, int m) {
  const auto n = static_cast<std::size_t>(l);
  return n * n + 2 * static_cast<std::size_t>(m);
}
constexpr std::size_t monomial_place(int p, int q) {
  const auto n = static_cast<std::size_t>(p) + static_cast<std::size_t>(q);
  return n * (n + 1) / 2 + static_cast<std::size_t>(q);
}

// A component's weights at a point: its amplitude there times the cosine or the sine of its phase, and in
// finite depth times cosh k(z + h) / cosh kh for terms with l + m even, and times the sinh for the others.
enum class Weight : unsigned char { kCosineEven, kSineEven, kCosineOdd, kSineOdd };
inline constexpr std::size_t kWeights = 4;

// Number: float or double.
template <typename Number>
struct ExpansionTable {
  // The term t of component i is at t * components + i.
  std::vector<Number> harmonics;  // harmonics_to(kNormDegree) rows
  std::vector<Number> monomials;  // monomials_to(kNormDegree) rows
  std::vector<Number> tail;       // (k / k_max)^(kNormDegree + 1), one row
};

struct SeaExpansion {
  explicit SeaExpansion(const Sea& sea);

  std::size_t components = 0;
  double k_max = 0.0;  // [rad/m]
  // Per component.
  std::vector<double> amplitude;    // [m]
  std::vector<double> k;            // over k_max
  std::vector<double> k1, k2;       // over k_max, along the horizontal axes
  std::vector<double> twice_depth;  // 2 k h; infinite in deep water
  ExpansionTable<float> single_precision;
  ExpansionTable<double> double_precision;

  // The distance from a cell's centre, over 1 / k_max, to which an expansion is likely to leave out less than
  // `error` [m] at the surface; 0.1 to 4. Bounds do not depend on it.
  double reach_within(double error) const;

  double typical_norm =
      0.0;            // [m], root mean square of what degree kDegree + 1 adds at a distance of 1 / k_max
  double tail = 0.0;  // [m], sum of a (k / k_max)^(kNormDegree + 1) / (kNormDegree + 1)!

  // Sums over components of a k^n [m, rad/m], n from 0 to 2: bounds on elevation, slope and curvature.
  std::array<double, 3> amplitude_sums{};
};

Weight weight_of_harmonic(int l, int m);
Weight weight_of_monomial(int l);

}  // namespace buoyancy
