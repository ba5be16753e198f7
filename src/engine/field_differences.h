// Differences between the fields of two messages, relative to tolerances.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace buoyancy {

inline constexpr double kRounding = 128.0 * std::numeric_limits<double>::epsilon();  // of two results

// The distance to NaN or infinity is infinite.
inline double distance(double a, double b) {
  const double difference = std::abs(a - b);
  return std::isfinite(difference) ? difference : std::numeric_limits<double>::infinity();
}

inline double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double length = std::hypot(distance(a[0], b[0]), distance(a[1], b[1]), distance(a[2], b[2]));
  // libstdc++'s hypot() of three numbers is NaN where one of them is infinite.
  return std::isnan(length) ? std::numeric_limits<double>::infinity() : length;
}

inline double length_of(double value) {
  return std::abs(value);
}
inline double length_of(const std::array<double, 3>& value) {
  return std::hypot(value[0], value[1], value[2]);
}

// 0 / 0 is 0: both values are exact and equal. The ratio to a bound that is not finite is infinite.
inline double in_bounds(double difference, double bounds) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!std::isfinite(bounds)) return kInfinity;
  if (difference == 0.0) return 0.0;
  return bounds > 0.0 ? difference / bounds : kInfinity;
}

// The comparison of all messages of a type about one body.
struct MessageDifferences {
  std::int64_t compared = 0;
  double in_bounds = 0.0;        // largest difference / tolerance of any field
  std::string_view worst_field;  // empty: no difference
};

// The largest ratio of difference to tolerance over the fields of one body in two messages.
class FieldDifferences {
 public:
  // Values are numbers or vectors.
  template <typename Value>
  void add(std::string_view field, const Value& now, const Value& baseline, double tolerance) {
    update(field, distance(now, baseline),
           tolerance + kRounding * std::max(length_of(now), length_of(baseline)));
  }
  // NaN in both is no difference: the field is undefined for this pose.
  template <typename Value>
  void add_if_defined(std::string_view field, const Value& now, const Value& baseline, double tolerance) {
    if (!undefined(now) || !undefined(baseline)) add(field, now, baseline, tolerance);
  }
  // Axes have no sign: opposite directions are equal.
  void add_axis(std::string_view field, const std::array<double, 3>& now,
                const std::array<double, 3>& baseline, double tolerance) {
    if (undefined(now) && undefined(baseline)) return;
    const std::array<double, 3> reversed{-baseline[0], -baseline[1], -baseline[2]};
    update(field, std::min(distance(now, baseline), distance(now, reversed)), tolerance);
  }

  void add_to(MessageDifferences& differences) const {
    ++differences.compared;
    if (worst_ <= differences.in_bounds) return;
    differences.in_bounds = worst_;
    differences.worst_field = field_;
  }

 private:
  static bool undefined(double value) { return std::isnan(value); }
  static bool undefined(const std::array<double, 3>& value) {
    return std::ranges::all_of(value, [](double number) { return std::isnan(number); });
  }

  void update(std::string_view field, double difference, double tolerance) {
    const double relative = in_bounds(difference, tolerance);
    if (relative <= worst_) return;
    worst_ = relative;
    field_ = field;
  }

  double worst_ = 0.0;
  std::string_view field_;
};

}  // namespace buoyancy
