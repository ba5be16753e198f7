// Every number of a scene file at its limits: the limit itself is accepted, the next number beyond is not.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/format.h"
#include "tests/scene/scene_texts.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();

// What comes before and after "key = number" in the text of a scene.
struct Place {
  std::string before, after = "\n";
};

const std::string kBox = "shape = { type = \"box\" }\n";
const Place kWorld{"[world]\n", "\n" + scene_with_crate()};
const Place kWater{"[water]\n", "\n" + scene_with_crate()};
const Place kImport{"[limits]\n", "\n" + scene_with_crate()};
const Place kBody{scene_with_crate()};
const Place kNewBody{"[[body]]\n", "\n" + kBox};
const Place kMesh{"[[body]]\nid = 1\nmesh = \"a.obj\"\n"};
const Place kPlacedMesh{"[[body]]\nid = 1\nmesh = { file = \"a.obj\", ", " }\n"};
const Place kClient{scene_with_crate("[body.client]\n")};
const Place kCompartment{scene_with_crate("[[body.compartment]]\n" + kBox)};
const Place kTank{scene_with_crate("[[body.tank]]\n" + kBox)};
const Place kFilledTank{kTank.before + "fill = 0\n"};
const std::string kInside =
    scene_with_crate("[[body.compartment]]\n" + kBox + "[[body.compartment]]\n" + kBox + "[[body.tank]]\n" +
                     kBox + "fill = 0\n[body.client]\n[[body.client.event]]\n");
const Place kFlooding{kInside + "time = 1\ncompartment = 1\n"};
const Place kFilling{kInside + "time = 1\ntank = 0\n"};
const Place kEvent{kInside + "compartment = 1\nflooded = 1\n"};

Place waves(const std::string& keys) {
  return {"[water.waves]\n" + keys + "\n", "\n" + scene_with_crate()};
}
const Place kRegularHeight = waves("type = \"regular\"\nperiod = 8");
const Place kRegularPeriod = waves("type = \"regular\"\nheight = 1");
const Place kRegular = waves("type = \"regular\"\nheight = 1\nperiod = 8");
const Place kSpectrumHeight = waves("type = \"jonswap\"\npeak_period = 8");
const Place kSpectrumPeriod = waves("type = \"jonswap\"\nsignificant_wave_height = 2");
const Place kSpectrum = waves("type = \"jonswap\"\nsignificant_wave_height = 2\npeak_period = 8");
const Place kSpread =
    waves("type = \"jonswap\"\nsignificant_wave_height = 2\npeak_period = 8\nspreading = 9");

Place component(const std::string& keys) {
  return {"[water.waves]\ntype = \"components\"\ncomponents = [{ " + keys + ", ",
          " }]\n" + scene_with_crate()};
}
const std::string kAmplitude = "amplitude = 1";
const std::string kFrequency = "angular_frequency = 1";

Place shape(const std::string& type) {
  return {"[[body]]\nid = 1\nshape = { type = \"" + type + "\", ", " }\n"};
}

std::string error_at(const Place& place, const std::string& key, const std::string& number) {
  return parse_error(place.before + key + " = " + number + place.after);
}

struct NumberLimits {
  Place place;
  std::string key;
  double min, max;  // the smallest and the largest number that are accepted; infinite: any finite one
  std::string expected;
};

TEST(NumberLimits, AreTheLastNumbersThatAreAccepted) {
  const std::string positive = "a finite number above 0", from_zero = "a finite number of at least 0";
  const std::string share = "a number from 0 to 1", angle = "a number from -1e+06 to 1e+06 (degrees)";
  const std::string height = "a number from 0 to 10000 (m)", period = "a number from 0.01 to 1e+05 (s)";
  const NumberLimits rows[] = {
      {kWorld, "gravity", 0.0, kInfinity, from_zero + " (m/s^2)"},
      {kWater, "level", -kInfinity, kInfinity, "a finite number (m)"},
      {kWater, "density", 0.0, kInfinity, from_zero + " (kg/m^3)"},
      {kWater, "ramp", 0.0, 1e9, "a number from 0 to 1e+09 (s)"},
      {kImport, "import_seconds", kSmallest, kInfinity, positive + " (s)"},
      {kBody, "tolerance", 0.0, 1.0, share},
      {kMesh, "scale", kSmallest, kInfinity, positive},
      {kPlacedMesh, "scale", kSmallest, kInfinity, positive},
      {kMesh, "close_holes", kSmallest, kInfinity, positive + " (of the volume)"},
      {kMesh, "freeboard", kSmallest, kInfinity, positive + " (m)"},
      {kClient, "mass", kSmallest, kInfinity, positive + " (kg)"},
      {kClient, "density", kSmallest, kInfinity, positive + " (kg/m^3)"},
      {kClient, "linear_damping", 0.0, kInfinity, from_zero + " (N/(m/s))"},
      {kClient, "linear_damping_quadratic", 0.0, kInfinity, from_zero + " (N/(m/s)^2)"},
      {kClient, "angular_damping", 0.0, kInfinity, from_zero + " (N m/(rad/s))"},
      {kClient, "angular_damping_quadratic", 0.0, kInfinity, from_zero + " (N m/(rad/s)^2)"},
      {kCompartment, "permeability", kSmallest, 1.0, "a number above 0, at most 1"},
      {kCompartment, "flooded", 0.0, 1.0, share},
      {kTank, "fill", 0.0, 1.0, share},
      {kTank, "liquid_volume", 0.0, kInfinity, from_zero + " (m^3)"},
      {kFilledTank, "density", 0.0, kInfinity, from_zero + " (kg/m^3)"},
      {kEvent, "time", kSmallest, kInfinity, positive + " (s)"},
      {kFlooding, "flooded", 0.0, 1.0, share},
      {kFilling, "liquid_volume", 0.0, kInfinity, from_zero + " (m^3)"},
      {kRegularHeight, "height", 0.0, 1e4, height},
      {kRegularPeriod, "period", 0.01, 1e5, period},
      {kRegular, "direction", -1e6, 1e6, angle},
      {kRegular, "phase", -1e6, 1e6, angle},
      {kSpectrumHeight, "significant_wave_height", 0.0, 1e4, height},
      {kSpectrumPeriod, "peak_period", 0.01, 1e5, period},
      {kSpectrum, "gamma", 1.0, 10.0, "a number from 1 to 10"},
      {kSpectrum, "direction", -1e6, 1e6, angle},
      {kSpectrum, "spreading", kSmallest, 1e4, "a number above 0, at most 10000"},
      {kSpectrum, "cutoff", 1.1, 20.0, "a number from 1.1 to 20 (peak frequencies)"},
      {component(kFrequency), "amplitude", 0.0, 1e4, height},
      {component(kAmplitude), "angular_frequency", 1e-5, 1e3, "a number from 1e-05 to 1000 (rad/s)"},
      {component(kAmplitude + ", " + kFrequency), "direction", -1e6, 1e6, angle},
      {component(kAmplitude + ", " + kFrequency), "phase", -1e6, 1e6, angle},
      {shape("sphere"), "radius", 1e-9, 1e9, "a length from 1e-09 to 1e+09 (m)"},
      {shape("rock"), "roughness", 0.0, 0.6, "a number from 0 to 0.6"},
  };
  for (const auto& [place, key, min, max, expected] : rows) {
    for (const double limit : {min, max}) {
      const double accepted = std::clamp(limit, -kLargest, kLargest);
      EXPECT_EQ(error_at(place, key, format_shortest(accepted)), "accepted") << key << " = " << accepted;
      const double beyond = std::nextafter(limit, limit == min ? -kInfinity : kInfinity);
      const std::string number = format_shortest(beyond == 0.0 ? 0.0 : beyond);
      const std::string said = key + " = " + number + "; expected " + expected + ".";
      EXPECT_THAT(error_at(place, key, number), HasSubstr(said));
    }
    for (const std::string wrong : {"nan", "\"1\"", "true"}) {
      EXPECT_THAT(error_at(place, key, wrong), HasSubstr(key + " = " + wrong + "; expected ")) << key;
    }
  }
}

TEST(NumberLimits, OfTheDepthAreAboveZeroAndDeepWater) {
  for (const std::string number : {"5e-324", "1.7976931348623157e+308", "inf"}) {
    EXPECT_EQ(error_at(kWater, "depth", number), "accepted") << number;
  }
  for (const std::string number : {"0", "-5e-324", "-inf", "nan", "\"deep\"", "true"}) {
    EXPECT_THAT(
        error_at(kWater, "depth", number),
        HasSubstr("depth = " + number + "; expected a finite number above 0 (m), or inf for deep water."));
  }
}

struct WholeLimits {
  Place place;
  std::string key;
  std::int64_t min, max;
  std::string expected;
};

TEST(NumberLimits, OfWholeNumbersAreTheLastThatAreAccepted) {
  constexpr std::int64_t kMax = INT64_MAX;
  const std::string bins = "a whole number from 1 to 4096";
  const WholeLimits rows[] = {
      {kNewBody, "id", INT32_MIN, INT32_MAX, "a whole number of 32 bits"},
      {kImport, "mesh_bytes", 1, kMax, "a whole number of at least 1"},
      {kImport, "vertices", 1, kMax, "a whole number of at least 1"},
      {kImport, "faces", 1, kMax, "a whole number of at least 1"},
      {kWater, "time_origin", INT64_MIN, kMax, "a whole number (us)"},
      {kSpectrum, "frequencies", 1, 4096, bins},
      {kSpread, "directions", 1, 4096, bins},
      {kSpectrum, "seed", 0, kMax, "a whole number of at least 0"},
      {{kFlooding.before.substr(0, kFlooding.before.rfind("comp")) + "flooded = 1\n"},
       "compartment",
       0,
       1,
       "an index from 0 to 1"},
      {{kFilling.before.substr(0, kFilling.before.rfind("tank")) + "liquid_volume = 1\n"},
       "tank",
       0,
       0,
       "an index from 0 to 0"},
      {shape("sphere"), "segments", 3, 3162, "; expected "},  // 2 segments^2 triangles
      {shape("cone"), "stacks", 1, 100'000, "a whole number from 1 to 100000"},
      {shape("rock"), "frequency", 1, 1000, "; expected "},
      {shape("rock"), "seed", 0, kMax, "a whole number of at least 0"},
  };
  for (const auto& [place, key, min, max, expected] : rows) {
    for (const std::int64_t accepted : {min, max}) {
      EXPECT_EQ(error_at(place, key, std::to_string(accepted)), "accepted") << key << " = " << accepted;
    }
    if (min > INT64_MIN) {
      EXPECT_THAT(error_at(place, key, std::to_string(min - 1)), HasSubstr(expected)) << key;
    }
    if (max < kMax) {
      EXPECT_THAT(error_at(place, key, std::to_string(max + 1)), HasSubstr(expected)) << key;
    }
    for (const std::string wrong : {"1.0", "\"1\"", "true"}) {
      EXPECT_THAT(error_at(place, key, wrong), HasSubstr(key + " = " + wrong + "; expected a")) << key;
    }
  }
}

}  // namespace
}  // namespace buoyancy
