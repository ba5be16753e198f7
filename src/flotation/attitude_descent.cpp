#include "flotation/attitude_descent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace buoyancy {
namespace {

using Pair = std::array<double, 2>;

constexpr int kMaxSteps = 200;
constexpr double kFirstRadius = 0.4;  // [rad]
constexpr double kMaxRadius = 0.6;    // [rad]
constexpr double kEscape = 0.05;      // [rad], from a saddle point
constexpr int kMaxRejections = 1;     // of steps from an attitude that does not quite balance

double norm(const Pair& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1]);
}

// A step in the axes of the principal curvatures.
struct Step {
  Pair along{};            // [rad]
  double decrease = 0.0;   // [kg m], of the quadratic model
  bool is_newton = false;  // true if it reaches the minimum of the model
  bool is_tied = false;    // true if the gradient prefers neither it nor its mirror image
};

// Returns the shift of the curvatures at which the step is as long as the radius, to 1 %, by Newton's method
// within bounds on the reciprocal of the length, which is nearly linear.
double shift_to(const Pair& g, const Pair& values, double radius) {
  constexpr int kMaxRounds = 40;
  constexpr double kAccuracy = 0.01;
  const double size = norm(g);
  double low = std::max({0.0, -values[0], size / radius - values[1]});
  double high = std::max(low, size / radius - values[0]);
  double shift = low > -values[0] ? low : 0.5 * (low + high);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Pair along{g[0] / (values[0] + shift), g[1] / (values[1] + shift)};
    const double length = norm(along);
    if (std::abs(length - radius) <= kAccuracy * radius) break;
    (length > radius ? low : high) = shift;
    const double slope =
        along[0] * along[0] / (values[0] + shift) + along[1] * along[1] / (values[1] + shift);
    shift += (length / radius - 1.0) * length * length / slope;
    if (!(shift > low && shift < high)) shift = 0.5 * (low + high);
  }
  return shift;
}

// Minimises the model g . s + 1/2 sum values s^2 within |s| <= radius.
Step best_step(const Pair& g, const Pair& values, double radius, double gradient_rounding) {
  Step step;
  const auto at = [&](double shift) {
    return Pair{-g[0] / (values[0] + shift), -g[1] / (values[1] + shift)};
  };
  step.is_newton = values[0] > 0.0 && norm(at(0.0)) <= radius;
  if (step.is_newton) {
    step.along = at(0.0);
  } else {
    const double gap = values[1] - values[0];
    const double across = gap > 0.0 ? -g[1] / gap : 0.0;
    step.is_tied = std::abs(g[0]) <= gradient_rounding && values[0] <= 0.0 && std::abs(across) < radius;
    if (step.is_tied) {
      step.along = {std::copysign(std::sqrt(radius * radius - across * across), -g[0]), across};
    } else {
      step.along = at(shift_to(g, values, radius));
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    step.decrease -= step.along[i] * (g[i] + 0.5 * values[i] * step.along[i]);
  }
  return step;
}

Pair components(const BalancedAttitude& at, const EnergyCurvature& curvature) {
  return {curvature.directions_B[0].dot(at.gradient), curvature.directions_B[1].dot(at.gradient)};
}

Vec3 tangent(const Pair& along, const EnergyCurvature& curvature) {
  return along[0] * curvature.directions_B[0] + along[1] * curvature.directions_B[1];
}

// Returns the allowed error of the displaced volume after a step [m^3]. Its effect on the energy stays far
// below the decrease by the step, and ever farther near the end, where steps shrink quadratically.
double slack_for(const Balance& balance, double decrease, double length, double area) {
  constexpr double kAboveRounding = 1e3;
  constexpr double kShare = 0.01;
  if (!(decrease > kAboveRounding * balance.energy_rounding())) return 0.0;
  return balance.slack(kShare * length * decrease, area);
}

// Returns the decrease of the energy along the great circle of a tangent step [kg m], by the trapezoidal rule
// on the gradient, which resolves decreases that rounding hides in a difference of energies.
double fall_along(const BalancedAttitude& from, const BalancedAttitude& to, const Vec3& step) {
  const double length = step.norm();
  const Vec3 arrival = std::cos(length) * step - length * std::sin(length) * from.up_B;
  return -0.5 * (from.gradient.dot(step) + to.gradient.dot(arrival));
}

// Returns a tangent step back to the bottom of a valley. A valley of nearly equal energy may be curved, and a
// step along its tangent climbs its side. curvature: of an attitude nearby, with values[1] > 0.
Vec3 step_to_bottom(const BalancedAttitude& at, const EnergyCurvature& curvature) {
  const Vec3& side = curvature.directions_B[1];
  const Vec3 across = (side - side.dot(at.up_B) * at.up_B).normalized();
  return -(across.dot(at.gradient) / curvature.values[1]) * across;
}

}  // namespace

std::optional<Minimum> AttitudeDescent::minimum_from(const BalancedAttitude& start, const IsKnown& is_known) {
  const double converged = 0.05 * balance_->gradient_rounding();
  BalancedAttitude at = start;
  EnergyCurvature curvature = balance_->curvature(at);
  if (is_known(at, at.up_B, -1.0)) return std::nullopt;
  double radius = kFirstRadius;
  int rejections = 0;  // of steps from an attitude that does not quite balance
  for (int count = 0; count < kMaxSteps; ++count) {
    const Pair gradient = components(at, curvature);
    const double size = at.gradient.norm();
    const bool is_saddle = curvature.values[0] < -balance_->curvature_rounding();
    if (size <= balance_->gradient_rounding() && !at.is_exact) {
      const std::optional<BalancedAttitude> exact = balance_->at(at.up_B, &at);
      if (!exact) return std::nullopt;
      at = *exact;
      curvature = balance_->curvature(at);
      continue;
    }
    if (size <= converged && !is_saddle) return Minimum{at, curvature};
    if (size <= balance_->gradient_rounding() && is_saddle) radius = std::min(radius, kEscape);

    const Step step = best_step(gradient, curvature.values, radius, balance_->gradient_rounding());
    const Vec3 turn = tangent(step.along, curvature);
    const Vec3 target = turned(at.up_B, turn);
    const double length = norm(step.along);
    if (is_known(at, target, step.is_newton ? length : -length)) return std::nullopt;
    if (step.is_tied && is_saddle) {
      further_starts_.push_back(turned(at.up_B, tangent({-step.along[0], step.along[1]}, curvature)));
    }
    const double slack = slack_for(*balance_, step.decrease, length, at.area);
    std::optional<BalancedAttitude> next = balance_->at(target, &at, slack);
    const double rounding = balance_->energy_rounding();
    bool accepted = false;
    if (next) {
      double fall = at.energy - next->energy;
      const bool is_below_rounding = step.decrease <= rounding && std::abs(fall) <= rounding;
      if (is_below_rounding) {
        fall = fall_along(at, *next, turn);
        if (!(fall > 0.0) && size > balance_->gradient_rounding() && curvature.values[1] > 0.0) {
          const Vec3 back = step_to_bottom(*next, curvature);
          if (const auto bottom = balance_->at(turned(next->up_B, back), &*next)) {
            fall += fall_along(*next, *bottom, back);
            next = bottom;
          }
        }
      }
      accepted = fall > 0.0;
      const double ratio = fall / step.decrease;
      if (ratio < 0.25) radius = 0.25 * length;
      if (ratio > 0.75 && length > 0.9 * radius) radius = std::min(2.0 * radius, kMaxRadius);
      if (is_below_rounding && !accepted && size <= balance_->gradient_rounding()) {
        return Minimum{at, curvature};
      }
    } else {
      radius = 0.25 * length;
    }
    if (!accepted && !at.is_exact && ++rejections > kMaxRejections) {
      // The error of the attitude's displacement may hide a decrease of the energy.
      const std::optional<BalancedAttitude> exact = balance_->at(at.up_B, &at);
      if (!exact) return std::nullopt;
      at = *exact;
      curvature = balance_->curvature(at);
      continue;
    }
    if (!(radius > 1e-14)) return std::nullopt;
    if (!accepted) continue;
    if (is_known(*next, next->up_B, -1.0)) return std::nullopt;
    at = *next;
    rejections = 0;
    curvature = balance_->curvature(at);
  }
  return std::nullopt;
}

std::optional<Minimum> AttitudeDescent::stationary_from(const BalancedAttitude& start) const {
  constexpr double kMaxStep = 0.3;  // [rad]
  BalancedAttitude at = start;
  EnergyCurvature curvature = balance_->curvature(at);
  for (int count = 0; count < 50; ++count) {
    const double size = at.gradient.norm();
    const Pair gradient = components(at, curvature);
    Pair along{-gradient[0] / curvature.values[0], -gradient[1] / curvature.values[1]};
    const double length = norm(along);
    if (!std::isfinite(length)) break;
    double factor = std::min(1.0, kMaxStep / length);
    std::optional<BalancedAttitude> next;
    for (int halving = 0; halving < 6; ++halving, factor *= 0.5) {
      next = balance_->at(turned(at.up_B, factor * tangent(along, curvature)), &at);
      if (next && next->gradient.norm() < size) break;
      next.reset();
    }
    if (!next) break;
    at = *next;
    curvature = balance_->curvature(at);
  }
  if (!(at.gradient.norm() <= balance_->gradient_rounding())) return std::nullopt;
  return Minimum{at, curvature};
}

std::vector<Vec3> AttitudeDescent::take_further_starts() {
  return std::exchange(further_starts_, {});
}

}  // namespace buoyancy
