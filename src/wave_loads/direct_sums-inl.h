// Elevation and wave pressure at many points by sums over all components, with SIMD: lanes are points.
// Included once per instruction set, after highway.h.
#if defined(BUOYANCY_DIRECT_SUMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_DIRECT_SUMS_INL_H
#undef BUOYANCY_DIRECT_SUMS_INL_H
#else
#define BUOYANCY_DIRECT_SUMS_INL_H
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/direct_sea.h"
#include "wave_loads/wave_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {
namespace direct {

// Points that are evaluated together; as many as are summed up before sums are added pairwise.
inline constexpr std::size_t kPointBlock = 256;

template <typename Number>
struct SeaPoints {
  // [m]: from the body's centre along the horizontal axes, and the height over the level.
  alignas(64) std::array<Number, kPointBlock> x1, x2, zeta;
  alignas(64) std::array<Number, kPointBlock> eta;  // [m], result
  alignas(64) std::array<Number, kPointBlock> f;    // [m], result: sum of a E(z') cos(theta), at z' = 0 above
};

// Per group of components, the sums of a cos(theta) at as many points as there are lanes.
template <typename Number>
struct alignas(64) GroupSum {
  std::array<Number, kLanes<Number>> lanes;
};

// The terms of the Taylor series that are below the rounding error of Number in the range that is used.
template <typename Number>
inline constexpr std::size_t kSineTerms = sizeof(Number) == sizeof(float) ? 6 : 11;
template <typename Number>
inline constexpr std::size_t kPowerTerms = sizeof(Number) == sizeof(float) ? 8 : 14;

// Of sin(2 pi y) / y in powers of y^2.
template <typename Number>
inline constexpr auto kSineSeries = [] {
  constexpr double kTurn = 6.283185307179586;
  std::array<Number, kSineTerms<Number>> series{};
  double term = kTurn;
  for (std::size_t i = 0; i < series.size(); ++i) {
    series[i] = static_cast<Number>(term);
    const auto n = static_cast<double>(2 * i + 2);
    term *= -kTurn * kTurn / (n * (n + 1.0));
  }
  return series;
}();
// Of 2^x in powers of x.
template <typename Number>
inline constexpr auto kPowerSeries = [] {
  constexpr double kLog2 = 0.6931471805599453;
  std::array<Number, kPowerTerms<Number>> series{};
  double term = 1.0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    series[i] = static_cast<Number>(term);
    term *= kLog2 / static_cast<double>(i + 1);
  }
  return series;
}();

template <typename Number, std::size_t kTerms>
HWY_INLINE VectorOf<Number> horner(const std::array<Number, kTerms>& series, const VectorOf<Number>& x) {
  const LanesOf<Number> d;
  auto sum = hn::Set(d, series[kTerms - 1]);
#pragma GCC unroll 16
  for (std::size_t i = 2; i <= kTerms; ++i) sum = hn::MulAdd(sum, x, hn::Set(d, series[kTerms - i]));
  return sum;
}

template <typename Number>
inline constexpr int kMantissaBits = std::numeric_limits<Number>::digits - 1;
// Added to a number of fewer than kMantissaBits - 1 bits before the point, it rounds it to a whole number,
// which are then the lowest bits of the sum.
template <typename Number>
inline constexpr double kRounder = 1.5 * static_cast<double>(std::uint64_t{1} << kMantissaBits<Number>);

// amplitude cos(turns), turns in turns, added to `sum`.
template <typename Number>
HWY_INLINE VectorOf<Number> add_cosine(const VectorOf<Number>& amplitude, const VectorOf<Number>& turns,
                                       const VectorOf<Number>& sum) {
  const auto rounder = set<Number>(kRounder<Number>);
  const auto rest = turns - ((turns + rounder) - rounder);
  const auto y = set<Number>(0.25) - hn::Abs(rest);  // cos(rest) = sin(y), |y| <= 1/4
  return hn::MulAdd(horner<Number>(kSineSeries<Number>, y * y), amplitude * y, sum);
}

// 2^x; x below the exponents of Number's numbers gives about 0.
template <typename Number>
HWY_INLINE VectorOf<Number> power_of_two(const VectorOf<Number>& x) {
  const LanesOf<Number> d;
  const hn::RebindToUnsigned<LanesOf<Number>> bits;
  constexpr double kLimit = std::numeric_limits<Number>::max_exponent - 2;
  const auto rounder = set<Number>(kRounder<Number>);
  const auto within = hn::Min(hn::Max(x, set<Number>(-kLimit)), set<Number>(kLimit));
  const auto shifted = within + rounder;
  const auto rest = within - (shifted - rounder);
  const auto one = hn::BitCast(bits, set<Number>(1.0));
  const auto scale = hn::BitCast(d, hn::ShiftLeft<kMantissaBits<Number>>(hn::BitCast(bits, shifted)) + one);
  return horner<Number>(kPowerSeries<Number>, rest) * scale;
}

// Sets eta, and f unless `group_sums` is null, of the first `count` points. Reads points up to the next
// multiple of the number of lanes.
template <typename Number>
HWY_NOINLINE void evaluate_sea(const DirectSea<Number>& sea, std::size_t count, SeaPoints<Number>& points,
                               GroupSum<Number>* group_sums) {
  using Group = typename DirectSea<Number>::Group;
  constexpr std::size_t kTogether = DirectSea<Number>::kMaxGroup;  // groups, as with components
  const LanesOf<Number> d;
  const auto zero = hn::Zero(d);
  const auto* const components = sea.components.data();
  const Group* const groups = sea.groups.data();
  const std::size_t number = sea.groups.size();
  for (std::size_t first = 0; first < count; first += kLanes<Number>) {
    const auto x1 = hn::Load(d, points.x1.data() + first);
    const auto x2 = hn::Load(d, points.x2.data() + first);
    auto eta = zero;
    std::size_t i = 0;
    for (std::size_t begin = 0; begin < number; begin += kTogether) {
      auto of_groups = zero;
      for (std::size_t g = begin; g < std::min(number, begin + kTogether); ++g) {
        auto sum = zero;
        for (; i < groups[g].end; ++i) {
          const auto& c = components[i];
          const auto turns =
              hn::MulAdd(hn::Set(d, c.k1), x1, hn::MulAdd(hn::Set(d, c.k2), x2, hn::Set(d, c.phase)));
          sum = add_cosine<Number>(hn::Set(d, c.amplitude), turns, sum);
        }
        of_groups = of_groups + sum;
        if (group_sums != nullptr) hn::Store(sum, d, group_sums[g].lanes.data());
      }
      eta = eta + of_groups;
    }
    hn::Store(eta, d, points.eta.data() + first);
    if (group_sums == nullptr) continue;

    const auto one = set<Number>(1.0);
    const auto s = hn::Min(hn::Load(d, points.zeta.data() + first) - eta, zero);
    const auto column = hn::MulAdd(eta, hn::Set(d, sea.per_depth), one);
    const auto bed = hn::Set(d, sea.bed);
    const auto z = hn::IfThenElse(hn::Gt(column, zero), hn::Max(s / column, bed), bed);
    auto f = zero;
    for (std::size_t begin = 0; begin < number; begin += kTogether) {
      auto of_groups = zero;
      for (std::size_t g = begin; g < std::min(number, begin + kTogether); ++g) {
        const Group& group = groups[g];
        const auto exponent = hn::Set(d, group.rate) * z;
        auto decay = power_of_two<Number>(exponent);
        if (group.bed_matters) {
          decay = decay + power_of_two<Number>(hn::Neg(exponent) - hn::Set(d, group.twice_depth));
        }
        const auto sum = hn::Load(d, group_sums[g].lanes.data());
        of_groups = hn::MulAdd(decay, hn::Set(d, group.scale) * sum, of_groups);
      }
      f = f + of_groups;
    }
    hn::Store(f, d, points.f.data() + first);
  }
}

}  // namespace direct
}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_DIRECT_SUMS_INL_H
