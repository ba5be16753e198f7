// The coefficients of a cell's polynomials and of their derivatives, from the sums over the components, with
// SIMD (docs/wave_mathematics.md, "Expansions"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_COEFFICIENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_COEFFICIENTS_INL_H
#undef BUOYANCY_WAVE_COEFFICIENTS_INL_H
#else
#define BUOYANCY_WAVE_COEFFICIENTS_INL_H
#endif

#include <array>
#include <cstddef>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/sea_expansion.h"
#include "wave_loads/wave_cells-inl.h"

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
    cell.bounds.sigma[static_cast<std::size_t>(l)] = hn::GetLane(hn::Sqrt(hn::SumOfLanes(d, squares)));
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
    cell.bounds.sigma[static_cast<std::size_t>(l)] = hn::GetLane(hn::Sqrt(hn::SumOfLanes(d, squares)));
  }
  cell.bounds.tail = tail;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_COEFFICIENTS_INL_H
