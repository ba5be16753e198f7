#include "messages/sea_state.h"

#include <cassert>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include <buoyancy/sea_state_t.hpp>

#include "base/double_double.h"
#include "base/format.h"
#include "base/number_range.h"
#include "messages/conversions.h"
#include "messages/wire_layout.h"
#include "waves/sea_ranges.h"

namespace buoyancy {
namespace {

constexpr const char* kSubject = "the received sea";
constexpr std::int32_t kPressureHydrostatic = sea_state_t::PRESSURE_HYDROSTATIC;
constexpr std::int32_t kPressureWheeler = sea_state_t::PRESSURE_WHEELER;
constexpr double kAxisTolerance = 1e-6;
constexpr double kGravityTolerance = 1e-6;  // relative
constexpr double kCurrentTolerance = 1e-6;  // [m/s]
// sea_ranges::kAngle in radians, rounded inwards.
constexpr NumberRange kAngleInRadians = NumberRange::from_to(-17453.0, 17453.0, "rad");

constexpr DoubleDouble kRadiansPerDegree{0.017453292519943295, 2.9486522708701687e-19};
constexpr DoubleDouble kDegreesPerRadian{57.29577951308232, -1.9878495670576283e-15};

// Both conversions round once, since the error of a direction is multiplied by k |X|. The result is within
// half a turn of 0.
double to_radians(double degrees) {
  return (kRadiansPerDegree * std::remainder(degrees, 360.0)).hi;
}
double to_degrees(double radians) {
  const DoubleDouble degrees = kDegreesPerRadian * radians;
  return std::remainder(degrees.hi, 360.0) + degrees.lo;
}

// Size [bytes] of everything before the first component: fingerprint, header, number of components.
std::size_t fixed_size() {
  const SeaState state;
  LayoutSize layout;
  layout(std::int64_t{}, std::int32_t{});
  visit_header(state, layout);
  return layout.size();
}

constexpr std::size_t kComponentSize = 4 * sizeof(double);  // [bytes]

// Returns the number of components.
tl::expected<std::size_t, DecodeError> validate(Bytes bytes) {
  const std::size_t fixed = fixed_size();
  if (bytes.size() < fixed) return tl::unexpected(DecodeError::kTruncated);
  std::int64_t fingerprint = 0;
  BigEndianReader{bytes.data()}(fingerprint);
  if (fingerprint != sea_state_t::getHash()) return tl::unexpected(DecodeError::kFingerprint);
  std::int32_t count = 0;
  BigEndianReader{bytes.data() + fixed - sizeof(count)}(count);
  if (count < 0 || static_cast<std::size_t>(count) > kMaxWaveComponents) {
    return tl::unexpected(DecodeError::kCount);
  }
  const auto components = static_cast<std::size_t>(count);
  if (bytes.size() != sea_state_size(components)) return tl::unexpected(DecodeError::kLength);
  return components;
}

Error error_of(std::string actual, std::string expected, std::string cause = {}, std::string hint = {}) {
  return {kSubject, std::move(actual), std::move(expected), std::move(cause), std::move(hint)};
}

std::string equation(std::string_view name, double value) {
  return std::string(name) + " = " + format_shortest(value);
}

std::string bracketed(const Vec3& vector) {
  std::string text = "[";
  return text.append(format_vector(vector)).append("]");
}

// Returns false if a number is NaN.
bool is_near(const Vec3& a, const Vec3& b, double tolerance = kAxisTolerance) {
  return (a - b).norm() <= tolerance;
}

std::optional<Error> axes_error(const SeaState& state, const Vec3& up_W) {
  const Vec3 sent_up_W = to_vec3(state.up);
  if (!is_near(sent_up_W, up_W)) {
    return error_of("up = " + bracketed(sent_up_W), "the scene's, " + bracketed(up_W) + ", within 1e-6",
                    "the sender and the scene do not agree which axis of the world is vertical",
                    "Set up under [world] in the scene, or have the sender use the scene's");
  }
  const HorizontalAxes axes = horizontal_axes(up_W);
  struct Axis {
    const char* name;
    Vec3 sent_W;
    Vec3 expected_W;
    const char* rule;
  };
  const Axis e1{"e1", to_vec3(state.e1), axes.e1_W,
                "the world's x axis projected on the horizontal plane (its y axis where abs(up[0]) > 0.9)"};
  const Axis e2{"e2", to_vec3(state.e2), axes.e2_W, "up x e1"};
  for (const Axis& axis : {e1, e2}) {
    if (is_near(axis.sent_W, axis.expected_W)) continue;
    return error_of(std::string(axis.name) + " = " + bracketed(axis.sent_W),
                    bracketed(axis.expected_W) + ", within 1e-6: " + axis.rule,
                    "the sender measures directions from another axis",
                    "Turn the directions by the angle between the axes, and send e1 and e2 as "
                    "sea_state_t.lcm defines them");
  }
  return std::nullopt;
}

std::optional<Error> gravity_error(double sent, double of_scene) {
  if (std::abs(sent - of_scene) <= kGravityTolerance * of_scene) return std::nullopt;
  return error_of(equation("gravity", sent),
                  "the scene's, " + format_shortest(of_scene) + " m/s^2, within 1e-6 of it",
                  "the sender uses another value, such as 9.81 where the scene has 9.80665",
                  "Set gravity under [world] in the scene, or have the sender use the scene's");
}

std::optional<Error> current_error(const Vec3& sent_W, const Vec3& of_scene_W) {
  if (is_near(sent_W, of_scene_W, kCurrentTolerance)) return std::nullopt;
  return error_of("current = " + bracketed(sent_W),
                  "the scene's, " + bracketed(of_scene_W) + " m/s, within 1e-6 m/s",
                  "waves ride on the current, and the sender has another one than the scene, or none",
                  "Set velocity under [water.current] in the scene, or have the sender use the scene's");
}

std::optional<Error> range_error(std::string_view name, double value, const NumberRange& range,
                                 const char* cause = "", const char* hint = "") {
  if (range.contains(value)) return std::nullopt;
  return error_of(equation(name, value), range.describe(), cause, hint);
}

std::optional<Error> components_error(const SeaState& state) {
  const auto first_error = [](std::string_view name, const std::vector<double>& values,
                              const NumberRange& range, const char* cause,
                              const char* hint) -> std::optional<Error> {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (range.contains(values[i])) continue;
      return range_error(std::string(name) + "[" + std::to_string(i) + "]", values[i], range, cause, hint);
    }
    return std::nullopt;
  };
  if (auto error = first_error("amplitude", state.amplitude, sea_ranges::kHeight,
                               "the sender turns a wave around by its sign, or has not set the number",
                               "Add pi to the phase instead of changing the amplitude's sign")) {
    return error;
  }
  if (auto error = first_error(
          "angular_frequency", state.angular_frequency, sea_ranges::kAngularFrequency,
          "the sender includes the mean level as a component of frequency 0, or has not set the number",
          "Send only waves, with frequencies above 0; the mean is the level")) {
    return error;
  }
  constexpr const char* kAngleCause =
      "the sender does not reduce angles to one turn, or has not set the number";
  constexpr const char* kAngleHint =
      "Send angles from -pi to pi, and count the time from a time_origin close to the run";
  if (auto error = first_error("direction", state.direction, kAngleInRadians, kAngleCause, kAngleHint)) {
    return error;
  }
  return first_error("phase", state.phase, kAngleInRadians, kAngleCause, kAngleHint);
}

std::optional<Error> error_in(const SeaState& state, const Water& water, const Vec3& current_W) {
  if (auto error = axes_error(state, water.up_W)) return error;
  if (auto error = gravity_error(state.gravity, water.gravity)) return error;
  if (auto error = current_error(to_vec3(state.current), current_W)) return error;
  if (auto error = range_error("level", state.level, NumberRange::any("m"))) return error;
  if (state.depth != std::numeric_limits<double>::infinity()) {
    if (auto error = range_error("depth", state.depth, sea_ranges::kDepth,
                                 "the sender has not set it, or deep water has another value there",
                                 "Send infinity for deep water")) {
      return error;
    }
  }
  if (auto error = range_error("ramp", state.ramp, sea_ranges::kRamp)) return error;
  if (state.wave_pressure != kPressureHydrostatic && state.wave_pressure != kPressureWheeler) {
    return error_of("wave_pressure = " + std::to_string(state.wave_pressure),
                    "PRESSURE_HYDROSTATIC (0) or PRESSURE_WHEELER (1)",
                    "the sender has not set it, or is of another version");
  }
  return components_error(state);
}

}  // namespace

std::size_t sea_state_size(std::size_t components) {
  return fixed_size() + components * kComponentSize;
}

void encode(const SeaState& state, std::vector<std::uint8_t>& bytes) {
  const std::size_t components = state.amplitude.size();
  assert(components <= kMaxWaveComponents);
  bytes.resize(sea_state_size(components));
  BigEndianWriter writer(bytes.data());
  writer(sea_state_t::getHash());
  visit_header(state, writer);
  writer(static_cast<std::int32_t>(components));
  visit_components(state, [&](const std::vector<double>& values) {
    assert(values.size() == components);
    for (const double value : values) writer(value);
  });
}

std::optional<DecodeError> decode(Bytes bytes, SeaState& state) {
  const auto components = validate(bytes);
  if (!components) return components.error();
  BigEndianReader reader(bytes.data() + sizeof(std::int64_t));
  visit_header(state, reader);
  reader.skip(sizeof(std::int32_t));
  visit_components(state, [&](std::vector<double>& values) {
    values.resize(*components);
    for (double& value : values) reader(value);
  });
  return std::nullopt;
}

tl::expected<std::int64_t, DecodeError> peek_sea_utime(Bytes bytes) {
  if (const auto components = validate(bytes); !components) return tl::unexpected(components.error());
  std::int64_t utime = 0;
  BigEndianReader{bytes.data() + sizeof(std::int64_t)}(utime);
  return utime;
}

SeaState to_sea_state(const Sea& sea, std::int64_t instance_id) {
  SeaState state;
  state.instance_id = instance_id;
  state.e1 = to_array(sea.axes().e1_W);
  state.e2 = to_array(sea.axes().e2_W);
  state.up = to_array(sea.water().up_W);
  state.level = sea.water().level;
  state.depth = sea.depth();
  state.gravity = sea.water().gravity;
  state.time_origin = sea.time_origin();
  state.ramp = sea.ramp();
  state.current = to_array(sea.current_W());
  state.wave_pressure = sea.pressure() == WavePressure::kWheeler ? kPressureWheeler : kPressureHydrostatic;
  for (const WaveComponent& component : sea.components()) {
    state.amplitude.push_back(component.amplitude);
    state.angular_frequency.push_back(component.angular_frequency);
    state.direction.push_back(to_radians(component.direction));
    state.phase.push_back(to_radians(component.phase));
  }
  return state;
}

Expected<Sea> to_sea(const SeaState& state, const Water& water, const Vec3& current_W) {
  if (auto error = error_in(state, water, current_W)) return make_error(*std::move(error));
  SeaDescription description;
  description.depth = state.depth;
  description.pressure =
      state.wave_pressure == kPressureWheeler ? WavePressure::kWheeler : WavePressure::kHydrostatic;
  description.time_origin = state.time_origin;
  description.ramp = state.ramp;
  description.current_W = to_vec3(state.current);
  WaveComponents components(state.amplitude.size());
  for (std::size_t i = 0; i < components.size(); ++i) {
    components[i] = {state.amplitude[i], state.angular_frequency[i], to_degrees(state.direction[i]),
                     to_degrees(state.phase[i])};
  }
  if (!components.empty()) description.systems.emplace_back(std::move(components));
  Water received = water;
  received.level = state.level;
  Expected<Sea> sea = Sea::make(description, received);
  if (!sea) sea.error().subject = kSubject;
  return sea;
}

}  // namespace buoyancy
