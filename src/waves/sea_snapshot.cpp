#include "waves/sea_snapshot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/double_double.h"

namespace buoyancy {
namespace {

constexpr DoubleDouble kTurn{6.283185307179586, 2.4492935982947064e-16};  // 2 pi

// Returns the phase within half a turn of 0, [rad].
double reduced(DoubleDouble phase) {
  const double turns = std::nearbyint(phase.hi / kTurn.hi);
  const DoubleDouble rest = phase - kTurn * turns;
  return rest.hi + rest.lo;
}

DoubleDouble exactly(std::int64_t whole) {
  // The upper and the lower 32 bits are each exact in a double.
  constexpr std::int64_t kHalf = std::int64_t{1} << 32;
  const std::int64_t high = whole / kHalf;
  return two_sum(static_cast<double>(high) * static_cast<double>(kHalf),
                 static_cast<double>(whole - high * kHalf));
}

// In seconds, of two times in microseconds.
DoubleDouble difference(std::int64_t later, std::int64_t earlier) {
  return (exactly(later) - exactly(earlier)) * reciprocal({1e6, 0.0});
}

}  // namespace

SeaSnapshot::SeaSnapshot(const Sea& sea) : SeaSnapshot(sea, sea.time_origin()) {}

SeaSnapshot::SeaSnapshot(const Sea& sea, std::int64_t utime, double lead_time)
    : sea_(&sea), phases_(sea.prepared().size()) {
  set_time(utime, lead_time);
}

void SeaSnapshot::set_time(std::int64_t utime, double lead_time) {
  const DoubleDouble t = difference(utime, sea_->time_origin()) + DoubleDouble{lead_time, 0.0};
  const PreparedComponents& components = sea_->prepared();
  amplitude_factor_ = sea_->amplitude_factor(t.hi);
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    const DoubleDouble frequency{components.apparent_frequency[i], components.apparent_frequency_rest[i]};
    phases_[i] = reduced(DoubleDouble{components.phase[i], 0.0} - t * frequency);
  }
  if (!sea_->surfaces().empty()) set_surface(t.hi);
}

// t: [s], from the time of the first surface.
void SeaSnapshot::set_surface(double t) {
  const std::vector<TimedElevation>& surfaces = sea_->surfaces();
  const double between = surfaces.size() == 1 ? 0.0 : difference(surfaces[1].utime, surfaces[0].utime).hi;
  const double share = between == 0.0 ? 0.0 : std::clamp(t / between, 0.0, 1.0);
  time_between_ = t > 0.0 && t <= between ? between : 0.0;
  surface_.count = 0;
  surface_.rise = 0.0;
  const auto add = [this](const TimedElevation& surface, double of_surface) {
    if (of_surface == 0.0) return;
    surface_.parts[surface_.count++] = {surface.spline.get(), of_surface};
    surface_.rise += of_surface * surface.rise;
  };
  add(surfaces[0], 1.0 - share);
  add(surfaces.back(), share);
}

// [m/s], between two surfaces on grids.
double SeaSnapshot::surface_velocity(double x1, double x2) const {
  const TimedElevation& earlier = sea_->surfaces().front();
  const TimedElevation& later = sea_->surfaces().back();
  const HorizontalBox place{{x1, x2}, {x1, x2}};
  if (!earlier.spline->holds(place) || !later.spline->holds(place)) return 0.0;
  const double rise =
      later.spline->at(x1, x2).eta - earlier.spline->at(x1, x2).eta + (later.rise - earlier.rise);
  return rise / time_between_;
}

double SeaSnapshot::phase_at(std::size_t i, double x1, double x2) const {
  const PreparedComponents& components = sea_->prepared();
  const DoubleDouble along = DoubleDouble{components.k1[i], components.k1_rest[i]} * x1 +
                             DoubleDouble{components.k2[i], components.k2_rest[i]} * x2;
  return reduced(along + DoubleDouble{phases_[i], 0.0});
}

void SeaSnapshot::phases_at(double x1, double x2, std::vector<double>& out) const {
  out.resize(phases_.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = phase_at(i, x1, x2);
}

double SeaSnapshot::elevation(double x1, double x2) const {
  if (surface_.count > 0) {
    const bool is_known = surface_.holds({{x1, x2}, {x1, x2}});
    return is_known ? surface_.at(x1, x2).eta : std::numeric_limits<double>::quiet_NaN();
  }
  const PreparedComponents& components = sea_->prepared();
  double sum = 0.0;
  for (std::size_t i = 0; i < components.size(); ++i) {
    sum += components.amplitude[i] * std::cos(phase_at(i, x1, x2));
  }
  return amplitude_factor_ * sum;
}

WaterAtPoint SeaSnapshot::at(const Vec3& p_W) const {
  const Water& water = sea_->water();
  const HorizontalAxes& axes = sea_->axes();
  const PreparedComponents& components = sea_->prepared();
  const double x1 = axes.e1_W.dot(p_W);
  const double x2 = axes.e2_W.dot(p_W);
  const double zeta = water.up_W.dot(p_W) - water.level;
  const double h = sea_->depth();

  WaterAtPoint point;
  point.elevation = elevation(x1, x2);
  point.height = zeta - point.elevation;
  if (time_between_ > 0.0) point.velocity_W = surface_velocity(x1, x2) * water.up_W;
  const double s = std::min(point.height, 0.0);
  const double column = h + point.elevation;
  const double stretched = std::isinf(h) ? s : column > 0.0 ? std::max(h * s / column, -h) : -h;
  double pressure_head = 0.0;  // [m], sum a E cos(theta)
  for (std::size_t i = 0; i < components.size(); ++i) {
    const double k = components.wave_number[i];
    // cosh k(z' + h) / cosh kh and sinh k(z' + h) / cosh kh, without overflow.
    const double down = std::exp(k * stretched);
    const double up = std::isinf(h) ? 0.0 : std::exp(-k * (stretched + 2.0 * h));
    const double scale = std::isinf(h) ? 1.0 : 1.0 / (1.0 + std::exp(-2.0 * k * h));
    const double cosh_ratio = (down + up) * scale;
    const double sinh_ratio = (down - up) * scale;
    const double theta = phase_at(i, x1, x2);
    const double amplitude = amplitude_factor_ * components.amplitude[i];
    const double cosine = amplitude * std::cos(theta);
    const double sine = amplitude * std::sin(theta);
    pressure_head += cosh_ratio * cosine;
    // The velocity potential is (a g / w) cosh k(z + h) / cosh kh sin(theta).
    const double speed = water.gravity / components.angular_frequency[i];
    const Vec3 k_W = components.k1[i] * axes.e1_W + components.k2[i] * axes.e2_W;
    point.velocity_W += speed * (cosh_ratio * cosine * k_W + sinh_ratio * sine * k * water.up_W);
    point.acceleration_W += water.gravity * (cosh_ratio * sine * k_W - sinh_ratio * cosine * k * water.up_W);
  }
  if (point.height < 0.0) {
    const double head = sea_->pressure() == WavePressure::kHydrostatic ? -s : pressure_head - zeta;
    point.pressure = water.density * water.gravity * head;
  }
  return point;
}

}  // namespace buoyancy
