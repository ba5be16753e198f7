// Finds the level of a plane at which the volume under it has a given value: a secant method in a bracket.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace buoyancy {

// The volume rises with the level. The caller evaluates it at a first level within the bracket, passes the
// result to add(), and continues at next() until the excess is small enough or the bracket is narrow. The
// secant method may work on a function of the volume that is closer to linear in the level. The same volumes
// give the same levels. Complexity: O(1) per call; no heap.
class LevelSearch {
 public:
  // low, high: [m], the bracket. slope: a rough derivative of the function by the level, or 0 if it is
  // unknown, which makes the second level the middle of the bracket.
  LevelSearch(double low, double high, double slope)
      : low_(low), high_(high), scale_(std::max(std::abs(low), std::abs(high))), slope_(slope) {}

  // level: [m], within the bracket. excess: [m^3], the volume minus the given value. function: rises with the
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

  // Returns the level to evaluate next [m]: the zero of the secant, or the middle of the bracket on request
  // and where the secant leaves the bracket.
  double next(bool bisect) const {
    const double level = slope_ > 0.0 ? level_ - function_ / slope_ : high_;
    return level > low_ && level < high_ && !bisect ? level : 0.5 * (low_ + high_);
  }

  // True from the third level on if the excess has not halved over the last `levels`, 1 or 2, levels.
  bool is_slow(std::size_t levels) const {
    return count_ > 2 && std::abs(excess_[0]) > 0.5 * std::abs(excess_[levels]);
  }

  // True if the bracket is as narrow as rounding allows.
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
