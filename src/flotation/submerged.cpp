#include "flotation/submerged.h"

#include <cmath>

#include "base/angles.h"
#include "flotation/attitude_descent.h"

namespace buoyancy {
namespace {

VerticalMotion motion_of(FlotationOutcome by_mass) {
  if (by_mass == FlotationOutcome::kNeutral) return VerticalMotion::kHovers;
  return by_mass == FlotationOutcome::kFloats ? VerticalMotion::kRises : VerticalMotion::kSinks;
}

struct RestSearch {
  bool has_lever = false;         // are the centres of buoyancy and mass apart at some attitude?
  std::optional<Minimum> lowest;  // set if they are, unless a number is out of range
};

RestSearch lowest_attitude(const Balance& balance, const ShipAxes& axes) {
  const FloatingBody& body = balance.body();
  AttitudeDescent descent(balance);
  const auto is_known = [](const BalancedAttitude&, const Vec3&, double) { return false; };
  RestSearch search;
  std::optional<Minimum>& lowest = search.lowest;
  for (const Vec3& start : {axes.up_B, Vec3(Vec3::UnitX()), Vec3(-Vec3::UnitX()), Vec3(Vec3::UnitY()),
                            Vec3(-Vec3::UnitY()), Vec3(Vec3::UnitZ()), Vec3(-Vec3::UnitZ())}) {
    const Vec3 lever_moment = balance.at(start)->lever_moment;
    if (lever_moment.norm() <= kNoLever * body.reach() * body.total_mass()) continue;
    search.has_lever = true;
    // The energy is concave: it is not higher where the body would rest with its liquids frozen.
    const std::optional<Minimum> minimum =
        descent.minimum_from(*balance.at(-lever_moment.normalized()), is_known);
    if (!minimum) continue;
    const double fall = lowest ? lowest->attitude.energy - minimum->attitude.energy : 0.0;
    if (!lowest || fall > balance.energy_rounding()) lowest = minimum;
  }
  return search;
}

}  // namespace

std::string_view to_string(VerticalMotion motion) {
  switch (motion) {
    case VerticalMotion::kRises:
      return "rises";
    case VerticalMotion::kSinks:
      return "sinks";
    case VerticalMotion::kHovers:
      break;
  }
  return "hovers";
}

std::optional<SubmergedRest> submerged_rest(const FloatingBody& body, const Water& water,
                                            const ShipAxes& axes) {
  if (body.is_open() || !(body.volume() > body.volume_tolerance())) return std::nullopt;
  const double buoyancy = deepest_density(water) * water.gravity * body.volume();  // [N]
  const RestSearch search = lowest_attitude(Balance::submerged(body, water), axes);
  SubmergedRest rest;
  if (search.lowest) {
    const auto& [attitude, curvature] = *search.lowest;
    rest.angles = heel_trim_of(axes, attitude.up_B);
    rest.bg = -attitude.up_B.dot(attitude.lever_moment) / body.total_mass();
    for (std::size_t i = 0; i < 2; ++i) {
      const double lever = curvature.values[i] / body.total_mass();  // [m], BG - GG'
      rest.moments_per_degree[i] = buoyancy * lever * std::sin(kRadiansPerDegree);
    }
  } else if (search.has_lever) {
    return std::nullopt;
  } else {
    rest.family = AttitudeFamily::kSphere;
  }
  rest.q_WB = attitude_at(axes, rest.angles, water.up_W);
  rest.net_weight = water.gravity * body.total_mass() - buoyancy;
  rest.motion = motion_of(outcome_by_mass(body, water));
  const bool is_finite = std::isfinite(rest.moments_per_degree[1]) && std::isfinite(rest.net_weight);
  return is_finite ? std::optional(rest) : std::nullopt;
}

}  // namespace buoyancy
