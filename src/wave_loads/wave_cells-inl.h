// Cells: expansions of the sea about points, built with SIMD (docs/wave_mathematics.md,
// "Expansions"). Included once per instruction set, after highway.h.
//
// Lengths within a cell are in units of 1 / k_max. As many cells as a vector has lanes are built at once and
// stored side by side; a cell is evaluated at as many points at once.
#if defined(BUOYANCY_WAVE_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_CELLS_INL_H
#undef BUOYANCY_WAVE_CELLS_INL_H
#else
#define BUOYANCY_WAVE_CELLS_INL_H
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "wave_loads/sea_expansion.h"
#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_query.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Bounds on what an expansion leaves out and on its derivatives, from the norms sigma_l of its degrees.
template <typename Number>
struct CellBounds {
  alignas(64) std::array<CellNumbers<Number>, kNormDegree + 1> sigma;  // [m]
  CellNumbers<Number> tail;  // [m], sum of a (k / k_max)^(kNormDegree + 1) / (kNormDegree + 1)!
};

template <typename Number>
struct SurfaceCells {
  alignas(64) std::array<CellNumbers<Number>, monomials_to(kDegree)> eta;
  std::array<CellNumbers<Number>, monomials_to(kDegree - 1)> eta_1, eta_2;
  std::array<CellNumbers<Number>, monomials_to(kDegree - 2)> eta_11, eta_12, eta_22;
  CellBounds<Number> bounds;
};

template <typename Number>
struct VolumeCells {
  alignas(64) std::array<CellNumbers<Number>, harmonics_to(kDegree)> f;
  std::array<CellNumbers<Number>, harmonics_to(kDegree - 1)> f_1, f_2, f_3;
  std::array<CellNumbers<Number>, harmonics_to(kDegree - 2)> f_11, f_12, f_13, f_23, f_33;
  CellBounds<Number> bounds;
};

// Weights of all components at the centres of a block of cells.
template <typename Number>
struct CellWeights {
  std::array<std::vector<CellNumbers<Number>>, kWeights> weights;  // [component]
  std::vector<CellNumbers<Number>> amplitude;                      // a E

  void reserve(std::size_t components) {
    for (auto& of_kind : weights) of_kind.resize(components);
    amplitude.resize(components);
  }
};

struct CellCenter {
  double x1, x2, z;  // over 1 / k_max, from the body's centre and the level
};

template <typename Number>
HWY_NOINLINE void set_weights(const SeaExpansion& sea, const QueryPhases& phases, const CellCenter* centers,
                              CellWeights<Number>& out) {
  const LanesOf<Number> d;
  constexpr double kTurn = 6.283185307179586;
  for (std::size_t i = 0; i < sea.components; ++i) {
    alignas(64) CellNumbers<Number> theta;
    alignas(64) CellNumbers<Number> kz;
    for (std::size_t cell = 0; cell < kLanes<Number>; ++cell) {
      const CellCenter& c = centers[cell];
      const double phase = phases.phase[i] + sea.k1[i] * c.x1 + sea.k2[i] * c.x2;
      theta[cell] = static_cast<Number>(phase - kTurn * std::nearbyint(phase / kTurn));
      kz[cell] = static_cast<Number>(sea.k[i] * c.z);
    }
    const auto exponent = load<Number>(kz);
    const auto down = hn::Exp(d, exponent);
    // cosh k(z + h) / cosh kh and sinh k(z + h) / cosh kh by exponentials that do not overflow.
    const double twice_depth = sea.twice_depth[i];
    const auto up =
        std::isinf(twice_depth) ? hn::Zero(d) : hn::Exp(d, hn::Neg(exponent) - set<Number>(twice_depth));
    const auto amplitude =
        set<Number>(sea.k_max * phases.amplitude_factor * sea.amplitude[i] / (1.0 + std::exp(-twice_depth)));
    const auto even = amplitude * (down + up);
    const auto odd = amplitude * (down - up);
    const auto angle = load<Number>(theta);
    const auto cosine = hn::Cos(d, angle);
    const auto sine = hn::Sin(d, angle);
    store<Number>(even, out.amplitude[i]);
    store<Number>(even * cosine, out.weights[static_cast<std::size_t>(Weight::kCosineEven)][i]);
    store<Number>(even * sine, out.weights[static_cast<std::size_t>(Weight::kSineEven)][i]);
    store<Number>(odd * cosine, out.weights[static_cast<std::size_t>(Weight::kCosineOdd)][i]);
    store<Number>(odd * sine, out.weights[static_cast<std::size_t>(Weight::kSineOdd)][i]);
  }
}

// The rows of a table by weight, so that a weight is loaded once for several rows.
template <std::size_t kRows>
struct RowsByWeight {
  std::array<std::array<std::size_t, kRows>, kWeights> rows{};
  std::array<std::size_t, kWeights> count{};

  void add(Weight weight, std::size_t row) {
    const auto w = static_cast<std::size_t>(weight);
    rows[w][count[w]++] = row;
  }
};

// Sets sums[row] to the sum over components of table[row] times the row's weight.
template <typename Number, std::size_t kRows>
HWY_INLINE void accumulate(const RowsByWeight<kRows>& rows, const Number* table, std::size_t components,
                           const CellWeights<Number>& weights, std::array<CellNumbers<Number>, kRows>& sums) {
  const LanesOf<Number> d;
  constexpr std::size_t kTogether = 8;
  for (std::size_t w = 0; w < kWeights; ++w) {
    const CellNumbers<Number>* const of_kind = weights.weights[w].data();
    for (std::size_t first = 0; first < rows.count[w]; first += kTogether) {
      const std::size_t number = std::min(kTogether, rows.count[w] - first);
      std::array<const Number*, kTogether> row;
      for (std::size_t n = 0; n < kTogether; ++n) {
        row[n] = table + rows.rows[w][first + std::min(n, number - 1)] * components;
      }
      auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
      for (std::size_t i = 0; i < components; ++i) {
        const auto weight = load<Number>(of_kind[i]);
        s0 = hn::MulAdd(weight, hn::Set(d, row[0][i]), s0);
        s1 = hn::MulAdd(weight, hn::Set(d, row[1][i]), s1);
        s2 = hn::MulAdd(weight, hn::Set(d, row[2][i]), s2);
        s3 = hn::MulAdd(weight, hn::Set(d, row[3][i]), s3);
        s4 = hn::MulAdd(weight, hn::Set(d, row[4][i]), s4);
        s5 = hn::MulAdd(weight, hn::Set(d, row[5][i]), s5);
        s6 = hn::MulAdd(weight, hn::Set(d, row[6][i]), s6);
        s7 = hn::MulAdd(weight, hn::Set(d, row[7][i]), s7);
      }
      const std::array<VectorOf<Number>, kTogether> all{s0, s1, s2, s3, s4, s5, s6, s7};
      for (std::size_t n = 0; n < number; ++n) store<Number>(all[n], sums[rows.rows[w][first + n]]);
    }
  }
}

constexpr double factorial(int n) {
  double product = 1.0;
  for (int i = 2; i <= n; ++i) product *= i;
  return product;
}

template <typename Number>
HWY_INLINE void set_tail(const ExpansionTable<Number>& table, std::size_t components,
                         const CellWeights<Number>& weights, CellBounds<Number>& bounds) {
  auto sum = set<Number>(0.0);
  for (std::size_t i = 0; i < components; ++i) {
    sum = hn::MulAdd(load<Number>(weights.amplitude[i]), hn::Set(LanesOf<Number>(), table.tail[i]), sum);
  }
  store<Number>(sum * set<Number>(1.0 / factorial(kNormDegree + 1)), bounds.tail);
}

// centers: of kLanes cells, z is 0.
template <typename Number>
HWY_NOINLINE void build_cells(const SeaExpansion& sea, const ExpansionTable<Number>& table,
                              const CellWeights<Number>& weights, SurfaceCells<Number>& cells) {
  constexpr std::size_t kRows = monomials_to(kNormDegree);
  static const RowsByWeight<kRows> rows = [] {
    RowsByWeight<kRows> all;
    for (int l = 0; l <= kNormDegree; ++l) {
      for (int q = 0; q <= l; ++q) all.add(weight_of_monomial(l), monomial_place(l - q, q));
    }
    return all;
  }();
  std::array<CellNumbers<Number>, kRows> e;
  accumulate<Number>(rows, table.monomials.data(), sea.components, weights, e);
  const auto at = [&e](int p, int q) { return load<Number>(e[monomial_place(p, q)]); };

  for (int l = 0; l <= kDegree; ++l) {
    for (int q = 0; q <= l; ++q) {
      const int p = l - q;
      const std::size_t place = monomial_place(p, q);
      store<Number>(at(p, q), cells.eta[place]);
      if (l < kDegree) {
        store<Number>(set<Number>(p + 1) * at(p + 1, q), cells.eta_1[place]);
        store<Number>(set<Number>(q + 1) * at(p, q + 1), cells.eta_2[place]);
      }
      if (l < kDegree - 1) {
        store<Number>(set<Number>((p + 1) * (p + 2)) * at(p + 2, q), cells.eta_11[place]);
        store<Number>(set<Number>((p + 1) * (q + 1)) * at(p + 1, q + 1), cells.eta_12[place]);
        store<Number>(set<Number>((q + 1) * (q + 2)) * at(p, q + 2), cells.eta_22[place]);
      }
    }
  }
  // Bombieri's norm bounds a homogeneous polynomial on the unit circle.
  for (int l = 0; l <= kNormDegree; ++l) {
    auto squares = set<Number>(0.0);
    for (int q = 0; q <= l; ++q) {
      const auto weight = set<Number>(factorial(l - q) * factorial(q) / factorial(l));
      squares = squares + weight * at(l - q, q) * at(l - q, q);
    }
    store<Number>(hn::Sqrt(squares), cells.bounds.sigma[static_cast<std::size_t>(l)]);
  }
  set_tail(table, sea.components, weights, cells.bounds);
}

// The harmonics are evaluated in a scale in which their recurrences have no factors: the scale of (l, m)
// times the evaluated one is C_lm or S_lm.
constexpr double scale_of(int l, int m) {
  double scale = 1.0;
  for (int i = 1; i <= m; ++i) scale /= 2.0 * i;
  for (int i = m + 1; i <= l; ++i) scale *= (2.0 * i - 1.0) / ((i + m) * (i - m));
  return scale;
}
// U_lm = z U_(l-1)m - descent(l, m) r^2 U_(l-2)m in that scale.
constexpr double descent_of(int l, int m) {
  return scale_of(l - 2, m) / ((l + m) * (l - m)) / scale_of(l, m);
}

// Coefficients of a harmonic function, and those of its derivatives, in vectors of cells.
template <typename Number, int kTo>
class Harmonics {
 public:
  using V = VectorOf<Number>;

  std::array<CellNumbers<Number>, harmonics_to(kTo)> numbers;

  V a(int l, int m) const { return load<Number>(numbers[cosine_place(l, m)]); }
  V b(int l, int m) const { return load<Number>(numbers[sine_place(l, m)]); }

  template <int kLower>
  void set_derivative(int axis, Harmonics<Number, kLower>& out) const {
    static_assert(kLower < kTo);
    const V half = buoyancy::HWY_NAMESPACE::set<Number>(0.5);
    for (int l = 0; l <= kLower; ++l) {
      for (int m = 0; m <= l; ++m) {
        V cosine = buoyancy::HWY_NAMESPACE::set<Number>(0.0);
        V sine = cosine;
        if (axis == 2) {
          cosine = a(l + 1, m);
          if (m > 0) sine = b(l + 1, m);
        } else if (axis == 0) {
          cosine = half * a(l + 1, m + 1);
          if (m == 1) cosine = cosine - a(l + 1, 0);
          if (m > 1) cosine = cosine - half * a(l + 1, m - 1);
          if (m > 0) sine = half * b(l + 1, m + 1);
          if (m > 1) sine = sine - half * b(l + 1, m - 1);
        } else {
          cosine = half * b(l + 1, m + 1);
          if (m > 1) cosine = cosine + half * b(l + 1, m - 1);
          if (m > 0) sine = hn::Neg(half * a(l + 1, m + 1));
          if (m == 1) sine = sine - a(l + 1, 0);
          if (m > 1) sine = sine - half * a(l + 1, m - 1);
        }
        store<Number>(cosine, out.numbers[cosine_place(l, m)]);
        if (m > 0) store<Number>(sine, out.numbers[sine_place(l, m)]);
      }
    }
  }

  // In the scale of evaluation.
  template <std::size_t kNumber>
  void store_scaled(std::array<CellNumbers<Number>, kNumber>& out) const {
    for (int l = 0; harmonics_to(l) <= kNumber; ++l) {
      for (int m = 0; m <= l; ++m) {
        const V scale = buoyancy::HWY_NAMESPACE::set<Number>(scale_of(l, m));
        store<Number>(scale * a(l, m), out[cosine_place(l, m)]);
        if (m > 0) store<Number>(scale * b(l, m), out[sine_place(l, m)]);
      }
    }
  }
};

template <typename Number>
HWY_NOINLINE void build_cells(const SeaExpansion& sea, const ExpansionTable<Number>& table,
                              const CellWeights<Number>& weights, VolumeCells<Number>& cells) {
  constexpr std::size_t kRows = harmonics_to(kNormDegree);
  static const RowsByWeight<kRows> rows = [] {
    RowsByWeight<kRows> all;
    for (int l = 0; l <= kNormDegree; ++l) {
      for (int m = 0; m <= l; ++m) {
        all.add(weight_of_harmonic(l, m), cosine_place(l, m));
        if (m > 0) all.add(weight_of_harmonic(l, m), sine_place(l, m));
      }
    }
    return all;
  }();
  Harmonics<Number, kNormDegree> f;
  accumulate<Number>(rows, table.harmonics.data(), sea.components, weights, f.numbers);
  f.store_scaled(cells.f);
  {
    Harmonics<Number, kDegree - 1> f_1, f_2, f_3;
    Harmonics<Number, kDegree - 2> second;
    f.set_derivative(0, f_1);
    f.set_derivative(1, f_2);
    f.set_derivative(2, f_3);
    f_1.store_scaled(cells.f_1);
    f_2.store_scaled(cells.f_2);
    f_3.store_scaled(cells.f_3);
    f_1.set_derivative(0, second);
    second.store_scaled(cells.f_11);
    f_1.set_derivative(1, second);
    second.store_scaled(cells.f_12);
    f_1.set_derivative(2, second);
    second.store_scaled(cells.f_13);
    f_2.set_derivative(2, second);
    second.store_scaled(cells.f_23);
    f_3.set_derivative(2, second);
    second.store_scaled(cells.f_33);
  }
  // By Cauchy's inequality and the addition theorem for spherical harmonics.
  for (int l = 0; l <= kNormDegree; ++l) {
    auto squares = set<Number>(0.0);
    for (int m = 0; m <= l; ++m) {
      const auto weight = set<Number>((m == 0 ? 1.0 : 0.5) / (factorial(l + m) * factorial(l - m)));
      squares = squares + weight * f.a(l, m) * f.a(l, m);
      if (m > 0) squares = squares + weight * f.b(l, m) * f.b(l, m);
    }
    store<Number>(hn::Sqrt(squares), cells.bounds.sigma[static_cast<std::size_t>(l)]);
  }
  set_tail(table, sea.components, weights, cells.bounds);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_CELLS_INL_H
