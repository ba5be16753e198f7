// Cells: expansions of the sea about points, built with SIMD (docs/wave_mathematics.md, "Expansions").
// Included once per instruction set, after highway.h.
//
// Lengths within a cell are in units of 1 / k_max. Coefficients are summed with neighbouring terms in the
// lanes, so that a cell costs the same whether it is built alone or with others.
#if defined(BUOYANCY_WAVE_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_CELLS_INL_H
#undef BUOYANCY_WAVE_CELLS_INL_H
#else
#define BUOYANCY_WAVE_CELLS_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "wave_loads/sea_expansion.h"
#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_phases-inl.h"
#include "wave_loads/wave_query.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// A vector is stored at the place of its first number; the numbers behind it are overwritten by the next.
inline constexpr std::size_t kOverhang = 15;

// The degree of the third derivatives that are evaluated. The rest of them is bounded.
inline constexpr int kThirdDegree = 4;

// Bounds on what an expansion leaves out and on its derivatives, from the norms sigma_l of its degrees.
template <typename Number>
struct CellBounds {
  std::array<Number, kNormDegree + 1> sigma;  // [m]
  Number tail;  // [m], sum of a (k / k_max)^(kNormDegree + 1) / (kNormDegree + 1)!
};

template <typename Number>
struct alignas(64) SurfaceCell {
  std::array<Number, monomials_to(kDegree) + kOverhang> eta;
  std::array<Number, monomials_to(kDegree - 1) + kOverhang> eta_1, eta_2;
  std::array<Number, monomials_to(kDegree - 2) + kOverhang> eta_11, eta_12, eta_22;
  std::array<Number, monomials_to(kThirdDegree) + kOverhang> eta_111, eta_112, eta_122, eta_222;
  CellBounds<Number> bounds;
};

template <typename Number>
struct alignas(64) VolumeCell {
  std::array<Number, harmonics_to(kDegree) + kOverhang> f;
  std::array<Number, harmonics_to(kDegree - 1) + kOverhang> f_1, f_2, f_3;
  std::array<Number, harmonics_to(kDegree - 2) + kOverhang> f_11, f_12, f_13, f_23, f_33;
  std::array<Number, harmonics_to(kThirdDegree) + kOverhang> f_111, f_112, f_113, f_123, f_133, f_233, f_333;
  CellBounds<Number> bounds;
};

struct CellCenter {
  double x1, x2, z;  // over 1 / k_max, from the body's centre and the level
};

// As many cells are built in one go, at most.
inline constexpr std::size_t kCellsTogether = 16;

template <typename Number>
struct CellWorkspace {
  std::vector<double> phases;  // at the body's centre, filled up
  // By cell, weight and component.
  std::array<std::array<std::vector<Number>, kWeights>, kCellsTogether> weights;
  std::vector<Number> theta;
  struct alignas(64) Sums {
    std::array<Number, kHarmonicColumns> columns;
  };
  std::array<Sums, kCellsTogether> sums;
  std::array<Number, kCellsTogether> tails;

  void reserve(std::size_t components) {
    theta.resize(components);
    for (auto& of_cell : weights) {
      for (auto& of_weight : of_cell) of_weight.resize(components);
    }
  }
};

// Sets the weights of all components at a cell's centre.
template <bool kSurface, typename Number>
HWY_NOINLINE void set_weights(const SeaExpansion& sea, const ExpansionTable<Number>& table, double factor,
                              bool deep_water, const CellCenter& center, std::size_t cell,
                              CellWorkspace<Number>& work) {
  const LanesOf<double> dd;
  for (std::size_t i = 0; i < sea.filled_components; i += kLanes<double>) {
    const VectorOf<double> along = hn::MulAdd(hn::LoadU(dd, &sea.k1[i]), set<double>(center.x1),
                                              hn::LoadU(dd, &sea.k2[i]) * set<double>(center.x2));
    const VectorOf<double> phase = within_turn(hn::LoadU(dd, &work.phases[i]) + along);
    if constexpr (sizeof(Number) == sizeof(double)) {
      hn::StoreU(phase, dd, &work.theta[i]);
    } else {
      const hn::Rebind<float, LanesOf<double>> df;
      hn::StoreU(hn::DemoteTo(df, phase), df, &work.theta[i]);
    }
  }
  const LanesOf<Number> d;
  auto& weights = work.weights[cell];
  const auto out = [&weights](Weight weight, std::size_t i) {
    return &weights[static_cast<std::size_t>(weight)][i];
  };
  VectorOf<Number> tail = hn::Zero(d);
  for (std::size_t i = 0; i < sea.filled_components; i += kLanes<Number>) {
    const VectorOf<Number> angle = hn::LoadU(d, &work.theta[i]);
    const VectorOf<Number> cosine = hn::Cos(d, angle);
    const VectorOf<Number> sine = hn::Sin(d, angle);
    VectorOf<Number> even;
    if constexpr (kSurface) {
      even = set<Number>(factor) * hn::LoadU(d, &table.amplitude[i]);
    } else {
      const VectorOf<Number> amplitude = set<Number>(factor) * hn::LoadU(d, &table.amplitude_in_f[i]);
      const VectorOf<Number> exponent = hn::LoadU(d, &table.k[i]) * set<Number>(center.z);
      const VectorOf<Number> down = amplitude * hn::Exp(d, exponent);
      if (deep_water) {
        even = down;
      } else {
        // cosh k(z + h) / cosh kh and sinh k(z + h) / cosh kh by exponentials that do not overflow.
        const VectorOf<Number> up = amplitude * hn::Exp(d, hn::LoadU(d, &table.minus_twice_kh[i]) - exponent);
        even = down + up;
        const VectorOf<Number> odd = down - up;
        hn::StoreU(odd * cosine, d, out(Weight::kCosineOdd, i));
        hn::StoreU(odd * sine, d, out(Weight::kSineOdd, i));
      }
    }
    hn::StoreU(even * cosine, d, out(Weight::kCosineEven, i));
    hn::StoreU(even * sine, d, out(Weight::kSineEven, i));
    tail = hn::MulAdd(even, hn::LoadU(d, &table.tail[i]), tail);
  }
  work.tails[cell] = hn::GetLane(hn::SumOfLanes(d, tail));
}

// Adds to sums the products of columns [kBegin, kEnd) of the components' rows with the weights of kCells
// cells.
template <std::size_t kCells, std::size_t kVectors, typename Number, std::size_t kColumns>
HWY_INLINE void add_products(const ExpansionRow<Number, kColumns>* rows, std::size_t first_column,
                             const std::array<const Number*, kCells>& weights, std::size_t begin,
                             std::size_t end, const std::array<Number*, kCells>& sums) {
  const LanesOf<Number> d;
  std::array<std::array<VectorOf<Number>, kVectors>, kCells> sum;
  for (auto& of_cell : sum) {
    for (auto& vector : of_cell) vector = hn::Zero(d);
  }
  for (std::size_t i = begin; i < end; ++i) {
    const Number* const row = rows[i].columns.data() + first_column;
    std::array<VectorOf<Number>, kCells> weight;
    for (std::size_t c = 0; c < kCells; ++c) weight[c] = hn::Set(d, weights[c][i]);
    for (std::size_t v = 0; v < kVectors; ++v) {
      const VectorOf<Number> entries = hn::Load(d, row + v * kLanes<Number>);
      for (std::size_t c = 0; c < kCells; ++c) sum[c][v] = hn::MulAdd(weight[c], entries, sum[c][v]);
    }
  }
  for (std::size_t c = 0; c < kCells; ++c) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      Number* const place = sums[c] + first_column + v * kLanes<Number>;
      hn::Store(hn::Load(d, place) + sum[c][v], d, place);
    }
  }
}

// The same for all columns of one weight.
template <std::size_t kCells, typename Number, std::size_t kColumns>
HWY_INLINE void add_products(const ExpansionRow<Number, kColumns>* rows, const ColumnRange& columns,
                             const std::array<const Number*, kCells>& weights, std::size_t begin,
                             std::size_t end, const std::array<Number*, kCells>& sums) {
  // Enough sums at a time to hide the latency of an addition, and few enough for the registers.
  constexpr std::size_t kLong = 3;
  constexpr std::size_t kShort = 2;
  std::size_t column = columns.begin;
  for (; (columns.end - column) % (kShort * kLanes<Number>) != 0; column += kLong * kLanes<Number>) {
    add_products<kCells, kLong>(rows, column, weights, begin, end, sums);
  }
  for (; column < columns.end; column += kShort * kLanes<Number>) {
    add_products<kCells, kShort>(rows, column, weights, begin, end, sums);
  }
}

// Sets the sums of all columns for `count` cells from their weights.
template <typename Number, std::size_t kColumns>
HWY_NOINLINE void accumulate(const std::vector<ExpansionRow<Number, kColumns>>& rows,
                             const std::array<ColumnRange, kWeights>& of_weight, bool deep_water,
                             std::size_t count, CellWorkspace<Number>& work) {
  for (std::size_t cell = 0; cell < count; ++cell) work.sums[cell].columns.fill(Number{0});
  // The rows of a block of components stay in the nearest cache while all cells pass. It also keeps the
  // chains of additions short.
  constexpr std::size_t kBlock = 48;
  for (std::size_t begin = 0; begin < rows.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, rows.size());
    const auto add = [&]<std::size_t kCells>(std::size_t first,
                                             std::integral_constant<std::size_t, kCells> /*number*/) {
      for (std::size_t w = 0; w < kWeights; ++w) {
        // In deep water the sinh is the cosh.
        const bool odd = w >= static_cast<std::size_t>(Weight::kCosineOdd);
        const std::size_t from = odd && deep_water ? w - 2 : w;
        std::array<const Number*, kCells> weights;
        std::array<Number*, kCells> sums;
        for (std::size_t c = 0; c < kCells; ++c) {
          weights[c] = work.weights[first + c][from].data();
          sums[c] = work.sums[first + c].columns.data();
        }
        add_products<kCells>(rows.data(), of_weight[w], weights, begin, end, sums);
      }
    };
    std::size_t cell = 0;
    for (; cell + 4 <= count; cell += 4) add(cell, std::integral_constant<std::size_t, 4>());
    for (; cell + 2 <= count; cell += 2) add(cell, std::integral_constant<std::size_t, 2>());
    for (; cell < count; ++cell) add(cell, std::integral_constant<std::size_t, 1>());
  }
}

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

template <typename Number>
HWY_NOINLINE void finish(const std::array<Number, kHarmonicColumns>& sums, Number tail,
                         SurfaceCell<Number>& cell) {
  static const MonomialFactors<Number> factors;
  const LanesOf<Number> d;
  DegreeRows<Number> e;
  const MonomialColumns& columns = monomial_columns();
  for (int l = 0; l <= kNormDegree; ++l) {
    for (int q = 0; q <= l; ++q) e.number(l, q) = sums[columns[monomial_place(l - q, q)]];
  }
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

// With A_l0 twice the coefficient a_l0, A_l(-m) = (-1)^m A_lm and B_l(-m) = -(-1)^m B_lm, the derivatives of
// a harmonic function have the coefficients
//   along z:  A'_lm = A_(l+1)m,                             B'_lm = B_(l+1)m
//   along x1: A'_lm = (A_(l+1)(m+1) - A_(l+1)(m-1)) / 2,    B'_lm = (B_(l+1)(m+1) - B_(l+1)(m-1)) / 2
//   along x2: A'_lm = (B_(l+1)(m+1) + B_(l+1)(m-1)) / 2,    B'_lm = -(A_(l+1)(m+1) + A_(l+1)(m-1)) / 2
template <typename Number>
HWY_NOINLINE void finish(const std::array<Number, kHarmonicColumns>& sums, Number tail,
                         VolumeCell<Number>& cell) {
  static const HarmonicFactors<Number> factors;
  using V = VectorOf<Number>;
  const LanesOf<Number> d;
  DegreeRows<Number> A, B;
  const HarmonicColumns& columns = harmonic_columns();
  for (int l = 0; l <= kNormDegree; ++l) {
    A.number(l, 0) = Number{2} * sums[columns[cosine_place(l, 0)]];
    for (int m = 1; m <= l; ++m) {
      A.number(l, m) = sums[columns[cosine_place(l, m)]];
      B.number(l, m) = sums[columns[sine_place(l, m)]];
    }
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

#endif  // BUOYANCY_WAVE_CELLS_INL_H
