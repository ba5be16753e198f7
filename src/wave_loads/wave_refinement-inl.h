// Which patches are refined (docs/wave_mathematics.md, "Refinement"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_REFINEMENT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_REFINEMENT_INL_H
#undef BUOYANCY_WAVE_REFINEMENT_INL_H
#else
#define BUOYANCY_WAVE_REFINEMENT_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Children's errors: together a sixth of their parent's, each a twentieth, on wet and crossing patches.
inline constexpr double kTotalDecay = 6.0;
inline constexpr double kEachDecay = 20.0;

// The sum of the errors that can be expected once all above `limit` are refined as often as needed.
template <typename Number>
double predicted(const std::vector<Number>& errors, double total, double limit) {
  double sum = total;
  for (const Number of_result : errors) {
    const auto before = static_cast<double>(of_result);
    if (!(before > limit)) continue;
    double error = before;
    for (double each = before; each > limit && error > 1e-30; each /= kEachDecay) error /= kTotalDecay;
    sum += error - before;
  }
  return sum;
}

// The error above which patches are refined, so that the sum of the errors can be expected to fit the budget.
template <typename Number>
double refinement_limit(const std::vector<Number>& errors, double total, double budget) {
  Number largest = 0;
  for (const Number error : errors) largest = std::max(largest, error);
  double low = std::log(1e-12 * static_cast<double>(largest));
  double high = std::log(static_cast<double>(largest) * 0.999);
  constexpr double kMargin = 0.8;
  for (int step = 0; step < 12; ++step) {
    const double middle = 0.5 * (low + high);
    (predicted(errors, total, std::exp(middle)) <= kMargin * budget ? low : high) = middle;
  }
  return std::exp(low);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_REFINEMENT_INL_H
