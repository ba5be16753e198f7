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
#include <span>
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
// them with the second or third: about as the square root of each one's. A prediction that is too low costs
// another round, of few patches; one that is too high refines all of them too far, which costs more. roots:
// of the expected errors.
template <typename Number>
HWY_INLINE double predicted(std::span<const Number> errors, std::span<const Number> expected,
                            std::span<const Number> roots, Number limit) {
  const LanesOf<Number> d;
  constexpr double kShare = 0.25;
  const VectorOf<Number> root_of_limit =
      set<Number>(kShare) * hn::Sqrt(hn::Set(d, limit) * set<Number>(kChildrenAbove));
  VectorOf<Number> sum = hn::Zero(d);
  for (std::size_t n = 0; n < errors.size(); n += kLanes<Number>) {
    const VectorOf<Number> error = hn::LoadU(d, &errors[n]);
    const VectorOf<Number> left =
        hn::Min(hn::LoadU(d, &expected[n]), hn::LoadU(d, &roots[n]) * root_of_limit);
    sum = sum + hn::IfThenElse(hn::Gt(error, hn::Set(d, limit)), left, error);
  }
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum)));
}

// The error above which patches are refined, so that the sum of the errors can be expected to fit the budget.
// roots: room for as many numbers.
template <typename Number>
double refinement_limit(std::span<const Number> errors, std::span<const Number> expected,
                        std::vector<Number>& roots, double budget) {
  const LanesOf<Number> d;
  if (roots.size() < errors.size()) roots.resize(errors.size());
  VectorOf<Number> most = hn::Zero(d);
  for (std::size_t n = 0; n < errors.size(); n += kLanes<Number>) {
    most = hn::Max(hn::LoadU(d, &errors[n]), most);  // `most` where an error is not a number
    hn::StoreU(hn::Sqrt(hn::LoadU(d, &expected[n])), d, &roots[n]);
  }
  const Number largest = hn::GetLane(hn::MaxOfLanes(d, most));
  Number low = static_cast<Number>(1e-12) * largest;
  Number high = static_cast<Number>(0.999) * largest;
  constexpr double kMargin = 0.95;
  for (int step = 0; step < 12; ++step) {
    const Number middle = std::sqrt(low * high);
    (predicted<Number>(errors, expected, roots, middle) <= kMargin * budget ? low : high) = middle;
  }
  return static_cast<double>(low);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_REFINEMENT_INL_H
