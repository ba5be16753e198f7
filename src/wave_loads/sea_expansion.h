// What the expansions of a sea need of its components, prepared once per sea (docs/wave_mathematics.md,
// "Expansions").
//
// Lengths are in units of 1 / k_max, so that powers of wave numbers stay below one. About the centre c of a
// cell, with xi = k_max (x - c),
//   f   = sum over terms (l, m) of a_lm C_lm(xi) + b_lm S_lm(xi),
//         C_lm + i S_lm = |xi|^l P_l^m e^(i m angle) / (l + m)!
//   eta = sum over terms (p, q) of e_pq xi_1^p xi_2^q
// A term's coefficient is the sum over components of its entry in a table times one of the component's
// weights at c. A component's entry is a power of its wave number times a factor of its direction. A sea of a
// spectrum has few directions: its components are sorted into slots (component_slots.h), and it is summed in
// two steps, over the components of a slot for every power, then over the slots.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wave_loads/component_slots.h"
#include "waves/sea.h"

namespace buoyancy {

inline constexpr int kDegree = 8;       // of the polynomials that are evaluated
inline constexpr int kNormDegree = 10;  // up to this degree, what is left out is bounded by its norm

// Places of the terms. Harmonics: degree l from l^2 on, C_l0 to C_ll, then S_l1 to S_ll. Monomials: degree l
// from l (l + 1) / 2 on, xi_1^l, xi_1^(l-1) xi_2, ...
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
  return n * n + static_cast<std::size_t>(m);
}
constexpr std::size_t sine_place(int l, int m) {
  return cosine_place(l, l + m);
}
constexpr std::size_t monomial_place(int p, int q) {
  const auto n = static_cast<std::size_t>(p) + static_cast<std::size_t>(q);
  return n * (n + 1) / 2 + static_cast<std::size_t>(q);
}

// A component's weights at a point: its amplitude there times the cosine or the sine of its phase, and in
// finite depth times cosh k(z + h) / cosh kh for terms with l + m even, and times the sinh for the others.
enum class Weight : unsigned char { kCosineEven, kSineEven, kCosineOdd, kSineOdd };
inline constexpr std::size_t kWeights = 4;

// The columns of a table are sorted by weight, each weight's are filled up to a multiple of kColumnUnit, so
// that a vector of neighbouring columns has one weight.
inline constexpr std::size_t kColumnUnit = 16;
struct ColumnRange {
  std::size_t begin, end;
};
inline constexpr std::array<ColumnRange, kWeights> kHarmonicColumnsOfWeight{
    {{0, 48}, {80, 112}, {48, 80}, {112, 144}}};
inline constexpr std::array<ColumnRange, kWeights> kMonomialColumnsOfWeight{
    {{0, 48}, {48, 80}, {80, 80}, {80, 80}}};
inline constexpr std::size_t kHarmonicColumns = 144;
inline constexpr std::size_t kMonomialColumns = 80;

// A component's entries of a table.
template <typename Number, std::size_t kColumns>
struct alignas(64) ExpansionRow {
  std::array<Number, kColumns> columns{};
};

// What a component's terms have of its direction b, the same for all components of a slot.
template <typename Number>
struct alignas(64) SlotFactors {
  static constexpr std::size_t kLength = 16;
  using Row = std::array<Number, kLength>;
  Row cosines{}, sines{};                        // of m b, with the factors of C_lm and S_lm; by order m
  std::array<Row, kNormDegree + 1> monomials{};  // by degree and q
};

// The powers (k / k_max)^l of a step's components.
template <typename Number>
struct alignas(64) StepPowers {
  std::array<std::array<Number, kLanesOfStep>, kNormDegree + 1> of_degree{};
};

// Components are filled up to a multiple of kColumnUnit by components without an amplitude.
// Number: float or double.
template <typename Number>
struct ExpansionTable {
  // Of a sea without slots, per component.
  std::vector<ExpansionRow<Number, kHarmonicColumns>> harmonics;
  std::vector<ExpansionRow<Number, kMonomialColumns>> monomials;
  // Of a sea with slots.
  std::vector<SlotFactors<Number>> slots;
  std::vector<StepPowers<Number>> powers;  // block after block
  // Per component, lengths over 1 / k_max.
  std::vector<Number> amplitude;       // a
  std::vector<Number> amplitude_in_f;  // a / (1 + e^(-2 k h))
  std::vector<Number> k;               // over k_max
  std::vector<Number> minus_twice_kh;  // -2 k h
  std::vector<Number> tail;            // (k / k_max)^(kNormDegree + 1) / (kNormDegree + 1)!
};

struct SeaExpansion {
  explicit SeaExpansion(const Sea& sea);

  ComponentSlots slots;               // none where they would cost more
  std::size_t filled_components = 0;  // a multiple of kColumnUnit
  double k_max = 0.0;                 // [rad/m]
  // By place; of a place without a component, any.
  std::vector<std::int64_t> component_of_place;
  // Per component, filled up.
  std::vector<double> k1, k2;                        // over k_max, along the horizontal axes
  std::vector<double> k1_W, k1_rest, k2_W, k2_rest;  // [rad/m], as in PreparedComponents
  ExpansionTable<float> single_precision;
  ExpansionTable<double> double_precision;

  // The distance from a cell's centre, over 1 / k_max, to which an expansion is likely to leave out less than
  // `error` [m] at the surface; 0.1 to 4. Bounds do not depend on it.
  double reach_within(double error) const;

  double typical_norm =
      0.0;            // [m], root mean square of what degree kDegree + 1 adds at a distance of 1 / k_max
  double tail = 0.0;  // [m], sum of a (k / k_max)^(kNormDegree + 1) / (kNormDegree + 1)!
  double typical_elevation = 0.0;  // [m], root mean square of the elevation
  // [m k_max^3], root mean square of the third derivative along the waves at the level, and the rate [k_max]
  // at which it begins to fall with the depth.
  double typical_third = 0.0;
  double typical_decay = 0.0;

  // Sums over components of a k^n [m, rad/m], n from 0 to 2: bounds on elevation, slope and curvature.
  std::array<double, 3> amplitude_sums{};
};

// The column of each term of the tables, in the order of the terms' places.
using HarmonicColumns = std::array<std::size_t, harmonics_to(kNormDegree)>;
using MonomialColumns = std::array<std::size_t, monomials_to(kNormDegree)>;
const HarmonicColumns& harmonic_columns();
const MonomialColumns& monomial_columns();

}  // namespace buoyancy
