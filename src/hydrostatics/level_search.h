// The level of a plane at which the volume under it has a given value: the secant method within a bracket.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace buoyancy {

// The volume rises with the level. The caller evaluates it at a first level within the bracket, passes the
// result to add(), and continues at next() until the excess is small enough or the search is narrow. A
// function of the volume that is closer to linear in the level may take its place in the secant method. The
// same volumes give the same levels. Complexity: O(1) per call; no heap.
class LevelSearch {
 public:
  // low, high: [m], the volume passes its value between them. slope: of the function over the level, where it
  // is known roughly, else 0: the second level is then the middle.
  LevelSearch(double low, double high, double slope)
      : low_(low), high_(high), scale_(std::max(std::abs(low), std::abs(high))), slope_(slope) {}

  // level: [m], within the bracket. excess: [m^3], of the volume over its value. function: rises with the
  // volume and is 0 where the excess is.
  void add(double level, double excess, double function) {
    if (count_ > 0 && level != level_ && excess != excess_[0]) {
      slope_ = (function - function_) / (level - level_);
    }
    (excess > 0.0 ? high_ : low_) = level;
    excess_ = {excess, excess_[0], excess_[1]};
    level_ = level;
    function_ = function;
    ++count_;
  }

  // [m], where to evaluate next: where the secant vanishes, or the middle of the bracket, on request and
  // where the secant leaves the bracket.
  double next(bool bisect) const {
    const double level = slope_ > 0.0 ? level_ - function_ / slope_ : high_;
    return level > low_ && level < high_ && !bisect ? level : 0.5 * (low_ + high_);
  }

  // From the third level on: has the excess not halved since so many levels, 1 or 2?
  bool is_slow(std::size_t levels) const {
    return count_ > 2 && std::abs(excess_[0]) > 0.5 * std::abs(excess_[levels]);
  }

  // Are the ends of the bracket neighbours, but for rounding?
  bool is_narrow() const { return high_ - low_ <= 2.0 * std::numeric_limits<double>::epsilon() * scale_; }

 private:
  double low_, high_, scale_;
  double slope_;
  double level_ = 0.0;
  double function_ = 0.0;
  std::array<double, 3> excess_{};  // the last first
  std::size_t count_ = 0;
};

}  // namespace buoyancy
