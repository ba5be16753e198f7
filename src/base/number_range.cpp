#include "base/number_range.h"

#include <cmath>

#include "base/format.h"

namespace buoyancy {

bool NumberRange::contains(double value) const {
  return std::isfinite(value) && value <= max && (min_inclusive ? value >= min : value > min);
}

std::string NumberRange::describe() const {
  std::string text = "a finite number";
  if (std::isfinite(min) && std::isfinite(max)) {
    text = min_inclusive ? "a number from " + format_shortest(min) + " to " + format_shortest(max)
                         : "a number above " + format_shortest(min) + ", at most " + format_shortest(max);
  } else if (std::isfinite(min)) {
    text = (min_inclusive ? "a finite number of at least " : "a finite number above ") + format_shortest(min);
  }
  return text + in_unit(unit);
}

std::string in_unit(std::string_view unit) {
  return unit.empty() ? "" : " (" + std::string(unit) + ")";
}

}  // namespace buoyancy
