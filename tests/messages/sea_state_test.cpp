#include "messages/sea_state.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <buoyancy/sea_state_t.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/random_messages.h"
#include "tests/support/allocation_count.h"
#include "tests/support/byte_vector.h"
#include "tests/waves/seas.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::size_t kFixed = 8 + 8 + 8 + 9 * 8 + 3 * 8 + 8 + 8 + 3 * 8 + 4 + 4;
constexpr std::size_t kComponent = 4 * 8;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kCurrent(1.5, -0.7, 0.1);  // of wind_sea_and_swell()
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

SeaState random_sea_state() {
  SeaState state;
  Randomiser randomiser;
  visit_header(state, randomiser);
  const auto components = *rc::gen::inRange<std::size_t>(0, 6);
  visit_components(state, [&](std::vector<double>& values) {
    values.resize(components);
    for (double& value : values) randomiser(value);
  });
  return state;
}

sea_state_t to_generated(const SeaState& state) {
  sea_state_t message{};
  message.utime = state.utime;
  message.instance_id = state.instance_id;
  std::copy(state.e1.begin(), state.e1.end(), message.e1);
  std::copy(state.e2.begin(), state.e2.end(), message.e2);
  std::copy(state.up.begin(), state.up.end(), message.up);
  message.level = state.level;
  message.depth = state.depth;
  message.gravity = state.gravity;
  message.time_origin = state.time_origin;
  message.ramp = state.ramp;
  std::copy(state.current.begin(), state.current.end(), message.current);
  message.wave_pressure = state.wave_pressure;
  message.num_components = static_cast<std::int32_t>(state.amplitude.size());
  message.amplitude = state.amplitude;
  message.angular_frequency = state.angular_frequency;
  message.direction = state.direction;
  message.phase = state.phase;
  return message;
}

// A wind sea and a swell, with directions and phases of all sizes.
Sea wind_sea_and_swell(const Water& water = {}, double depth = kInfinity, const Vec3& current_W = kCurrent) {
  IrregularWaves waves = wind_sea(2.0, 8.0);
  waves.direction = 330.0;
  SeaDescription description =
      sea_of({waves, RegularWave{.height = 1.0, .period = 12.0, .direction = -180.0, .phase = 1234.5},
              WaveComponents{{0.0, 1.0, 180.0, 359.9}, {0.1, 1.3, 3600.5, -720.25}, {0.2, 0.7, 90.0, 180.0}}},
             WavePressure::kWheeler, depth);
  description.time_origin = 1'700'000'000'000'000;
  description.ramp = 20.0;
  description.current_W = current_W;
  return *Sea::make(description, water);
}

// Sent and received again.
Sea received(const Sea& sea) {
  const auto state = decoded<SeaState>(encoded(to_sea_state(sea, 7)));
  Expected<Sea> again = to_sea(state, sea.water(), sea.current_W());
  EXPECT_TRUE(again.has_value()) << again.error().message();
  return *std::move(again);
}

// The error for the message of a sea after a change.
std::string error_after(const std::function<void(SeaState&)>& change, const Water& water = {}) {
  static const SeaState valid = to_sea_state(wind_sea_and_swell({}, 50.0), 7);
  SeaState state = valid;
  change(state);
  const Expected<Sea> sea = to_sea(state, water, kCurrent);
  return sea ? "no error" : sea.error().message();
}

RC_GTEST_PROP(SeaState, EncodesAndDecodesLikeGeneratedCode, ()) {
  const SeaState state = random_sea_state();
  const ByteVector bytes = encoded_by_lcm(to_generated(state));
  RC_ASSERT(encoded(state) == bytes);
  RC_ASSERT(bytes.size() == sea_state_size(state.amplitude.size()));
  SeaState decoded = random_sea_state();  // whose content must not matter
  RC_ASSERT(!decode(bytes, decoded).has_value());
  RC_ASSERT(encoded_by_lcm(to_generated(decoded)) == bytes);
}

TEST(SeaState, RejectsEveryTruncationAndTrailingBytes) {
  ByteVector whole = encoded(to_sea_state(wind_sea_and_swell(), 7));
  SeaState state;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_EQ(decode(Bytes(whole).first(size), state),
              size < kFixed ? DecodeError::kTruncated : DecodeError::kLength)
        << size << " bytes";
  }
  whole.push_back(0);
  EXPECT_EQ(decode(whole, state), DecodeError::kLength);
  whole[3] ^= 1U;
  EXPECT_EQ(decode(whole, state), DecodeError::kFingerprint);
  EXPECT_EQ(state, SeaState{}) << "unchanged";
}

TEST(SeaState, RejectsCountsThatDoNotFit) {
  const ByteVector whole = encoded(to_sea_state(wind_sea_and_swell(), 7));
  constexpr auto kMax = static_cast<std::int32_t>(kMaxWaveComponents);
  struct Case {
    std::int32_t count;
    DecodeError expected;
  };
  for (const Case& c : {Case{-1, DecodeError::kCount}, Case{INT_MIN, DecodeError::kCount},
                        Case{kMax + 1, DecodeError::kCount}, Case{5000, DecodeError::kCount},
                        Case{INT_MAX, DecodeError::kCount}, Case{kMax, DecodeError::kLength},
                        Case{0, DecodeError::kLength}, Case{203, DecodeError::kLength}}) {
    ByteVector bytes = whole;
    BigEndianWriter{bytes.data() + kFixed - 4}(c.count);
    SeaState state;
    EXPECT_EQ(decode(bytes, state), c.expected) << c.count;
    EXPECT_EQ(state, SeaState{}) << "unchanged";
  }
  ByteVector too_many(kFixed + (kMaxWaveComponents + 1) * kComponent);
  std::copy_n(whole.begin(), kFixed, too_many.begin());
  BigEndianWriter{too_many.data() + kFixed - 4}(kMax + 1);
  SeaState state;
  EXPECT_EQ(decode(too_many, state), DecodeError::kCount) << "also if the length fits";
}

TEST(SeaState, DecodesTheMaximumNumberOfComponents) {
  SeaState state;
  for (auto* values : {&state.amplitude, &state.angular_frequency, &state.direction, &state.phase}) {
    values->assign(kMaxWaveComponents, 0.5);
  }
  SeaState again;
  EXPECT_FALSE(decode(encoded(state), again).has_value());
  EXPECT_EQ(again, state);
}

TEST(SeaState, DoesNotAllocateAfterWarmUp) {
  const ByteVector whole = encoded(to_sea_state(wind_sea_and_swell(), 7));
  const ByteVector small = encoded(SeaState{});
  SeaState state;
  ByteVector bytes;
  ASSERT_FALSE(decode(whole, state).has_value());
  encode(state, bytes);
  const AllocationCount allocations;
  for (int i = 0; i < 10; ++i) {
    ASSERT_FALSE(decode(small, state).has_value());
    ASSERT_FALSE(decode(whole, state).has_value());
    encode(state, bytes);
    ASSERT_EQ(bytes, whole);
  }
  EXPECT_EQ(allocations.count(), 0);
}

TEST(SeaState, HoldsTheSeaInRadians) {
  const Sea sea = wind_sea_and_swell({.up_W = Vec3::UnitY(), .level = 3.0}, 50.0);
  const SeaState state = to_sea_state(sea, 7);
  EXPECT_EQ(state.utime, 0);
  EXPECT_EQ(state.instance_id, 7);
  EXPECT_EQ(state.up, (std::array{0.0, 1.0, 0.0}));
  EXPECT_EQ(state.e1, (std::array{1.0, 0.0, 0.0}));
  EXPECT_EQ(state.e2, (std::array{0.0, 0.0, -1.0}));
  EXPECT_EQ(state.level, 3.0);
  EXPECT_EQ(state.depth, 50.0);
  EXPECT_EQ(state.gravity, kStandardGravity);
  EXPECT_EQ(state.time_origin, 1'700'000'000'000'000);
  EXPECT_EQ(state.ramp, 20.0);
  EXPECT_EQ(state.current, (std::array{1.5, -0.7, 0.1}));
  EXPECT_EQ(state.wave_pressure, sea_state_t::PRESSURE_WHEELER);
  ASSERT_EQ(state.amplitude.size(), 204U);
  EXPECT_EQ(state.amplitude[203], 0.2);
  EXPECT_EQ(state.angular_frequency[203], 0.7);
  EXPECT_EQ(state.direction[203], std::numbers::pi / 2.0);
  EXPECT_EQ(std::abs(state.phase[203]), std::numbers::pi);
  EXPECT_NEAR(state.phase[202], -0.25 * std::numbers::pi / 180.0, 1e-16) << "within half a turn of 0";
}

TEST(SeaState, IsTheSameSeaAgain) {
  for (const Vec3& up_W :
       {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitX()), Vec3(Vec3(0.3, -0.5, 0.9).normalized())}) {
    const Sea sea = wind_sea_and_swell({.up_W = up_W, .level = 3.0, .density = 1000.0}, 50.0);
    const Sea again = received(sea);
    EXPECT_EQ(again.water().up_W, up_W);
    EXPECT_EQ(again.water().level, 3.0);
    EXPECT_EQ(again.water().density, 1000.0);
    EXPECT_EQ(again.water().gravity, kStandardGravity);
    EXPECT_EQ(again.depth(), 50.0);
    EXPECT_EQ(again.pressure(), WavePressure::kWheeler);
    EXPECT_EQ(again.time_origin(), sea.time_origin());
    EXPECT_EQ(again.ramp(), 20.0);
    EXPECT_EQ(again.current_W(), kCurrent);
    ASSERT_EQ(again.components().size(), sea.components().size());
    for (std::size_t i = 0; i < sea.components().size(); ++i) {
      const WaveComponent& sent = sea.components()[i];
      const WaveComponent& got = again.components()[i];
      EXPECT_EQ(got.amplitude, sent.amplitude);
      EXPECT_EQ(got.angular_frequency, sent.angular_frequency);
      EXPECT_NEAR(std::remainder(got.direction - sent.direction, 360.0), 0.0, 1e-12);
      EXPECT_NEAR(std::remainder(got.phase - sent.phase, 360.0), 0.0, 1e-12);
    }
  }
}

TEST(SeaState, HasTheSameElevationsFarAway) {
  const Sea sea = wind_sea_and_swell({}, kInfinity, Vec3::Zero());
  const Sea again = received(sea);
  SeaSnapshot sent(sea);
  SeaSnapshot got(again);
  sent.set_time(1'790'000'000'123'456, 0.01);
  got.set_time(1'790'000'000'123'456, 0.01);
  for (const double distance : {0.0, 1.0, 1e3}) {
    EXPECT_NEAR(got.elevation(distance, -distance), sent.elevation(distance, -distance), 1e-12);
  }
  for (const double x1 : {-1e6, 1e6, 987'654.3}) {
    for (const double x2 : {-1e6, 0.0, 1e6}) EXPECT_NEAR(got.elevation(x1, x2), sent.elevation(x1, x2), 1e-9);
  }
}

TEST(SeaState, OfAStillSeaIsStill) {
  const Sea still = *Sea::make({}, {});
  const Sea again = received(still);
  EXPECT_TRUE(again.is_still());
  EXPECT_EQ(again.components().size(), 0U);
  EXPECT_EQ(received(*Sea::make({.pressure = WavePressure::kHydrostatic, .systems = {}}, {})).pressure(),
            WavePressure::kHydrostatic);
}

TEST(SeaState, LevelIsTheMessages) {
  SeaState state = to_sea_state(wind_sea_and_swell(), 7);
  state.level = 2.5;
  EXPECT_EQ(to_sea(state, {.level = 1.0}, kCurrent)->water().level, 2.5);
}

// Every component, on both sides: within the tolerance as the sender rounds, and beyond it.
TEST(SeaState, MayDifferFromTheSceneByRounding) {
  struct Field {
    const char* name;
    std::array<double, 3> SeaState::*vector;
  };
  for (const Field& field : {Field{"up", &SeaState::up}, Field{"e1", &SeaState::e1},
                             Field{"e2", &SeaState::e2}, Field{"current", &SeaState::current}}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const double change : {0.99e-6, -0.99e-6, 1.01e-6, -1.01e-6}) {
        const std::string error =
            error_after([&](SeaState& state) { (state.*field.vector)[axis] += change; });
        EXPECT_THAT(error, StartsWith(std::abs(change) < 1e-6
                                          ? std::string("no error")
                                          : "the received sea: " + std::string(field.name) + " = "))
            << change << " of axis " << axis;
      }
      const std::string error = error_after([&](SeaState& state) { (state.*field.vector)[axis] = kNaN; });
      EXPECT_THAT(error, AllOf(StartsWith("the received sea: " + std::string(field.name)), HasSubstr("nan")));
    }
  }
  for (const double change : {0.99e-6, -0.99e-6})
    EXPECT_EQ(error_after([&](SeaState& state) { state.gravity *= 1.0 + change; }), "no error");
  for (const double change : {1.01e-6, -1.01e-6, kNaN})
    EXPECT_THAT(error_after([&](SeaState& state) { state.gravity *= 1.0 + change; }),
                HasSubstr(": gravity = "));
}

TEST(SeaState, RejectsOtherAxesAndGravity) {
  EXPECT_EQ(
      error_after([](SeaState& state) {
        state.up = {0.0, 1.0, 0.0};
      }),
      "the received sea: up = [0, 1, 0]; expected the scene's, [0, 0, 1], within 1e-6. Likely cause: the "
      "sender and the scene do not agree which axis of the world is vertical. Set up under [world] in "
      "the scene, or have the sender use the scene's.");
  EXPECT_THAT(error_after([](SeaState& state) { state.up[1] = 2e-6; }), HasSubstr("up = [0, 2e-06, 1]"));
  EXPECT_EQ(error_after([](SeaState& state) { std::swap(state.e1, state.e2); }),
            "the received sea: e1 = [0, 1, 0]; expected [1, 0, 0], within 1e-6: the world's x axis projected "
            "on the horizontal plane (its y axis where abs(up[0]) > 0.9). Likely cause: the sender measures "
            "directions from another axis. Turn the directions by the angle between the axes, and send e1 "
            "and e2 as sea_state_t.lcm defines them.");
  EXPECT_THAT(error_after([](SeaState& state) { state.e2[1] = -1.0; }),
              HasSubstr("e2 = [0, -1, 0]; expected [0, 1, 0], within 1e-6: up x e1"));
  EXPECT_THAT(error_after([](SeaState& state) { state.e2[0] = kInfinity; }), HasSubstr("e2 = [inf, 1, 0]"));
  EXPECT_EQ(
      error_after([](SeaState& state) { state.gravity = 9.81; }),
      "the received sea: gravity = 9.81; expected the scene's, 9.80665 m/s^2, within 1e-6 of it. Likely "
      "cause: the sender uses another value, such as 9.81 where the scene has 9.80665. Set gravity under "
      "[world] in the scene, or have the sender use the scene's.");
}

TEST(SeaState, RejectsAnotherCurrent) {
  EXPECT_EQ(error_after([](SeaState& state) { state.current = {}; }),
            "the received sea: current = [0, 0, 0]; expected the scene's, [1.5, -0.7, 0.1] m/s, within 1e-6 "
            "m/s. Likely cause: waves ride on the current, and the sender has another one than the scene, or "
            "none. Set velocity under [water.current] in the scene, or have the sender use the scene's.");
}

TEST(SeaState, RejectsBadNumbersOfTheSea) {
  EXPECT_EQ(error_after([](SeaState& state) { state.level = kNaN; }),
            "the received sea: level = nan; expected a finite number (m).");
  EXPECT_THAT(error_after([](SeaState& state) { state.level = -kInfinity; }), HasSubstr("level = -inf"));
  EXPECT_EQ(error_after([](SeaState& state) { state.depth = 0.0; }),
            "the received sea: depth = 0; expected a finite number above 0 (m). Likely cause: the sender has "
            "not set it, or deep water has another value there. Send infinity for deep water.");
  for (const double depth : {-1.0, -kInfinity, kNaN}) {
    EXPECT_THAT(error_after([&](SeaState& state) { state.depth = depth; }), HasSubstr(": depth = "));
  }
  EXPECT_EQ(error_after([](SeaState& state) { state.depth = kInfinity; }), "no error");
  EXPECT_EQ(error_after([](SeaState& state) { state.ramp = -1.0; }),
            "the received sea: ramp = -1; expected a number from 0 to 1e+09 (s).");
  EXPECT_THAT(error_after([](SeaState& state) { state.ramp = kInfinity; }), HasSubstr("ramp = inf"));
  EXPECT_EQ(error_after([](SeaState& state) { state.wave_pressure = 2; }),
            "the received sea: wave_pressure = 2; expected PRESSURE_HYDROSTATIC (0) or PRESSURE_WHEELER (1). "
            "Likely cause: the sender has not set it, or is of another version.");
  EXPECT_THAT(error_after([](SeaState& state) { state.wave_pressure = -1; }),
              HasSubstr("wave_pressure = -1"));
}

TEST(SeaState, RejectsBadComponentsByTheirNumber) {
  EXPECT_EQ(
      error_after([](SeaState& state) { state.amplitude[3] = -0.5; }),
      "the received sea: amplitude[3] = -0.5; expected a number from 0 to 10000 (m). Likely cause: the "
      "sender turns a wave around by its sign, or has not set the number. Add pi to the phase instead of "
      "changing the amplitude's sign.");
  EXPECT_EQ(
      error_after([](SeaState& state) { state.angular_frequency[0] = 0.0; }),
      "the received sea: angular_frequency[0] = 0; expected a number from 1e-05 to 1000 (rad/s). Likely "
      "cause: the sender includes the mean level as a component of frequency 0, or has not set the "
      "number. Send only waves, with frequencies above 0; the mean is the level.");
  EXPECT_EQ(
      error_after([](SeaState& state) { state.phase[203] = 1.7e9; }),
      "the received sea: phase[203] = 1.7e+09; expected a number from -17453 to 17453 (rad). Likely "
      "cause: the sender does not reduce angles to one turn, or has not set the number. Send angles from "
      "-pi to pi, and count the time from a time_origin close to the run.");
  struct Field {
    std::string name;
    std::vector<double> SeaState::*values;
    double min;
    double max;
  };
  for (const Field& field :
       {Field{"amplitude", &SeaState::amplitude, 0.0, 39.0},  // all troughs are above 50 m
        Field{"angular_frequency", &SeaState::angular_frequency, 1e-5, 1e3},
        Field{"direction", &SeaState::direction, -17'453.0, 17'453.0},
        Field{"phase", &SeaState::phase, -17'453.0, 17'453.0}}) {
    const auto error = [&](double value) {
      return error_after([&](SeaState& state) { (state.*field.values)[200] = value; });
    };
    for (const double limit : {field.min, field.max}) EXPECT_EQ(error(limit), "no error") << field.name;
    for (const double beyond : {std::nextafter(field.min, -1e9), kNaN, kInfinity, -kInfinity})
      EXPECT_THAT(error(beyond), StartsWith("the received sea: " + field.name + "[200] = "));
    if (field.name == "amplitude") continue;
    EXPECT_THAT(error(std::nextafter(field.max, 1e9)),
                StartsWith("the received sea: " + field.name + "[200]"));
  }
}

TEST(SeaState, RejectsWhatNoSeaCanBe) {
  EXPECT_THAT(error_after([](SeaState& state) { state.amplitude[7] = 60.0; }),
              StartsWith("the received sea: amplitude = 60; expected less than the water's depth, 50 m."));
  EXPECT_EQ(
      error_after([](SeaState& state) { state.gravity = 0.0; }, {.gravity = 0.0}),
      "the received sea: gravity = 0; expected a number above 0 (m/s^2). Likely cause: waves need gravity.");
}

}  // namespace
}  // namespace buoyancy
