#include "flotation/balance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hydrostatics/density_steps.h"
#include "hydrostatics/level_search.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace

Vec3 turned(const Vec3& up_B, const Vec3& step) {
  const double angle = step.norm();
  if (!(angle > 0.0)) return up_B;
  return (std::cos(angle) * up_B + (std::sin(angle) / angle) * step).normalized();
}

Balance::Balance(const FloatingBody& body, Water water, bool is_submerged)
    : body_(&body),
      water_(std::move(water)),
      is_submerged_(is_submerged),
      steps_(deepest_density(water_) / water_.density),
      target_volume_(body.total_mass() / water_.density) {
  const double density = deepest_density(water_);
  const double lever = body.reach() + (body.center_of_mass_B() - body.center_B()).norm();
  double area = 0.0;
  for (const FloatingBody::SignedVolume& volume : body.volumes()) area += volume.placed.mesh->area;
  gradient_rounding_ = (density * body.volume_tolerance() + body.liquid_tolerance()) * lever;
  // The rounding errors of a volume and of a mass both act at the lever.
  energy_rounding_ = gradient_rounding_ + 8.0 * kEpsilon * body.total_mass() * lever;
  for_each_step(water_, [&](double step, double depth) {
    energy_rounding_ +=
        depth * water_.density * step * (body.volume_tolerance() + 8.0 * kEpsilon * body.volume());
  });
  curvature_rounding_ = 64.0 * kEpsilon * density * (area * lever * lever + body.volume() * lever);
  for (const Tank& tank : body.tanks()) {
    curvature_rounding_ += 64.0 * kEpsilon * tank.density * tank.mesh->area * lever * lever;
  }
}

BalancedAttitude Balance::balanced(const Vec3& up_B, double height, const DisplacedSum& displaced) const {
  const Vec3 of_mass = mass_moment(*body_, liquid_sum(*body_, up_B, FreeSurfaces::kNo));
  const Vec3 Q = of_mass - water_.density * displaced.moment;
  const double along = up_B.dot(Q);
  return {.up_B = up_B,
          .height = height,
          .energy = along + height * (body_->total_mass() - water_.density * displaced.volume) -
                    water_.density * displaced.depth_moment,
          .lever_moment = Q,
          .gradient = Q - along * up_B,
          .area = 0.0,
          .pivot = -height * up_B};
}

double Balance::slack(double energy, double area) const {
  return std::sqrt(2.0 * std::max(energy, 0.0) * std::max(area, 0.0) / water_.density);
}

double Balance::start_slack() const {
  constexpr double kShare = 0.1;
  const double dry = body_->is_open() ? target_volume_ : body_->volume() - target_volume_;
  return kShare * std::max(0.0, std::min(target_volume_, dry));
}

std::optional<BalancedAttitude> Balance::at(const Vec3& up_B, const BalancedAttitude* guess,
                                            double slack) const {
  constexpr int kMaxRounds = 200;
  const auto sum_at = [&](double height) {
    return displaced_sum(*body_, WaterPlane{.up_B = up_B, .h_c = -height}, water_);
  };
  if (is_submerged_) {
    const double height = -2.0 * body_->reach();
    return balanced(up_B, height, sum_at(height));
  }
  // Corrections for an allowed error hold for one waterplane.
  if (!water_.layers.empty()) slack = 0.0;
  const double total = steps_ * body_->volume();  // [m^3], at the largest depth
  const HeightRange range = height_range(*body_, up_B, water_);
  if (body_->is_open()) {
    if (!(range.low < range.high)) return std::nullopt;
    if (!(sum_at(range.low).volume >= target_volume_)) return std::nullopt;
  } else if (!(target_volume_ <= total)) {
    return std::nullopt;
  }

  const double tolerance = 0.125 * steps_ * body_->volume_tolerance();
  // The secant method works on the cube root of the volume under water, or over it if that is smaller: at a
  // tip the volume grows with the cube of its height.
  const bool is_mostly_wet = !body_->is_open() && target_volume_ > 0.5 * total;
  const auto root_of = [&](double volume) {
    return is_mostly_wet ? -std::cbrt(total - volume) : std::cbrt(volume);
  };
  const double target_root = root_of(target_volume_);

  double height = 0.5 * (range.low + range.high);
  double area = 0.0;
  if (!body_->is_open()) {
    // The first height is that of a sphere that fills the range.
    const double fraction = std::clamp(target_volume_ / total, 0.0, 1.0);
    const double depth = 0.5 - std::sin(std::asin(1.0 - 2.0 * fraction) / 3.0);
    height = range.high - depth * (range.high - range.low);
    area = 6.0 * depth * (1.0 - depth) * total / (range.high - range.low);
  }
  const bool is_guessed = guess != nullptr && guess->area > 0.0;
  if (guess != nullptr) {
    const double expected = -up_B.dot(guess->pivot);
    if (expected > range.low && expected < range.high) height = expected;
    if (is_guessed) area = guess->area;
  }
  const double slope = target_root != 0.0 ? area / (3.0 * target_root * target_root) : 0.0;
  LevelSearch search(-range.high, -range.low, slope);  // of the water over center_B
  double last_height = 0.0;
  double last_excess = 0.0;
  for (int round = 0;; ++round) {
    const DisplacedSum displaced = sum_at(height);
    const double excess = displaced.volume - target_volume_;
    if (round > 0 && height != last_height && excess != last_excess) {
      area = (last_excess - excess) / (height - last_height);
    }
    search.add(-height, excess, root_of(displaced.volume) - target_root);
    if (std::abs(excess) <= std::max(tolerance, slack) || search.is_narrow() || round >= kMaxRounds) {
      BalancedAttitude attitude = balanced(up_B, height, displaced);
      attitude.area = std::max(area, 0.0);
      attitude.is_exact = std::abs(excess) <= tolerance || slack <= tolerance;
      if (!attitude.is_exact) attitude.excess = excess;
      if (is_guessed) settle(attitude, area, guess->pivot);
      return attitude;
    }
    last_height = height;
    last_excess = excess;
    height = -search.next(search.is_slow(2));
  }
}

void Balance::settle(BalancedAttitude& attitude, double area, const Vec3& pivot) const {
  constexpr double kMaxRise = 0.05;
  const double rise = attitude.excess / area;
  // Where the body is narrow, the waterplane does not predict the volume above and below it.
  if (attitude.excess == 0.0 || !(std::abs(rise) <= kMaxRise * std::cbrt(body_->volume()))) return;
  const Vec3& k = attitude.up_B;
  const double mass = water_.density * attitude.excess;
  attitude.height += rise;
  attitude.energy -= 0.5 * mass * rise;
  attitude.lever_moment += mass * pivot;
  attitude.gradient += mass * (pivot - k.dot(pivot) * k);
  attitude.pivot -= rise * k;
  attitude.excess = 0.0;
}

EnergyCurvature Balance::curvature(BalancedAttitude& attitude) const {
  const Vec3& k = attitude.up_B;
  const Vec3 u = k.unitOrthogonal();
  const Vec3 v = k.cross(u);
  const Waterline line = waterline_sum(*body_, attitude.plane(), u, water_);
  const double density = water_.density;
  double uu = 0.0;
  double uv = 0.0;
  double vv = 0.0;
  if (line.area > 0.0) {
    uu = density * (line.uu - line.u * line.u / line.area);
    uv = density * (line.uv - line.u * line.v / line.area);
    vv = density * (line.vv - line.v * line.v / line.area);
  }
  if (!body_->tanks().empty()) {
    const Mat3 free_surface = liquid_sum(*body_, k, FreeSurfaces::kYes).free_surface;
    uu -= u.dot(free_surface * u);
    uv -= u.dot(free_surface * v);
    vv -= v.dot(free_surface * v);
  }
  const double lift = k.dot(attitude.lever_moment);
  const double half_difference = 0.5 * (uu - vv);
  const double radius = std::hypot(half_difference, uv);
  const double mean = 0.5 * (uu + vv);
  const double angle = radius > 0.0 ? 0.5 * std::atan2(uv, half_difference) : 0.0;
  const Vec3 larger = std::cos(angle) * u + std::sin(angle) * v;
  EnergyCurvature curvature;
  curvature.values = {mean - radius - lift, mean + radius - lift};
  curvature.directions_B = {k.cross(larger), larger};
  if (line.area > 0.0) {
    attitude.area = line.area;
    attitude.pivot = (line.u / line.area) * u + (line.v / line.area) * v - attitude.height * k;
    settle(attitude, line.area, attitude.pivot);
  }
  curvature.largest_moment = mean + radius;
  return curvature;
}

}  // namespace buoyancy
