#include "flotation/attitude_family.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace buoyancy {
namespace {

constexpr double kEnergyError = 0.01;  // relative to the difference of energies that counts as flat

// Moves an attitude across its path to the bottom of the valley, by one Newton step on the gradient.
std::optional<BalancedAttitude> at_bottom(const Balance& balance, BalancedAttitude& at, const Vec3& direction,
                                          double max_step, double energy_error) {
  const Vec3 across = at.up_B.cross(direction);
  const EnergyCurvature curvature = balance.curvature(at);
  const double stiffness = curvature.along(across);
  if (!(stiffness > 0.02 * curvature.largest_moment)) return at;
  const double step = std::clamp(-across.dot(at.gradient) / stiffness, -max_step, max_step);
  return balance.at(turned(at.up_B, step * across), &at, balance.slack(energy_error, at.area));
}

// Returns the tangent at `to` of the great circle that comes from `from`.
Vec3 direction_at(const Vec3& from, const Vec3& to) {
  return (from.dot(to) * to - from).normalized();
}

}  // namespace

double flat_energy(const Balance& balance, double relative) {
  return relative * balance.body().total_mass() * std::cbrt(balance.body().volume());
}

std::vector<Vec3> flat_curve(const Balance& balance, const Minimum& minimum, double flat) {
  constexpr double kMinLength = 1.0;  // [rad]
  const double energy_error = kEnergyError * flat;
  const Vec3& start = minimum.attitude.up_B;
  std::vector<Vec3> path{start};
  BalancedAttitude at = minimum.attitude;
  Vec3 direction = minimum.curvature.directions_B[0];
  double length = 0.0;
  while (length < 2.0 * std::numbers::pi) {
    std::optional<BalancedAttitude> next =
        balance.at(turned(at.up_B, kFamilyStep * direction), &at, balance.slack(energy_error, at.area));
    for (int i = 0; i < 2 && next; ++i) {
      next = at_bottom(balance, *next, direction_at(at.up_B, next->up_B), 0.5 * kFamilyStep, energy_error);
    }
    if (!next || std::abs(next->energy - minimum.attitude.energy) > flat) {
      if (length < kMinLength) path.clear();
      break;
    }
    direction = direction_at(at.up_B, next->up_B);
    at = *next;
    path.push_back(at.up_B);
    length += kFamilyStep;
    if (path.size() > 4 && (at.up_B - start).norm() < 0.6 * kFamilyStep) break;
  }
  return path;
}

bool is_flat_everywhere(const Balance& balance, const Minimum& minimum, double flat) {
  for (const double side : {-1.0, 1.0}) {
    for (const Vec3& direction : minimum.curvature.directions_B) {
      BalancedAttitude at = minimum.attitude;
      for (const double angle : {0.1, 0.3, 0.6, 1.0, 1.5}) {
        const auto next = balance.at(turned(minimum.attitude.up_B, side * angle * direction), &at,
                                     balance.slack(kEnergyError * flat, at.area));
        if (!next || std::abs(next->energy - minimum.attitude.energy) > flat) return false;
        at = *next;
      }
    }
  }
  return true;
}

}  // namespace buoyancy
