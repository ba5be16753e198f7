#include "waves/sea.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "base/double_double.h"
#include "base/format.h"
#include "waves/dispersion.h"
#include "waves/portable_math.h"
#include "waves/sea_ranges.h"
#include "waves/wave_spectrum.h"

namespace buoyancy {
namespace {

// Checks the numbers of a description one by one and keeps the first error.
class Checks {
 public:
  void start(std::string subject) { subject_ = std::move(subject); }

  void in(std::string_view name, double value, const NumberRange& range) {
    if (!range.contains(value)) fail(name, value, range.describe());
  }
  void fail(std::string_view name, double value, std::string expected, std::string cause = {},
            std::string hint = {}) {
    if (error_) return;
    error_ = Error{subject_, std::string(name) + " = " + format_shortest(value), std::move(expected),
                   std::move(cause), std::move(hint)};
  }
  const std::optional<Error>& error() const { return error_; }

 private:
  std::string subject_;
  std::optional<Error> error_;
};

void check_depth(Checks& checks, std::string_view name, double height, double depth) {
  if (height < depth) return;
  checks.fail(name, height, "less than the water's depth, " + format_shortest(depth) + " m",
              "the depth is not in metres, or is that of a basin while the waves are those of a sea",
              "Leave the depth out for deep water");
}

void check(Checks& checks, const RegularWave& wave, double depth) {
  checks.in("height", wave.height, sea_ranges::kHeight);
  checks.in("period", wave.period, sea_ranges::kPeriod);
  checks.in("direction", wave.direction, sea_ranges::kAngle);
  checks.in("phase", wave.phase, sea_ranges::kAngle);
  check_depth(checks, "height", wave.height, depth);
}

void check(Checks& checks, const IrregularWaves& waves, double depth) {
  checks.in("significant_wave_height", waves.significant_wave_height, sea_ranges::kHeight);
  checks.in("peak_period", waves.peak_period, sea_ranges::kPeriod);
  if (waves.gamma) checks.in("gamma", *waves.gamma, sea_ranges::kGamma);
  checks.in("direction", waves.direction, sea_ranges::kAngle);
  if (waves.spreading) checks.in("spreading", *waves.spreading, sea_ranges::kSpreading);
  if (waves.frequencies) checks.in("frequencies", *waves.frequencies, sea_ranges::kBins);
  checks.in("directions", waves.directions, sea_ranges::kBins);
  checks.in("cutoff", waves.cutoff, sea_ranges::kCutoff);
  check_depth(checks, "significant_wave_height", waves.significant_wave_height, depth);
}

void check(Checks& checks, const WaveComponents& components, double depth) {
  for (const WaveComponent& component : components) {
    checks.in("amplitude", component.amplitude, sea_ranges::kHeight);
    checks.in("angular_frequency", component.angular_frequency, sea_ranges::kAngularFrequency);
    checks.in("direction", component.direction, sea_ranges::kAngle);
    checks.in("phase", component.phase, sea_ranges::kAngle);
    check_depth(checks, "amplitude", component.amplitude, depth);
  }
}

// Sums over the components of a system.
struct AmplitudeSums {
  double amplitude = 0.0;  // [m]
  double squares = 0.0;    // [m^2]
};

AmplitudeSums sums_of(const RegularWave& wave) {
  return {0.5 * wave.height, 0.25 * wave.height * wave.height};
}
// Irregular waves have so many components that the sum of the amplitudes, when all phases agree, is no limit.
AmplitudeSums sums_of(const IrregularWaves& waves) {
  const double height = waves.significant_wave_height;
  return {height > 0.0 ? std::numeric_limits<double>::infinity() : 0.0, height * height / 8.0};
}
AmplitudeSums sums_of(const WaveComponents& components) {
  AmplitudeSums sums;
  for (const WaveComponent& component : components) {
    sums.amplitude += component.amplitude;
    sums.squares += component.amplitude * component.amplitude;
  }
  return sums;
}

// Returns the sum of the amplitudes [m], or 4 standard deviations of the elevation where that is less.
double deepest_trough(const SeaDescription& description) {
  AmplitudeSums total;
  for (const WaveSystem& system : description.systems) {
    const AmplitudeSums sums = std::visit([](const auto& of_type) { return sums_of(of_type); }, system);
    total.amplitude += sums.amplitude;
    total.squares += sums.squares;
  }
  return std::min(total.amplitude, 4.0 * std::sqrt(0.5 * total.squares));
}

std::optional<Error> error_in(const SeaDescription& description, const Water& water) {
  Checks checks;
  checks.start("the sea");
  if (description.depth != std::numeric_limits<double>::infinity()) {
    checks.in("depth", description.depth, sea_ranges::kDepth);
  }
  checks.in("ramp", description.ramp, sea_ranges::kRamp);
  for (const double velocity : description.current_W) {
    checks.in("current", velocity, NumberRange::any("m/s"));
  }
  std::size_t components = 0;
  for (std::size_t i = 0; i < description.systems.size(); ++i) {
    checks.start("wave system " + std::to_string(i + 1));
    std::visit([&](const auto& system) { check(checks, system, description.depth); }, description.systems[i]);
    if (checks.error()) return checks.error();
    components += number_of_components(description.systems[i]);
  }
  checks.start("the sea");
  if (components > kMaxWaveComponents) {
    checks.fail("number of wave components", static_cast<double>(components),
                "at most " + std::to_string(kMaxWaveComponents), {},
                "Use fewer frequencies or directions: 200 components are usual");
  }
  if (!(deepest_trough(description) < description.depth)) {
    checks.fail("deepest trough", deepest_trough(description),
                "less than the water's depth, " + format_shortest(description.depth) + " m",
                "the heights of the wave systems add up to more than the depth",
                "Use lower waves, or leave the depth out for deep water");
  }
  if (components > 0 && !(water.gravity > 0.0)) {
    checks.fail("gravity", water.gravity, "a number above 0 (m/s^2)", "waves need gravity");
  }
  return checks.error();
}

void prepare(const WaveComponent& component, const Sea& sea, PreparedComponents& prepared) {
  const double k = wave_number(component.angular_frequency, sea.water().gravity, sea.depth());
  const portable::SinCos direction = portable::sin_cos_of_degrees(component.direction);
  const DoubleDouble k1 = DoubleDouble{direction.cos, direction.cos_rest} * k;
  const DoubleDouble k2 = DoubleDouble{direction.sin, direction.sin_rest} * k;
  prepared.amplitude.push_back(component.amplitude);
  prepared.angular_frequency.push_back(component.angular_frequency);
  const DoubleDouble apparent = k1 * sea.axes().e1_W.dot(sea.current_W()) +
                                k2 * sea.axes().e2_W.dot(sea.current_W()) +
                                DoubleDouble{component.angular_frequency, 0.0};
  prepared.apparent_frequency.push_back(apparent.hi);
  prepared.apparent_frequency_rest.push_back(apparent.lo);
  prepared.wave_number.push_back(k);
  prepared.k1.push_back(k1.hi);
  prepared.k1_rest.push_back(k1.lo);
  prepared.k2.push_back(k2.hi);
  prepared.k2_rest.push_back(k2.lo);
  prepared.direction.push_back(component.direction);
  prepared.phase.push_back(std::remainder(component.phase, 360.0) * (std::numbers::pi / 180.0));
}

}  // namespace

HorizontalAxes horizontal_axes(const Vec3& up_W) {
  const Vec3 axis = std::abs(up_W.x()) > 0.9 ? Vec3::UnitY() : Vec3::UnitX();
  const Vec3 e1_W = (axis - up_W.dot(axis) * up_W).normalized();
  return {e1_W, up_W.cross(e1_W)};
}

Expected<Sea> Sea::make(const SeaDescription& description, const Water& water) {
  if (std::optional<Error> error = error_in(description, water)) return make_error(*std::move(error));
  Sea sea;
  sea.water_ = water;
  sea.axes_ = horizontal_axes(water.up_W);
  sea.depth_ = description.depth;
  sea.pressure_ = description.pressure;
  sea.time_origin_ = description.time_origin;
  sea.ramp_ = description.ramp;
  sea.current_W_ = description.current_W;
  for (std::size_t i = 0; i < description.systems.size(); ++i) {
    const WaveComponents components = components_of(description.systems[i], i);
    sea.components_.insert(sea.components_.end(), components.begin(), components.end());
  }
  for (const WaveComponent& component : sea.components_) {
    if (component.amplitude > 0.0) prepare(component, sea, sea.prepared_);
  }
  return sea;
}

Sea Sea::of_surfaces(std::span<const TimedElevation> surfaces, const Water& water) {
  Sea sea;
  sea.water_ = water;
  sea.axes_ = horizontal_axes(water.up_W);
  sea.depth_ = std::numeric_limits<double>::infinity();
  sea.pressure_ = WavePressure::kHydrostatic;
  constexpr std::size_t kMaxSurfaces = 2;
  sea.surfaces_.reserve(kMaxSurfaces);
  sea.set_surfaces(surfaces, water.level);
  return sea;
}

void Sea::set_surfaces(std::span<const TimedElevation> surfaces, double level) {
  assert(surfaces.size() == 1 || (surfaces.size() == 2 && surfaces[0].utime < surfaces[1].utime));
  water_.level = level;
  time_origin_ = surfaces[0].utime;
  surfaces_.assign(surfaces.begin(), surfaces.end());
}

double Sea::significant_wave_height() const {
  double variance = 0.0;
  for (const double amplitude : prepared_.amplitude) variance += 0.5 * amplitude * amplitude;
  return 4.0 * std::sqrt(variance);
}

double Sea::max_elevation() const {
  double sum = 0.0;
  for (const double amplitude : prepared_.amplitude) sum += amplitude;
  for (const TimedElevation& surface : surfaces_) {
    const ElevationBounds bounds = surface.spline->bounds();
    sum = std::max({sum, -(static_cast<double>(bounds.low) + surface.rise),
                    static_cast<double>(bounds.high) + surface.rise});
  }
  return sum;
}

double Sea::max_wave_number() const {
  const std::vector<double>& k = prepared_.wave_number;
  return k.empty() ? 0.0 : *std::max_element(k.begin(), k.end());
}

double Sea::extreme_steepness() const {
  double sum = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < prepared_.size(); ++i) {
    const double steepness = prepared_.amplitude[i] * prepared_.wave_number[i];
    sum += steepness;
    variance += 0.5 * steepness * steepness;
  }
  return std::min(sum, 4.0 * std::sqrt(variance));
}

double Sea::amplitude_factor(double t) const {
  if (!(t < ramp_) || ramp_ == 0.0) return 1.0;
  if (!(t > 0.0)) return 0.0;
  return 0.5 * (1.0 - std::cos(std::numbers::pi * t / ramp_));
}

}  // namespace buoyancy
