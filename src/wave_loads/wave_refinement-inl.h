// Which patches are refined (docs/wave_mathematics.md, "Refinement"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_REFINEMENT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_REFINEMENT_INL_H
#undef BUOYANCY_WAVE_REFINEMENT_INL_H
#else
#define BUOYANCY_WAVE_REFINEMENT_INL_H
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_results-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// A child's error is about the sum of its siblings' and its own over this.
inline constexpr double kChildrenAbove = 4.0;

// The sum of the errors that can be expected once all above `limit` are refined as often as needed. Where
// patches are small the error of each falls with the third to fifth power of their size, and the sum over
// them with the second or third: as the power 0.6 of each one's.
template <typename Number>
HWY_INLINE double predicted(const std::vector<Number>& errors, const std::vector<Number>& expected,
                            Number limit) {
  const LanesOf<Number> d;
  VectorOf<Number> sum = hn::Zero(d);
  constexpr double kEach = 4.0;
  const VectorOf<Number> of_sum = set<Number>(0.435);  // kEach to the power -0.6
  constexpr std::size_t kLevels = 7;
  std::array<VectorOf<Number>, kLevels> limits;
  limits[0] = hn::Set(d, limit) * set<Number>(kChildrenAbove);
  for (std::size_t level = 1; level < kLevels; ++level)
    limits[level] = limits[level - 1] * set<Number>(kEach);
  for (std::size_t n = 0; n < errors.size(); n += kLanes<Number>) {
    const VectorOf<Number> error = hn::LoadU(d, &errors[n]);
    const VectorOf<Number> of_children = hn::LoadU(d, &expected[n]);
    VectorOf<Number> left = of_children;
    for (std::size_t level = 0; level < kLevels; ++level) {
      left = hn::IfThenElse(hn::Gt(of_children, limits[level]), left * of_sum, left);
    }
    sum = sum + hn::IfThenElse(hn::Gt(error, hn::Set(d, limit)), left, error);
  }
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum)));
}

// The error above which patches are refined, so that the sum of the errors can be expected to fit the budget.
template <typename Number>
double refinement_limit(const std::vector<Number>& errors, const std::vector<Number>& expected,
                        double budget) {
  Number largest = 0;
  for (const Number error : errors) largest = std::max(largest, error);
  Number low = static_cast<Number>(1e-12) * largest;
  Number high = static_cast<Number>(0.999) * largest;
  constexpr double kMargin = 0.95;
  for (int step = 0; step < 12; ++step) {
    const Number middle = std::sqrt(low * high);
    (predicted(errors, expected, middle) <= kMargin * budget ? low : high) = middle;
  }
  return static_cast<double>(low);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_REFINEMENT_INL_H
