// The sea at points of a cell: values, derivatives and bounds, with SIMD (docs/wave_mathematics.md,
// "Expansions"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_FIELD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_FIELD_INL_H
#undef BUOYANCY_WAVE_FIELD_INL_H
#else
#define BUOYANCY_WAVE_FIELD_INL_H
#endif

#include <array>
#include <cstddef>

#include <hwy/highway.h>

#include "wave_loads/sea_expansion.h"
#include "wave_loads/wave_cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

template <typename Number>
struct SurfaceValues {
  VectorOf<Number> eta, eta_1, eta_2, eta_11, eta_12, eta_22;
};

template <typename Number>
struct VolumeValues {
  VectorOf<Number> f, f_1, f_2, f_3, f_11, f_12, f_13, f_23, f_33;
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

// x1, x2: from the cell's centre, over 1 / k_max.
template <typename Number>
HWY_INLINE SurfaceValues<Number> evaluate(const SurfaceCell<Number>& cell, const VectorOf<Number>& x1,
                                          const VectorOf<Number>& x2) {
  return {polynomial<kDegree, Number>(cell.eta, x1, x2),
          polynomial<kDegree - 1, Number>(cell.eta_1, x1, x2),
          polynomial<kDegree - 1, Number>(cell.eta_2, x1, x2),
          polynomial<kDegree - 2, Number>(cell.eta_11, x1, x2),
          polynomial<kDegree - 2, Number>(cell.eta_12, x1, x2),
          polynomial<kDegree - 2, Number>(cell.eta_22, x1, x2)};
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
  VolumeValues<Number> v{zero, zero, zero, zero, zero, zero, zero, zero, zero};
  const auto add = [&](std::size_t t, V& sum, const auto& terms) {
    sum = hn::MulAdd(u[t], hn::Set(d, terms[t]), sum);
  };
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
  for (std::size_t t = harmonics_to(kDegree - 1); t < harmonics_to(kDegree); ++t) add(t, v.f, cell.f);
  return v;
}

// What the polynomials of a cell leave out and how fast they vary, at distances up to `reach` (over 1 /
// k_max) from its centre.
template <typename Number>
struct ReachBounds {
  VectorOf<Number> truncation;  // [m], e_0
  VectorOf<Number> slope;       // [m k_max], e_1
  VectorOf<Number> third;       // [m k_max^3], G_3
  VectorOf<Number> sum;         // [m], sum of sigma_l reach^l
};

template <typename Number>
HWY_INLINE ReachBounds<Number> bounds_at(const CellBounds<Number>& bounds, const VectorOf<Number>& reach) {
  const LanesOf<Number> d;
  const auto sigma = [&](int l) { return hn::Set(d, bounds.sigma[static_cast<std::size_t>(l)]); };
  ReachBounds<Number> result;
  result.sum = sigma(kDegree);
  result.third = set<Number>(1.0 * kDegree * (kDegree - 1) * (kDegree - 2)) * sigma(kDegree);
#pragma GCC unroll 16
  for (int l = kDegree - 1; l >= 0; --l) {
    result.sum = hn::MulAdd(result.sum, reach, sigma(l));
    if (l >= 3) {
      result.third = hn::MulAdd(result.third, reach, set<Number>(1.0 * l * (l - 1) * (l - 2)) * sigma(l));
    }
  }
  // Degrees above kNormDegree: a geometric series, which ends where the ratio reaches one.
  constexpr int kTail = kNormDegree + 1;
  const auto one = set<Number>(1.0);
  const auto ratio = [&](int order) {
    const auto rest = one - reach * set<Number>(1.0 / (kTail + 1 - order));
    const auto inverse = one / hn::Max(rest, set<Number>(1e-30));
    return hn::IfThenElse(rest > set<Number>(0.0), inverse, set<Number>(1e30));
  };
  auto power = reach;  // reach^kDegree
  for (int l = 1; l < kDegree; ++l) power = power * reach;
  const auto tail = hn::Set(d, bounds.tail) * reach * reach;
  result.truncation =
      power * reach * (hn::MulAdd(sigma(kDegree + 2), reach, sigma(kDegree + 1)) + tail * ratio(0));
  result.slope =
      power * (set<Number>(kDegree + 1) * sigma(kDegree + 1) +
               set<Number>(kDegree + 2) * sigma(kDegree + 2) * reach + set<Number>(kTail) * tail * ratio(1));
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_FIELD_INL_H
