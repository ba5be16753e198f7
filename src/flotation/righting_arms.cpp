#include "flotation/righting_arms.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/angles.h"
#include "flotation/balance.h"

namespace buoyancy {
namespace {

constexpr double kMaxTrim = 89.0 * kRadiansPerDegree;

struct TrimmedBody {
  double trim = 0.0;
  BalancedAttitude attitude;
};

// Balances the body at one heel, as a function of the trim.
class TrimSearch {
 public:
  TrimSearch(const Balance& balance, const ShipAxes& axes, double heel)
      : balance_(balance), axes_(axes), heel_(heel) {}

  std::optional<TrimmedBody> at(double trim, const BalancedAttitude* guess = nullptr) const {
    const std::optional<BalancedAttitude> attitude = balance_.at(up_at(axes_, {heel_, trim}), guess);
    if (!attitude) return std::nullopt;
    return TrimmedBody{trim, *attitude};
  }

  // Finds a minimum of the energy over the trim, by Newton's method in a trust region.
  std::optional<TrimmedBody> minimum(double start) const {
    return stationary(start, [&](const TrimmedBody& from, const TrimmedBody& to, double stiffness) {
      const double fall = from.attitude.energy - to.attitude.energy;
      if (std::abs(fall) > balance_.energy_rounding()) return fall > 0.0;
      return stiffness >= 0.0 && std::abs(moment(to)) < std::abs(moment(from));
    });
  }

  // Finds a trim without moment, whether the energy has a minimum there or not.
  std::optional<TrimmedBody> any(double start) const {
    return stationary(start, [&](const TrimmedBody& from, const TrimmedBody& to, double) {
      return std::abs(moment(to)) < std::abs(moment(from));
    });
  }

  bool is_minimum(TrimmedBody trimmed) const {
    return balance_.curvature(trimmed.attitude).along(along(trimmed)) >= -balance_.curvature_rounding();
  }

 private:
  Vec3 along(const TrimmedBody& trimmed) const {
    return up_at(axes_, {heel_, trimmed.trim + 0.5 * std::numbers::pi});
  }
  // [kg m], slope of the energy over the trim.
  double moment(const TrimmedBody& trimmed) const {
    return along(trimmed).dot(trimmed.attitude.lever_moment);
  }

  template <typename IsBetter>
  std::optional<TrimmedBody> stationary(double start, const IsBetter& is_better) const {
    constexpr int kMaxSteps = 100;
    std::optional<TrimmedBody> current = at(start);
    double radius = 0.2;  // [rad]
    for (int count = 0; current && count < kMaxSteps; ++count) {
      const double stiffness = balance_.curvature(current->attitude).along(along(*current));
      const double slope = moment(*current);
      if (std::abs(slope) <= 0.01 * balance_.gradient_rounding()) break;
      // Where Newton's step is not accepted, a step of the radius down the slope is tried.
      double step = -slope / stiffness;
      std::optional<TrimmedBody> next = step_to(*current, std::clamp(step, -radius, radius));
      if (!next || !is_better(*current, *next, stiffness)) {
        step = -std::copysign(radius, slope);
        next = step_to(*current, step);
      }
      if (next && is_better(*current, *next, stiffness)) {
        if (std::abs(step) >= 0.9 * radius) radius = std::min(2.0 * radius, 0.4);
        current = next;
      } else {
        radius *= 0.25;
        if (radius < 1e-13) break;
      }
    }
    if (!current || !(std::abs(moment(*current)) <= balance_.gradient_rounding())) return std::nullopt;
    return current;
  }

  std::optional<TrimmedBody> step_to(const TrimmedBody& from, double step) const {
    const double trim = from.trim + step;
    if (!(std::abs(trim) < kMaxTrim)) return std::nullopt;
    return at(trim, &from.attitude);
  }

  const Balance& balance_;
  const ShipAxes& axes_;
  double heel_;
};

// Computes the arms of one body, with what is the same for all heels.
class ArmSearch {
 public:
  ArmSearch(const FloatingBody& body, const Water& water, const RightingArmOptions& options)
      : balance_(body, water),
        options_(options),
        keel_(options.keel ? *options.keel
                           : lowest_along(body, options.axes.up_B) + options.axes.up_B.dot(body.center_B())) {
  }

  std::optional<RightingArm> at(double heel, double start_trim) const {
    const TrimSearch search(balance_, options_.axes, heel);
    std::optional<TrimmedBody> trimmed;
    if (options_.fixed_trim) {
      trimmed = search.at(*options_.fixed_trim);
    } else {
      trimmed = search.minimum(start_trim);
      if (!trimmed || !search.is_minimum(*trimmed)) trimmed = search.any(start_trim);
    }
    if (!trimmed) return std::nullopt;
    const BalancedAttitude& attitude = trimmed->attitude;
    const FloatingBody& body = balance_.body();
    const Vec3 starboard = starboard_at(options_.axes, heel);
    RightingArm arm{.heel = heel, .trim = trimmed->trim};
    arm.gz = -starboard.dot(attitude.lever_moment) / body.total_mass();
    const LiquidSum liquids = liquid_sum(body, attitude.up_B, FreeSurfaces::kNo);
    arm.kn = arm.gz + starboard.dot(total_center_of_mass_B(body, liquids) - keel_ * options_.axes.up_B);
    arm.energy = balance_.water().gravity * attitude.energy;
    arm.draft = -attitude.height - lowest_along(body, attitude.up_B);
    arm.height = attitude.height - attitude.up_B.dot(body.center_B());
    return arm;
  }

  // The trim of the nearest neighbour is a good start.
  std::optional<RightingArm> near(double heel, const RightingArm& neighbour) const {
    return at(heel, neighbour.trim);
  }

 private:
  Balance balance_;
  const RightingArmOptions& options_;
  double keel_;
};

// Returns the arm between two heels at which GZ is `lever`, by false position with bisection.
std::optional<RightingArm> crossing_between(const ArmSearch& search, RightingArm low, RightingArm high,
                                            double lever) {
  constexpr double kAccuracy = 1e-13;  // [rad]
  constexpr int kMaxRounds = 100;
  for (int round = 0; round < kMaxRounds && high.heel - low.heel > kAccuracy; ++round) {
    const double below = low.gz - lever;
    const double above = high.gz - lever;
    if (below == 0.0) return low;
    if (above == 0.0) return high;
    double heel = 0.5 * (low.heel + high.heel);
    if (round % 3 != 2) heel = low.heel - below * (high.heel - low.heel) / (above - below);
    if (!(heel > low.heel && heel < high.heel)) heel = 0.5 * (low.heel + high.heel);
    const std::optional<RightingArm> arm = search.near(heel, low);
    if (!arm) return std::nullopt;
    (std::signbit(arm->gz - lever) == std::signbit(below) ? low : high) = *arm;
  }
  return std::abs(low.gz - lever) < std::abs(high.gz - lever) ? low : high;
}

// Returns the arm of the largest side * gz between two heels, by golden section.
std::optional<RightingArm> max_between(const ArmSearch& search, const RightingArm& low,
                                       const RightingArm& high, double side) {
  constexpr double kAccuracy = 1e-8;  // [rad]
  constexpr double kGolden = 0.61803398874989485;
  double from = low.heel;
  double to = high.heel;
  std::optional<RightingArm> a = search.near(to - kGolden * (to - from), low);
  std::optional<RightingArm> b = search.near(from + kGolden * (to - from), low);
  while (a && b && to - from > kAccuracy) {
    if (side * a->gz > side * b->gz) {
      to = b->heel;
      b = a;
      a = search.near(to - kGolden * (to - from), *b);
    } else {
      from = a->heel;
      a = b;
      b = search.near(from + kGolden * (to - from), *a);
    }
  }
  if (!a || !b) return std::nullopt;
  return side * a->gz > side * b->gz ? a : b;
}

// arms: ascending in heel. side: 1 starboard, -1 port.
std::optional<RightingArm> max_to_side(const ArmSearch& search, const std::vector<RightingArm>& arms,
                                       double side) {
  std::size_t best = arms.size();
  for (std::size_t i = 0; i < arms.size(); ++i) {
    if (!(side * arms[i].heel > 0.0) || !(side * arms[i].gz > 0.0)) continue;
    if (best == arms.size() || side * arms[i].gz > side * arms[best].gz) best = i;
  }
  if (best == arms.size()) return std::nullopt;
  const std::size_t before = best > 0 ? best - 1 : best;
  const std::size_t after = best + 1 < arms.size() ? best + 1 : best;
  const std::optional<RightingArm> refined = max_between(search, arms[before], arms[after], side);
  return refined && side * refined->gz > side * arms[best].gz ? refined : arms[best];
}

}  // namespace

std::optional<RightingArm> righting_arm(const FloatingBody& body, const Water& water, double heel,
                                        const RightingArmOptions& options, double start_trim) {
  return ArmSearch(body, water, options).at(heel, start_trim);
}

std::optional<RightingArm> arm_at_lever(const FloatingBody& body, const Water& water, const RightingArm& low,
                                        const RightingArm& high, double lever,
                                        const RightingArmOptions& options) {
  return crossing_between(ArmSearch(body, water, options), low, high, lever);
}

std::optional<double> upright_metacentric_height(const FloatingBody& body, const Water& water,
                                                 const RightingArmOptions& options) {
  constexpr double kStep = 1e-4;  // [rad]
  const auto right = righting_arm(body, water, kStep, options);
  const auto left = righting_arm(body, water, -kStep, options);
  if (!right || !left) return std::nullopt;
  return (right->gz - left->gz) / (2.0 * kStep);
}

std::optional<double> RightingCurve::vanishing_starboard() const {
  for (const ArmCrossing& crossing : crossings) {
    if (crossing.heel > 0.0 && !crossing.returns) return crossing.heel;
  }
  return std::nullopt;
}

std::optional<double> RightingCurve::vanishing_port() const {
  for (auto crossing = crossings.rbegin(); crossing != crossings.rend(); ++crossing) {
    if (crossing->heel < 0.0 && !crossing->returns) return crossing->heel;
  }
  return std::nullopt;
}

std::optional<RightingCurve> righting_curve(const FloatingBody& body, const Water& water,
                                            std::span<const double> heels,
                                            const RightingArmOptions& options) {
  const ArmSearch search(body, water, options);
  const std::optional<RightingArm> upright = search.at(0.0, 0.0);
  if (!upright) return std::nullopt;

  // The arms are computed outwards from heel 0, to either side.
  std::vector<RightingArm> arms(heels.size());
  const auto first_positive =
      static_cast<std::size_t>(std::lower_bound(heels.begin(), heels.end(), 0.0) - heels.begin());
  std::vector<double> areas(heels.size());
  std::int64_t done = 0;
  const auto fill = [&](std::size_t i, const RightingArm& inner, double& by_trim) {
    const std::optional<RightingArm> arm = heels[i] == 0.0 ? upright : search.near(heels[i], inner);
    if (!arm) return false;
    arms[i] = *arm;
    const auto trimmed = [](const RightingArm& a) { return a.gz * (1.0 - std::cos(a.trim)); };
    by_trim += 0.5 * (arm->heel - inner.heel) * (trimmed(*arm) + trimmed(inner));
    areas[i] = (arm->energy - upright->energy) / (body.total_mass() * water.gravity) + by_trim;
    if (options.fixed_trim) {
      areas[i] = (arm->energy - upright->energy) / (body.total_mass() * water.gravity * std::cos(arm->trim));
    }
    ++done;
    if (options.progress) options.progress(done, static_cast<std::int64_t>(heels.size()));
    return true;
  };
  RightingCurve curve;
  std::size_t end = first_positive;  // of the heels that have an arm
  double by_trim = 0.0;
  while (end < heels.size() && fill(end, end > first_positive ? arms[end - 1] : *upright, by_trim)) ++end;
  if (end < heels.size()) curve.unbalanced_starboard = heels[end];
  std::size_t begin = first_positive;
  by_trim = 0.0;
  while (begin > 0 && fill(begin - 1, begin < first_positive ? arms[begin] : *upright, by_trim)) --begin;
  if (begin > 0) curve.unbalanced_port = heels[begin - 1];
  arms = {arms.begin() + static_cast<std::ptrdiff_t>(begin), arms.begin() + static_cast<std::ptrdiff_t>(end)};

  constexpr double kUpright = 1e-9;  // of the body's size: an arm below it is rounding
  const bool has_list = std::abs(upright->gz) > kUpright * body.reach();
  for (std::size_t i = 0; i < arms.size(); ++i) curve.points.push_back({arms[i], areas[begin + i]});
  for (std::size_t i = 0; i + 1 < arms.size(); ++i) {
    const RightingArm& low = arms[i];
    const RightingArm& high = arms[i + 1];
    // The arms next to upright vanish with the heel, unless the body has a list.
    const bool is_upright = low.heel <= 0.0 && high.heel >= 0.0 && !has_list;
    if (!(low.gz * high.gz < 0.0) || is_upright) continue;
    const std::optional<RightingArm> crossing = crossing_between(search, low, high, 0.0);
    if (crossing) curve.crossings.push_back({crossing->heel, high.gz > 0.0});
  }
  curve.max_starboard = max_to_side(search, arms, 1.0);
  curve.max_port = max_to_side(search, arms, -1.0);
  return curve;
}

}  // namespace buoyancy
