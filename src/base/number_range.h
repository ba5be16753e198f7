// Describes the range of a number that a user gives, for checks and for the errors that name it.
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace buoyancy {

struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_inclusive = true;
  std::string_view unit;  // "kg"; empty for pure numbers

  static constexpr NumberRange any(std::string_view unit) {
    NumberRange range;
    range.unit = unit;
    return range;
  }
  static constexpr NumberRange from_zero(std::string_view unit) {
    NumberRange range = any(unit);
    range.min = 0.0;
    return range;
  }
  static constexpr NumberRange above_zero(std::string_view unit) {
    NumberRange range = from_zero(unit);
    range.min_inclusive = false;
    return range;
  }
  static constexpr NumberRange from_zero_to(double max, std::string_view unit = "") {
    NumberRange range = from_zero(unit);
    range.max = max;
    return range;
  }
  static constexpr NumberRange above_zero_to(double max, std::string_view unit = "") {
    NumberRange range = above_zero(unit);
    range.max = max;
    return range;
  }
  static constexpr NumberRange from_to(double min, double max, std::string_view unit = "") {
    NumberRange range = from_zero_to(max, unit);
    range.min = min;
    return range;
  }

  bool contains(double value) const;  // false for NaN and infinity
  std::string describe() const;       // "a finite number above 0 (kg)"
};

// Formats a unit as " (kg)", and none as "".
std::string in_unit(std::string_view unit);

}  // namespace buoyancy
