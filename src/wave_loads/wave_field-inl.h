// The sea about the centre of a cell, with SIMD (docs/wave_mathematics.md, "Expansions"): the coefficients of
// its polynomials and of their derivatives, from the sums over the components; their values at points; and
// the bounds on what they leave out and on how fast they vary. Included once per instruction set.
#if defined(BUOYANCY_WAVE_FIELD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_FIELD_INL_H
#undef BUOYANCY_WAVE_FIELD_INL_H
#else
#define BUOYANCY_WAVE_FIELD_INL_H
#endif

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/sea_expansion.h"
#include "wave_loads/wave_sums-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

constexpr double factorial(int n) {
  double product = 1.0;
  for (int i = 2; i <= n; ++i) product *= i;
  return product;
}

// Rows of numbers by degree l, with room for vectors that start in a row and for orders below 0.
inline constexpr std::size_t kBefore = 3;
inline constexpr std::size_t kRowLength = 32;
template <typename Number>
struct alignas(64) DegreeRows {
  std::array<std::array<Number, kRowLength>, kNormDegree + 1> rows{};

  // The vector from (l, order) on.
  HWY_INLINE VectorOf<Number> at(int l, int order) const {
    return hn::LoadU(LanesOf<Number>(),
                     &rows[static_cast<std::size_t>(l)][kBefore + static_cast<std::size_t>(order)]);
  }
  Number& number(int l, int order) {
    return rows[static_cast<std::size_t>(l)][kBefore + static_cast<std::size_t>(order)];
  }
};

// Calls store(l, q, place) for the vectors that hold the terms of degrees 0 to `degree`, q terms into the
// degree.
template <typename Number, typename Store>
HWY_INLINE void for_each_row(int degree, const Store& store) {
  for (int l = 0; l <= degree; ++l) {
    for (int q = 0; q <= l; q += static_cast<int>(kLanes<Number>)) store(l, q);
  }
}

// What monomials are multiplied with when they are differentiated.
template <typename Number>
struct MonomialFactors {
  // By l and q of the derivative.
  DegreeRows<Number> in_1, in_2, in_11, in_12, in_22, in_111, in_112, in_122, in_222;
  DegreeRows<Number> norm;  // of Bombieri's norm

  MonomialFactors() {
    for (int l = 0; l <= kNormDegree; ++l) {
      for (int q = 0; q <= l; ++q) {
        const int p = l - q;
        in_1.number(l, q) = static_cast<Number>(p + 1);
        in_2.number(l, q) = static_cast<Number>(q + 1);
        in_11.number(l, q) = static_cast<Number>((p + 1) * (p + 2));
        in_12.number(l, q) = static_cast<Number>((p + 1) * (q + 1));
        in_22.number(l, q) = static_cast<Number>((q + 1) * (q + 2));
        in_111.number(l, q) = static_cast<Number>((p + 1) * (p + 2) * (p + 3));
        in_112.number(l, q) = static_cast<Number>((p + 1) * (p + 2) * (q + 1));
        in_122.number(l, q) = static_cast<Number>((p + 1) * (q + 1) * (q + 2));
        in_222.number(l, q) = static_cast<Number>((q + 1) * (q + 2) * (q + 3));
        norm.number(l, q) = static_cast<Number>(factorial(p) * factorial(q) / factorial(l));
      }
    }
  }
};

// The coefficients of the elevation's monomials.
template <typename Number>
struct MonomialCoefficients {
  DegreeRows<Number> e;
};

template <typename Number>
HWY_INLINE void set_coefficients(const std::array<Number, kHarmonicColumns>& sums,
                                 MonomialCoefficients<Number>& of_cell) {
  const MonomialColumns& columns = monomial_columns();
  for (int l = 0; l <= kNormDegree; ++l) {
    for (int q = 0; q <= l; ++q) of_cell.e.number(l, q) = sums[columns[monomial_place(l - q, q)]];
  }
}

// sums: block after block, of the cosines for even powers and of the sines for odd ones.
template <typename Number>
HWY_INLINE void set_coefficients(const std::vector<SlotFactors<Number>>& slots, const LaneSums<Number>* sums,
                                 MonomialCoefficients<Number>& of_cell) {
  const LanesOf<Number> d;
  for (std::size_t first = 0; first <= kNormDegree; first += kLanes<Number>) {
    std::array<VectorOf<Number>, kNormDegree + 1> e;
    for (auto& row : e) row = hn::Zero(d);
    for (std::size_t slot = 0; slot < slots.size(); ++slot) {
      const LaneSums<Number>& of_block = sums[slot / kLanesOfStep];
#pragma GCC unroll 16
      for (std::size_t l = 0; l <= kNormDegree; ++l) {
        e[l] = hn::MulAdd(hn::Set(d, of_block.of_degree[l][slot % kLanesOfStep]),
                          hn::Load(d, slots[slot].monomials[l].data() + first), e[l]);
      }
    }
    for (int l = 0; l <= kNormDegree; ++l) {
      hn::StoreU(e[static_cast<std::size_t>(l)], d, &of_cell.e.number(l, static_cast<int>(first)));
    }
  }
}

template <typename Number>
HWY_NOINLINE void finish(const MonomialCoefficients<Number>& of_cell, Number tail,
                         SurfaceCell<Number>& cell) {
  static const MonomialFactors<Number> factors;
  const LanesOf<Number> d;
  const DegreeRows<Number>& e = of_cell.e;
  const auto place = [](int l, int q) { return monomial_place(l - q, q); };
  for_each_row<Number>(kDegree, [&](int l, int q) { hn::StoreU(e.at(l, q), d, &cell.eta[place(l, q)]); });
  for_each_row<Number>(kDegree - 1, [&](int l, int q) {
    hn::StoreU(factors.in_1.at(l, q) * e.at(l + 1, q), d, &cell.eta_1[place(l, q)]);
    hn::StoreU(factors.in_2.at(l, q) * e.at(l + 1, q + 1), d, &cell.eta_2[place(l, q)]);
  });
  for_each_row<Number>(kDegree - 2, [&](int l, int q) {
    hn::StoreU(factors.in_11.at(l, q) * e.at(l + 2, q), d, &cell.eta_11[place(l, q)]);
    hn::StoreU(factors.in_12.at(l, q) * e.at(l + 2, q + 1), d, &cell.eta_12[place(l, q)]);
    hn::StoreU(factors.in_22.at(l, q) * e.at(l + 2, q + 2), d, &cell.eta_22[place(l, q)]);
  });
  for_each_row<Number>(kThirdDegree, [&](int l, int q) {
    hn::StoreU(factors.in_111.at(l, q) * e.at(l + 3, q), d, &cell.eta_111[place(l, q)]);
    hn::StoreU(factors.in_112.at(l, q) * e.at(l + 3, q + 1), d, &cell.eta_112[place(l, q)]);
    hn::StoreU(factors.in_122.at(l, q) * e.at(l + 3, q + 2), d, &cell.eta_122[place(l, q)]);
    hn::StoreU(factors.in_222.at(l, q) * e.at(l + 3, q + 3), d, &cell.eta_222[place(l, q)]);
  });
  // Bombieri's norm bounds a homogeneous polynomial on the unit circle.
  for (int l = 0; l <= kNormDegree; ++l) {
    VectorOf<Number> squares = hn::Zero(d);
    for (int q = 0; q <= l; q += static_cast<int>(kLanes<Number>)) {
      squares = hn::MulAdd(factors.norm.at(l, q) * e.at(l, q), e.at(l, q), squares);
    }
    cell.bounds.sigma[static_cast<std::size_t>(l)] = std::sqrt(sum_of_lanes(squares));
  }
  cell.bounds.tail = tail;
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

// Factors by l and m. Coefficients of cosines are held twice as large at m = 0, which these undo.
template <typename Number>
struct HarmonicFactors {
  DegreeRows<Number> scale;
  DegreeRows<Number> norm;

  HarmonicFactors() {
    for (int l = 0; l <= kNormDegree; ++l) {
      for (int m = 0; m <= l; ++m) {
        scale.number(l, m) = static_cast<Number>((m == 0 ? 0.5 : 1.0) * scale_of(l, m));
        norm.number(l, m) =
            static_cast<Number>((m == 0 ? 0.25 : 0.5) / (factorial(l + m) * factorial(l - m)));
      }
    }
  }
};

// The coefficients of the harmonics C_lm and S_lm, and twice that of C_l0.
template <typename Number>
struct HarmonicCoefficients {
  DegreeRows<Number> A, B;
};

template <typename Number>
HWY_INLINE void set_coefficients(const std::array<Number, kHarmonicColumns>& sums,
                                 HarmonicCoefficients<Number>& of_cell) {
  const HarmonicColumns& columns = harmonic_columns();
  for (int l = 0; l <= kNormDegree; ++l) {
    of_cell.A.number(l, 0) = sums[columns[cosine_place(l, 0)]];
    for (int m = 1; m <= l; ++m) {
      of_cell.A.number(l, m) = sums[columns[cosine_place(l, m)]];
      of_cell.B.number(l, m) = sums[columns[sine_place(l, m)]];
    }
  }
}

// `even` and `odd` in turn, from number `first` of a row on; a vector of one lane holds one of them.
template <typename Number>
HWY_INLINE VectorOf<Number> alternating(Number even, Number odd, std::size_t first) {
  const LanesOf<Number> d;
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(d, first % 2 == 0 ? even : odd);
#else
  (void)first;
  return hn::OddEven(hn::Set(d, odd), hn::Set(d, even));
#endif
}

// cosines, sines: the sums, block after block.
template <typename Number>
HWY_INLINE void set_coefficients(const std::vector<SlotFactors<Number>>& slots,
                                 const LaneSums<Number>* cosines, const LaneSums<Number>* sines,
                                 HarmonicCoefficients<Number>& of_cell) {
  const LanesOf<Number> d;
  for (std::size_t first = 0; first <= kNormDegree; first += kLanes<Number>) {
    std::array<VectorOf<Number>, kNormDegree + 1> a, b;
    for (std::size_t l = 0; l <= kNormDegree; ++l) a[l] = b[l] = hn::Zero(d);
    for (std::size_t slot = 0; slot < slots.size(); ++slot) {
      const LaneSums<Number>& of_even = cosines[slot / kLanesOfStep];
      const LaneSums<Number>& of_odd = sines[slot / kLanesOfStep];
      const std::size_t lane = slot % kLanesOfStep;
      const VectorOf<Number> of_cosines = hn::Load(d, slots[slot].cosines.data() + first);
      const VectorOf<Number> of_sines = hn::Load(d, slots[slot].sines.data() + first);
#pragma GCC unroll 16
      for (std::size_t l = 0; l <= kNormDegree; ++l) {
        // By order m.
        const VectorOf<Number> weight =
            alternating<Number>(of_even.of_degree[l][lane], of_odd.of_degree[l][lane], first);
        a[l] = hn::MulAdd(weight, of_cosines, a[l]);
        b[l] = hn::MulAdd(weight, of_sines, b[l]);
      }
    }
    for (int l = 0; l <= kNormDegree; ++l) {
      hn::StoreU(a[static_cast<std::size_t>(l)], d, &of_cell.A.number(l, static_cast<int>(first)));
      hn::StoreU(b[static_cast<std::size_t>(l)], d, &of_cell.B.number(l, static_cast<int>(first)));
    }
  }
}

// With A_l0 twice the coefficient a_l0, A_l(-m) = (-1)^m A_lm and B_l(-m) = -(-1)^m B_lm, the derivatives of
// a harmonic function have the coefficients
//   along z:  A'_lm = A_(l+1)m,                             B'_lm = B_(l+1)m
//   along x1: A'_lm = (A_(l+1)(m+1) - A_(l+1)(m-1)) / 2,    B'_lm = (B_(l+1)(m+1) - B_(l+1)(m-1)) / 2
//   along x2: A'_lm = (B_(l+1)(m+1) + B_(l+1)(m-1)) / 2,    B'_lm = -(A_(l+1)(m+1) + A_(l+1)(m-1)) / 2
// of_cell: changed.
template <typename Number>
HWY_NOINLINE void finish(HarmonicCoefficients<Number>& of_cell, Number tail, VolumeCell<Number>& cell) {
  static const HarmonicFactors<Number> factors;
  using V = VectorOf<Number>;
  const LanesOf<Number> d;
  DegreeRows<Number>& A = of_cell.A;
  DegreeRows<Number>& B = of_cell.B;
  for (int l = 0; l <= kNormDegree; ++l) {
    A.number(l, -1) = -A.number(l, 1);
    A.number(l, -2) = A.number(l, 2);
    A.number(l, -3) = -A.number(l, 3);
    B.number(l, -1) = B.number(l, 1);
    B.number(l, -2) = -B.number(l, 2);
    B.number(l, -3) = B.number(l, 3);
  }
  // a(l, m) and b(l, m): the coefficients from (l, m) on.
  const auto store = [&]<std::size_t kNumber>(int degree, std::array<Number, kNumber>& out, const auto& a,
                                              const auto& b) {
    for (int l = 0; l <= degree; ++l) {
      for (int m = 0; m <= l; m += static_cast<int>(kLanes<Number>)) {
        hn::StoreU(factors.scale.at(l, m) * a(l, m), d, &out[cosine_place(l, m)]);
      }
      for (int m = 1; m <= l; m += static_cast<int>(kLanes<Number>)) {
        hn::StoreU(factors.scale.at(l, m) * b(l, m), d, &out[sine_place(l, m)]);
      }
    }
  };
  const V half = set<Number>(0.5);
  const V quarter = set<Number>(0.25);
  const auto difference = [](const DegreeRows<Number>& rows, int l, int m, int by) {
    return rows.at(l, m + by) - rows.at(l, m - by);
  };
  const auto sum = [](const DegreeRows<Number>& rows, int l, int m, int by) {
    return rows.at(l, m + by) + rows.at(l, m - by);
  };
  store(
      kDegree, cell.f, [&](int l, int m) { return A.at(l, m); }, [&](int l, int m) { return B.at(l, m); });
  store(
      kDegree - 1, cell.f_1, [&](int l, int m) { return half * difference(A, l + 1, m, 1); },
      [&](int l, int m) { return half * difference(B, l + 1, m, 1); });
  store(
      kDegree - 1, cell.f_2, [&](int l, int m) { return half * sum(B, l + 1, m, 1); },
      [&](int l, int m) { return hn::Neg(half * sum(A, l + 1, m, 1)); });
  store(
      kDegree - 1, cell.f_3, [&](int l, int m) { return A.at(l + 1, m); },
      [&](int l, int m) { return B.at(l + 1, m); });
  const V two = set<Number>(2.0);
  store(
      kDegree - 2, cell.f_11,
      [&](int l, int m) { return quarter * hn::NegMulAdd(two, A.at(l + 2, m), sum(A, l + 2, m, 2)); },
      [&](int l, int m) { return quarter * hn::NegMulAdd(two, B.at(l + 2, m), sum(B, l + 2, m, 2)); });
  store(
      kDegree - 2, cell.f_12, [&](int l, int m) { return quarter * difference(B, l + 2, m, 2); },
      [&](int l, int m) { return hn::Neg(quarter * difference(A, l + 2, m, 2)); });
  store(
      kDegree - 2, cell.f_13, [&](int l, int m) { return half * difference(A, l + 2, m, 1); },
      [&](int l, int m) { return half * difference(B, l + 2, m, 1); });
  store(
      kDegree - 2, cell.f_23, [&](int l, int m) { return half * sum(B, l + 2, m, 1); },
      [&](int l, int m) { return hn::Neg(half * sum(A, l + 2, m, 1)); });
  store(
      kDegree - 2, cell.f_33, [&](int l, int m) { return A.at(l + 2, m); },
      [&](int l, int m) { return B.at(l + 2, m); });
  const V eighth = set<Number>(0.125);
  const V three = set<Number>(3.0);
  store(
      kThirdDegree, cell.f_111,
      [&](int l, int m) {
        return eighth * hn::NegMulAdd(three, difference(A, l + 3, m, 1), difference(A, l + 3, m, 3));
      },
      [&](int l, int m) {
        return eighth * hn::NegMulAdd(three, difference(B, l + 3, m, 1), difference(B, l + 3, m, 3));
      });
  store(
      kThirdDegree, cell.f_112,
      [&](int l, int m) { return eighth * (sum(B, l + 3, m, 3) - sum(B, l + 3, m, 1)); },
      [&](int l, int m) { return eighth * (sum(A, l + 3, m, 1) - sum(A, l + 3, m, 3)); });
  store(
      kThirdDegree, cell.f_113,
      [&](int l, int m) { return quarter * hn::NegMulAdd(two, A.at(l + 3, m), sum(A, l + 3, m, 2)); },
      [&](int l, int m) { return quarter * hn::NegMulAdd(two, B.at(l + 3, m), sum(B, l + 3, m, 2)); });
  store(
      kThirdDegree, cell.f_123, [&](int l, int m) { return quarter * difference(B, l + 3, m, 2); },
      [&](int l, int m) { return hn::Neg(quarter * difference(A, l + 3, m, 2)); });
  store(
      kThirdDegree, cell.f_133, [&](int l, int m) { return half * difference(A, l + 3, m, 1); },
      [&](int l, int m) { return half * difference(B, l + 3, m, 1); });
  store(
      kThirdDegree, cell.f_233, [&](int l, int m) { return half * sum(B, l + 3, m, 1); },
      [&](int l, int m) { return hn::Neg(half * sum(A, l + 3, m, 1)); });
  store(
      kThirdDegree, cell.f_333, [&](int l, int m) { return A.at(l + 3, m); },
      [&](int l, int m) { return B.at(l + 3, m); });
  // By Cauchy's inequality and the addition theorem for spherical harmonics.
  for (int l = 0; l <= kNormDegree; ++l) {
    V squares = hn::Zero(d);
    for (int m = 0; m <= l; m += static_cast<int>(kLanes<Number>)) {
      const V both = hn::MulAdd(A.at(l, m), A.at(l, m), B.at(l, m) * B.at(l, m));
      squares = hn::MulAdd(factors.norm.at(l, m), both, squares);
    }
    cell.bounds.sigma[static_cast<std::size_t>(l)] = std::sqrt(sum_of_lanes(squares));
  }
  cell.bounds.tail = tail;
}

template <typename Number>
struct SurfaceValues {
  VectorOf<Number> eta, eta_1, eta_2, eta_11, eta_12, eta_22;
  VectorOf<Number> third;  // bound on the operator norm of the third derivative, without `third_rest`
};

template <typename Number>
struct VolumeValues {
  VectorOf<Number> f, f_1, f_2, f_3, f_11, f_12, f_13, f_23, f_33;
  VectorOf<Number> third;  // bound on the operator norm of the third derivative, without `third_rest`
};

// Horner's scheme in two variables.
template <int kTo, typename Number, std::size_t kNumber>
HWY_INLINE VectorOf<Number> polynomial(const std::array<Number, kNumber>& terms, const VectorOf<Number>& x1,
                                       const VectorOf<Number>& x2) {
  const LanesOf<Number> d;
  auto sum = hn::Set(d, terms[monomial_place(0, kTo)]);
#pragma GCC unroll 16
  for (int q = kTo - 1; q >= 0; --q) {
    auto row = hn::Set(d, terms[monomial_place(kTo - q, q)]);
#pragma GCC unroll 16
    for (int p = kTo - q - 1; p >= 0; --p) {
      row = hn::MulAdd(row, x1, hn::Set(d, terms[monomial_place(p, q)]));
    }
    sum = hn::MulAdd(sum, x2, row);
  }
  return sum;
}

// A bound on the operator norm of a symmetric 2 x 2 x 2 tensor: its part without a trace t has the norm
// |(t_111, t_112)|, and a vector v times the metric that of v.
template <typename Number>
HWY_INLINE VectorOf<Number> norm_of_third(const VectorOf<Number>& t111, const VectorOf<Number>& t112,
                                          const VectorOf<Number>& t122, const VectorOf<Number>& t222) {
  const auto quarter = set<Number>(0.25);
  const auto three = set<Number>(3.0);
  const auto v1 = t111 + t122;
  const auto v2 = t112 + t222;
  const auto w1 = hn::NegMulAdd(three, t122, t111);
  const auto w2 = hn::MulSub(three, t112, t222);
  return quarter * (three * hn::Sqrt(hn::MulAdd(v1, v1, v2 * v2)) + hn::Sqrt(hn::MulAdd(w1, w1, w2 * w2)));
}

// x1, x2: from the cell's centre, over 1 / k_max.
template <typename Number>
HWY_INLINE SurfaceValues<Number> evaluate(const SurfaceCell<Number>& cell, const VectorOf<Number>& x1,
                                          const VectorOf<Number>& x2) {
  return {polynomial<kDegree, Number>(cell.eta, x1, x2),
          polynomial<kDegree - 1, Number>(cell.eta_1, x1, x2),
          polynomial<kDegree - 1, Number>(cell.eta_2, x1, x2),
          polynomial<kDegree - 2, Number>(cell.eta_11, x1, x2),
          polynomial<kDegree - 2, Number>(cell.eta_12, x1, x2),
          polynomial<kDegree - 2, Number>(cell.eta_22, x1, x2),
          norm_of_third<Number>(polynomial<kThirdDegree, Number>(cell.eta_111, x1, x2),
                                polynomial<kThirdDegree, Number>(cell.eta_112, x1, x2),
                                polynomial<kThirdDegree, Number>(cell.eta_122, x1, x2),
                                polynomial<kThirdDegree, Number>(cell.eta_222, x1, x2))};
}

template <typename Number>
HWY_INLINE VolumeValues<Number> evaluate(const VolumeCell<Number>& cell, const VectorOf<Number>& x1,
                                         const VectorOf<Number>& x2, const VectorOf<Number>& z) {
  const LanesOf<Number> d;
  using V = VectorOf<Number>;
  std::array<V, harmonics_to(kDegree)> u;
  const V r_squared = hn::MulAdd(x1, x1, hn::MulAdd(x2, x2, z * z));
  u[0] = set<Number>(1.0);
#pragma GCC unroll 16
  for (int m = 0; m <= kDegree; ++m) {
    if (m == 1) {
      u[cosine_place(1, 1)] = x1;
      u[sine_place(1, 1)] = x2;
    } else if (m > 1) {
      const V cosine = u[cosine_place(m - 1, m - 1)];
      const V sine = u[sine_place(m - 1, m - 1)];
      u[cosine_place(m, m)] = hn::MulSub(x1, cosine, x2 * sine);
      u[sine_place(m, m)] = hn::MulAdd(x1, sine, x2 * cosine);
    }
#pragma GCC unroll 16
    for (int l = m + 1; l <= kDegree; ++l) {
      if (l == m + 1) {
        u[cosine_place(l, m)] = z * u[cosine_place(l - 1, m)];
        if (m > 0) u[sine_place(l, m)] = z * u[sine_place(l - 1, m)];
      } else {
        const V lower = set<Number>(descent_of(l, m)) * r_squared;
        u[cosine_place(l, m)] = hn::MulSub(z, u[cosine_place(l - 1, m)], lower * u[cosine_place(l - 2, m)]);
        if (m > 0) {
          u[sine_place(l, m)] = hn::MulSub(z, u[sine_place(l - 1, m)], lower * u[sine_place(l - 2, m)]);
        }
      }
    }
  }
  const V zero = hn::Zero(d);
  VolumeValues<Number> v{zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
  V f_111 = zero, f_112 = zero, f_113 = zero, f_123 = zero, f_133 = zero, f_233 = zero, f_333 = zero;
  const auto add = [&](std::size_t t, V& sum, const auto& terms)
                       HWY_ATTR { sum = hn::MulAdd(u[t], hn::Set(d, terms[t]), sum); };
  for (std::size_t t = 0; t < harmonics_to(kThirdDegree); ++t) {
    add(t, f_111, cell.f_111);
    add(t, f_112, cell.f_112);
    add(t, f_113, cell.f_113);
    add(t, f_123, cell.f_123);
    add(t, f_133, cell.f_133);
    add(t, f_233, cell.f_233);
    add(t, f_333, cell.f_333);
  }
  // A harmonic function's third derivative has no trace. Its operator norm is at most sqrt(2/5) times its
  // Frobenius norm.
  const V f_122 = hn::Neg(f_111 + f_133);
  const V f_222 = hn::Neg(f_112 + f_233);
  const V f_223 = hn::Neg(f_113 + f_333);
  const V once = hn::MulAdd(f_111, f_111, hn::MulAdd(f_222, f_222, f_333 * f_333));
  const V thrice = hn::MulAdd(f_112, f_112, f_113 * f_113) + hn::MulAdd(f_122, f_122, f_223 * f_223) +
                   hn::MulAdd(f_133, f_133, f_233 * f_233);
  const V squares = hn::MulAdd(set<Number>(3.0), thrice, hn::MulAdd(set<Number>(6.0) * f_123, f_123, once));
  v.third = hn::Sqrt(set<Number>(0.4) * squares);
  for (std::size_t t = 0; t < harmonics_to(kDegree - 2); ++t) {
    add(t, v.f, cell.f);
    add(t, v.f_1, cell.f_1);
    add(t, v.f_2, cell.f_2);
    add(t, v.f_3, cell.f_3);
    add(t, v.f_11, cell.f_11);
    add(t, v.f_12, cell.f_12);
    add(t, v.f_13, cell.f_13);
    add(t, v.f_23, cell.f_23);
    add(t, v.f_33, cell.f_33);
  }
  for (std::size_t t = harmonics_to(kDegree - 2); t < harmonics_to(kDegree - 1); ++t) {
    add(t, v.f, cell.f);
    add(t, v.f_1, cell.f_1);
    add(t, v.f_2, cell.f_2);
    add(t, v.f_3, cell.f_3);
  }
  // Two sums, since one alone would wait for each addition.
  V f_odd = zero;
  for (std::size_t t = harmonics_to(kDegree - 1); t + 1 < harmonics_to(kDegree); t += 2) {
    add(t, v.f, cell.f);
    add(t + 1, f_odd, cell.f);
  }
  add(harmonics_to(kDegree) - 1, v.f, cell.f);
  v.f = v.f + f_odd;
  return v;
}

template <int kExponent, typename V>
HWY_INLINE V power(const V& x) {
  if constexpr (kExponent == 1) {
    return x;
  } else if constexpr (kExponent % 2 == 0) {
    const V root = power<kExponent / 2>(x);
    return root * root;
  } else {
    return power<kExponent - 1>(x) * x;
  }
}

static_assert(kNormDegree == kDegree + 2, "e_0 has two degrees with a norm, and the tail");

// What the polynomials of a cell leave out and how fast they vary, at distances up to `reach` (over 1 /
// k_max) from its centre.
template <typename Number>
struct ReachBounds {
  VectorOf<Number> truncation;  // [m], e_0
  VectorOf<Number> slope;       // [m k_max], e_1
  VectorOf<Number> third;       // [m k_max^3], G_3
  VectorOf<Number> fourth;      // [m k_max^4], G_4
  VectorOf<Number> third_rest;  // [m k_max^3], what of G_3 has a degree above kThirdDegree
  VectorOf<Number> sum;         // [m], sum of sigma_l reach^l
  VectorOf<Number> tail;        // [m k_max^(kNormDegree + 1)], of the power of `reach` in e_0
};

// What the third derivative of degree kThirdDegree leaves out at a distance from the centre [m k_max^3].
template <typename Number>
HWY_INLINE VectorOf<Number> third_rest_at(const CellBounds<Number>& bounds, const VectorOf<Number>& reach) {
  static_assert(kDegree == kThirdDegree + 4, "one degree is left out");
  return set<Number>(1.0 * kDegree * (kDegree - 1) * (kDegree - 2)) *
         hn::Set(LanesOf<Number>(), bounds.sigma[kDegree]) * power<kDegree - 3>(reach);
}

template <typename Number>
HWY_INLINE ReachBounds<Number> bounds_at(const CellBounds<Number>& bounds, const VectorOf<Number>& reach) {
  const LanesOf<Number> d;
  const auto sigma = [&](int l) { return hn::Set(d, bounds.sigma[static_cast<std::size_t>(l)]); };
  ReachBounds<Number> result;
  result.sum = sigma(kDegree);
  result.third = set<Number>(1.0 * kDegree * (kDegree - 1) * (kDegree - 2)) * sigma(kDegree);
  result.fourth = set<Number>(1.0 * kDegree * (kDegree - 1) * (kDegree - 2) * (kDegree - 3)) * sigma(kDegree);
  result.third_rest = result.third;
#pragma GCC unroll 16
  for (int l = kDegree - 1; l >= 0; --l) {
    result.sum = hn::MulAdd(result.sum, reach, sigma(l));
    if (l >= 4) {
      result.fourth =
          hn::MulAdd(result.fourth, reach, set<Number>(1.0 * l * (l - 1) * (l - 2) * (l - 3)) * sigma(l));
    }
    if (l >= 3) {
      if (l == kThirdDegree + 3) result.third_rest = result.third;
      result.third = hn::MulAdd(result.third, reach, set<Number>(1.0 * l * (l - 1) * (l - 2)) * sigma(l));
    }
  }
  // From the terms above kThirdDegree to the power of theirs.
  result.third_rest = result.third_rest * power<kThirdDegree + 1>(reach);
  // Degrees above kNormDegree: a geometric series, which ends where the ratio reaches one.
  constexpr int kTail = kNormDegree + 1;
  const auto one = set<Number>(1.0);
  const auto ratio = [&](int order) {
    const auto rest = one - reach * set<Number>(1.0 / (kTail + 1 - order));
    const auto inverse = one / hn::Max(rest, set<Number>(1e-30));
    return hn::IfThenElse(rest > set<Number>(0.0), inverse, set<Number>(1e30));
  };
  const auto highest_power = power<kDegree>(reach);
  const auto squared = reach * reach;
  const auto tail = hn::Set(d, bounds.tail) * squared;
  result.tail = hn::Set(d, bounds.tail) * ratio(0);
  result.truncation = highest_power * reach *
                      (hn::MulAdd(sigma(kNormDegree), reach, sigma(kDegree + 1)) + result.tail * squared);
  result.slope = highest_power * (set<Number>(kDegree + 1) * sigma(kDegree + 1) +
                                  set<Number>(kNormDegree) * sigma(kNormDegree) * reach +
                                  set<Number>(kTail) * tail * ratio(1));
  return result;
}

// A bound on the mean of e_0 over a patch whose points are at most reach + extent * |y| / r from the cell's
// centre, y from the patch's centroid and r the largest |y| (Lemma 3b). farthest: at reach + extent. spread:
// the root mean square of |y| / r.
template <typename Number>
HWY_INLINE VectorOf<Number> mean_truncation(const CellBounds<Number>& bounds,
                                            const ReachBounds<Number>& farthest,
                                            const VectorOf<Number>& reach, const VectorOf<Number>& extent,
                                            const VectorOf<Number>& spread) {
  const LanesOf<Number> d;
  const auto first = hn::Set(d, bounds.sigma[kDegree + 1]);
  const auto second = hn::Set(d, bounds.sigma[kNormDegree]);
  const auto tail = farthest.tail * reach;
  const auto highest_power = power<kDegree>(reach);
  const auto at_centroid = highest_power * reach * hn::MulAdd(second + tail, reach, first);
  const auto above_first = hn::MulAdd(set<Number>(kNormDegree + 1), tail, set<Number>(kNormDegree) * second);
  const auto linear =
      extent * highest_power * hn::MulAdd(above_first, reach, set<Number>(kDegree + 1) * first);
  const auto above = farthest.truncation - at_centroid - linear;
  return hn::MulAdd(spread, hn::MulAdd(spread, above, linear), at_centroid);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_FIELD_INL_H
