// The keys of [water] that describe the sea.
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// Returns a scene whose [water] has these keys from line 2, and then a body.
std::string water_with(const std::string& keys) {
  return "[water]\n" + keys + "\n" + scene_with_crate();
}

// Returns a scene whose only wave system has these keys from line 2.
std::string waves_with(const std::string& keys) {
  return "[[water.waves]]\n" + keys + "\n" + scene_with_crate();
}

SeaDescription sea_of(const std::string& text) {
  return parsed(text).sea;
}

TEST(SeaToml, WithoutKeysIsDeepWaterAtRest) {
  const SeaDescription sea = sea_of(scene_with_crate());
  EXPECT_EQ(sea.depth, HUGE_VAL);
  EXPECT_EQ(sea.pressure, WavePressure::kWheeler);
  EXPECT_EQ(sea.time_origin, 0);
  EXPECT_EQ(sea.ramp, 0.0);
  EXPECT_TRUE(sea.systems.empty());
}

TEST(SeaToml, ReadsKeysOfTheWater) {
  const SeaDescription sea = sea_of(
      water_with("depth = 50\nwave_pressure = \"hydrostatic\"\ntime_origin = 1772000000000001\nramp = 12.5"));
  EXPECT_EQ(sea.depth, 50.0);
  EXPECT_EQ(sea.pressure, WavePressure::kHydrostatic);
  EXPECT_EQ(sea.time_origin, 1'772'000'000'000'001);
  EXPECT_EQ(sea.ramp, 12.5);
  EXPECT_EQ(sea_of(water_with("depth = inf\nwave_pressure = \"wheeler\"")).depth, HUGE_VAL);
  EXPECT_EQ(sea_of(water_with("time_origin = -9223372036854775808")).time_origin, INT64_MIN);
}

TEST(SeaToml, ReadsRegularWaves) {
  const SeaDescription sea =
      sea_of(waves_with("type = \"regular\"\nheight = 2\nperiod = 8.5\ndirection = -30\nphase = 90") +
             "[[water.waves]]\ntype = \"regular\"\nheight = 1\nperiod = 5\n");
  ASSERT_EQ(sea.systems.size(), 2U);
  const auto& first = std::get<RegularWave>(sea.systems[0]);
  EXPECT_EQ(first.height, 2.0);
  EXPECT_EQ(first.period, 8.5);
  EXPECT_EQ(first.direction, -30.0);
  EXPECT_EQ(first.phase, 90.0);
  const auto& second = std::get<RegularWave>(sea.systems[1]);
  EXPECT_EQ(second.height, 1.0);
  EXPECT_EQ(second.direction, 0.0);
  EXPECT_EQ(second.phase, 0.0);
}

TEST(SeaToml, ReadsEveryKeyOfASpectrum) {
  const SeaDescription sea = sea_of(waves_with(
      "type = \"jonswap\"\nsignificant_wave_height = 3\npeak_period = 9\ngamma = 2.5\ndirection = 45\n"
      "spreading = 12.0\nfrequencies = 30\ndirections = 7\ncutoff = 4\nseed = 9223372036854775807"));
  ASSERT_EQ(sea.systems.size(), 1U);
  const auto& waves = std::get<IrregularWaves>(sea.systems[0]);
  EXPECT_EQ(waves.significant_wave_height, 3.0);
  EXPECT_EQ(waves.peak_period, 9.0);
  EXPECT_EQ(waves.gamma, 2.5);
  EXPECT_EQ(waves.direction, 45.0);
  EXPECT_EQ(waves.spreading, 12.0);
  EXPECT_EQ(waves.frequencies, 30);
  EXPECT_EQ(waves.directions, 7);
  EXPECT_EQ(waves.cutoff, 4.0);
  EXPECT_EQ(waves.seed, 9'223'372'036'854'775'807U);
}

TEST(SeaToml, UsesDefaultsOfSpectra) {
  const std::string required = "significant_wave_height = 2\npeak_period = 8\n";
  const auto waves_of = [&](const std::string& keys) {
    return std::get<IrregularWaves>(sea_of(waves_with(keys + required)).systems.at(0));
  };
  const IrregularWaves jonswap = waves_of("type = \"jonswap\"\n");
  EXPECT_FALSE(jonswap.gamma);
  EXPECT_EQ(jonswap.direction, 0.0);
  EXPECT_FALSE(jonswap.spreading);
  EXPECT_FALSE(jonswap.frequencies);
  EXPECT_EQ(jonswap.directions, 1);
  EXPECT_EQ(jonswap.cutoff, 3.0);
  EXPECT_EQ(jonswap.seed, 1U);
  EXPECT_EQ(waves_of("type = \"jonswap\"\nspreading = 10\n").directions, 5);
  EXPECT_EQ(waves_of("type = \"jonswap\"\ndirections = 1\n").directions, 1);
  EXPECT_EQ(waves_of("type = \"pierson_moskowitz\"\n").gamma, 1.0);
}

TEST(SeaToml, ReadsOneTableAsOneSystem) {
  const SeaDescription sea =
      sea_of("[water.waves]\ntype = \"regular\"\nheight = 1\nperiod = 5\n" + scene_with_crate());
  ASSERT_EQ(sea.systems.size(), 1U);
  EXPECT_EQ(std::get<RegularWave>(sea.systems[0]).period, 5.0);
  EXPECT_TRUE(sea_of(water_with("waves = []")).systems.empty());
}

TEST(SeaToml, ReadsListedComponents) {
  const SeaDescription sea = sea_of(waves_with(
      "type = \"components\"\ncomponents = [{ amplitude = 0.5, angular_frequency = 0.7, direction = 10, "
      "phase = 20 }, { amplitude = 1, angular_frequency = 2 }]"));
  const auto& components = std::get<WaveComponents>(sea.systems.at(0));
  ASSERT_EQ(components.size(), 2U);
  EXPECT_EQ(components[0].amplitude, 0.5);
  EXPECT_EQ(components[0].angular_frequency, 0.7);
  EXPECT_EQ(components[0].direction, 10.0);
  EXPECT_EQ(components[0].phase, 20.0);
  EXPECT_EQ(components[1].direction, 0.0);
  EXPECT_EQ(components[1].phase, 0.0);
}

TEST(SeaToml, ReadsComponentsFromAFileBesideTheScene) {
  const TempDir directory;
  directory.write("sea.csv", "amplitude,angular_frequency,direction,phase\n0.5,0.7,10,20\n");
  const std::string scene =
      directory.write("pool.toml", waves_with("type = \"components\"\nfile = \"sea.csv\""));
  const Expected<SceneDescription> description = read_scene_file(scene);
  ASSERT_TRUE(description) << description.error().message();
  const auto& components = std::get<WaveComponents>(description->sea.systems.at(0));
  ASSERT_EQ(components.size(), 1U);
  EXPECT_EQ(components[0].phase, 20.0);
}

TEST(SeaToml, NamesFileAndLineOfWrongComponentFiles) {
  const TempDir directory;
  directory.write("sea.csv", "amplitude,angular_frequency,direction,phase\n0.5,0.7,10,20\n-1,0.7,10,20\n");
  const auto error_with = [&](const std::string& file) {
    return preparation_error(waves_with("type = \"components\"\nfile = \"" + file + "\""), directory.path());
  };
  const std::string start = "pool.toml:3: [[water.waves]] number 1, ";
  EXPECT_THAT(error_with("sea.csv"),
              StartsWith(start + directory.path("sea.csv") + ":3, column 1: amplitude = '-1'; expected "));
  EXPECT_THAT(error_with("missing.csv"),
              StartsWith(start + directory.path("missing.csv") + ": no such file"));
}

TEST(SeaToml, ReportsCompleteErrors) {
  EXPECT_EQ(parse_error(waves_with("type = \"regular\"\nheight = -1\nperiod = 8")),
            "pool.toml:3: [[water.waves]] number 1: height = -1; expected a number from 0 to 10000 (m).");
  EXPECT_EQ(parse_error(waves_with("type = \"jonswapp\"")),
            "pool.toml:2: [[water.waves]] number 1: type = \"jonswapp\"; expected one of regular, jonswap, "
            "pierson_moskowitz, components. The nearest is 'jonswap'.");
}

TEST(SeaToml, RejectsWrongKeysOfTheWater) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"wave_pressure = \"wheler\"", "expected one of wheeler, hydrostatic. The nearest is 'wheeler'."},
      {"wave_pressure = 1", "wave_pressure = 1"},
      {"wave = 3",
       "unknown key 'wave'; expected one of level, density, depth, wave_pressure, time_origin, "
       "ramp, waves, current, layer. The nearest known key is 'waves'."},
      {"waves = \"recieved\"",
       "waves = \"recieved\"; expected a table [[water.waves]] for each wave system, \"received\", or "
       "\"grid\""},
      {"waves = 3", "waves = 3; expected a table"},
      {"waves = [1, 2]", "waves = [1, 2]; expected a table"},
      {"waves = [{ type = \"regular\" }, 2]", "expected a table [[water.waves]]"},
  };
  for (const auto& [keys, expected] : wrong) {
    EXPECT_THAT(parse_error(water_with(keys)),
                AllOf(StartsWith("pool.toml:2: [water]: "), HasSubstr(expected)))
        << keys;
  }
}

TEST(SeaToml, RejectsKeysThatComeWithAReceivedSea) {
  for (const std::string key : {"depth = 30", "wave_pressure = \"wheeler\"", "time_origin = 0", "ramp = 5"}) {
    const std::string name = key.substr(0, key.find(' '));
    for (const std::string waves : {"waves = \"received\"", "waves = \"grid\""}) {
      EXPECT_THAT(parse_error(water_with(key + "\n" + waves)),
                  AllOf(StartsWith("pool.toml:2: [water]: " + name),
                        HasSubstr("expected no " + name + " with " + waves)))
          << key;
    }
  }
}

TEST(SeaToml, RejectsWrongKeysOfWaveSystems) {
  const std::string regular = "type = \"regular\"\nheight = 1\nperiod = 8\n";
  const std::string jonswap = "type = \"jonswap\"\nsignificant_wave_height = 2\npeak_period = 8\n";
  const std::string moskowitz =
      "type = \"pierson_moskowitz\"\nsignificant_wave_height = 2\npeak_period = 8\n";
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"height = 1", "1: [[water.waves]] number 1: no key 'type'; expected type = \"jonswap\" or another"},
      {"type = 3", "type = 3; expected one of regular"},
      {regular + "direction = \"north\"",
       "pool.toml:5: [[water.waves]] number 1: direction = \"north\"; expected a number from -1e+06 to 1e+06 "
       "(degrees)"},
      {regular + "amplitude = 1", "unknown key 'amplitude'; expected one of type, height, period, direction"},
      {regular + "seed = 1", "unknown key 'seed'"},
      {"type = \"regular\"\nperiod = 8", "no key 'height'; expected a number from 0 to 10000 (m)"},
      {"type = \"regular\"\nheight = 8", "no key 'period'; expected a number from 0.01"},
      {"type = \"regular\"\nheight = 1\nperio = 2", "The nearest known key is 'period'"},
      {"type = \"jonswap\"\npeak_period = 8", "no key 'significant_wave_height'"},
      {"type = \"jonswap\"\nsignificant_wave_height = 8", "no key 'peak_period'"},
      {jonswap + "frequencies = 9223372036854775807", "frequencies = 9223372036854775807"},
      {jonswap + "directions = 5",
       "pool.toml:5: [[water.waves]] number 1: directions = 5; expected 1 without a spreading. Likely "
       "cause: "},
      {jonswap + "hs = 1", "unknown key 'hs'"},
      {moskowitz + "gamma = 3.3",
       "gamma = 3.3; expected no gamma with type = \"pierson_moskowitz\", which is jonswap with gamma 1"},
      {"type = \"components\"", "neither 'file' nor 'components'; expected one of them"},
      {"type = \"components\"\nfile = \"a.csv\"\ncomponents = []", "both 'file' and 'components'"},
      {"type = \"components\"\nfile = 3", "file = 3; expected a string"},
      {"type = \"components\"\ncomponents = 3", "components = 3; expected an array of tables"},
      {"type = \"components\"\ncomponents = [1]", "components = [1]; expected an array of tables"},
      {"type = \"components\"\nfiel = \"a.csv\"",
       "unknown key 'fiel'; expected one of type, file, components"},
      {"type = \"components\"\ncomponents = [{ amplitude = 1, angular_frequency = 1 }, { amplitude = 1 }]",
       "pool.toml:3: [[water.waves]] number 1, components number 2: no key 'angular_frequency'"},
      {"type = \"components\"\ncomponents = [{ angular_frequency = 1 }]", "no key 'amplitude'"},
      {"type = \"components\"\ncomponents = [{ amplitude = 1, angular_frequency = 1, period = 1 }]",
       "unknown key 'period'; expected one of amplitude, angular_frequency, direction, phase"},
  };
  for (const auto& [keys, expected] : wrong) {
    EXPECT_THAT(parse_error(waves_with(keys)), HasSubstr(expected)) << keys;
  }
}

TEST(SeaToml, NumbersSystemsInErrors) {
  const std::string good = "[[water.waves]]\ntype = \"regular\"\nheight = 1\nperiod = 8\n";
  EXPECT_THAT(parse_error(good + waves_with("type = \"regular\"\nheight = nan\nperiod = 8")),
              StartsWith("pool.toml:7: [[water.waves]] number 2: height = nan"));
  EXPECT_THAT(parse_error("[water.waves]\ntype = \"regular\"\nheight = nan\n" + scene_with_crate()),
              StartsWith("pool.toml:3: [water.waves]: height = nan"));
}

TEST(SeaToml, LocatesErrorsAboutTheWholeSea) {
  const std::string jonswap = "type = \"jonswap\"\nsignificant_wave_height = 2\npeak_period = 8\n";
  EXPECT_THAT(
      preparation_error(
          "\n" + water_with("level = 1\n[[water.waves]]\n" + jonswap + "spreading = 10\nfrequencies = 1000")),
      StartsWith("pool.toml:2: [water], the sea: number of wave components = 5000; expected at most 4096"));
  EXPECT_THAT(preparation_error("\n\n" + waves_with(jonswap + "spreading = 10\nfrequencies = 1000")),
              StartsWith("pool.toml:3: [water], the sea: number of wave components = 5000"))
      << "without a line [water]";
  EXPECT_THAT(
      preparation_error(water_with("depth = 1.5\n[[water.waves]]\n" + jonswap)),
      StartsWith("pool.toml:1: [water], wave system 1: significant_wave_height = 2; expected less than "
                 "the water's depth, 1.5 m"));
  EXPECT_THAT(preparation_error("[world]\ngravity = 0\n" + waves_with(jonswap)),
              StartsWith("pool.toml:3: [water], the sea: gravity = 0; expected a number above 0"));
}

// All systems together have at most 4096 components.
TEST(SeaToml, LimitsTheNumberOfComponents) {
  std::string components;
  for (int i = 0; i < 4095; ++i) components += "{ amplitude = 0.001, angular_frequency = 1 },";
  const std::string listed = "type = \"components\"\ncomponents = [" + components;
  const std::string regular = "[[water.waves]]\ntype = \"regular\"\nheight = 0.01\nperiod = 8\n";
  EXPECT_EQ(preparation_error(waves_with(listed + "]") + regular), "accepted");
  EXPECT_THAT(preparation_error(waves_with(listed + "]") + regular + regular),
              HasSubstr("number of wave components = 4097; expected at most 4096"));
}

TEST(SeaToml, AcceptsEveryTypeTogether) {
  EXPECT_EQ(preparation_error(R"(
[[body]]
id = 1
shape = { type = "box" }
[[water.waves]]
type = "regular"
height = 1
period = 10
[[water.waves]]
type = "jonswap"
significant_wave_height = 1
peak_period = 8
[[water.waves]]
type = "pierson_moskowitz"
significant_wave_height = 1
peak_period = 6
spreading = 4
[[water.waves]]
type = "components"
components = [{ amplitude = 0.1, angular_frequency = 1 }]
[water]
depth = 20
)"),
            "accepted");
}

}  // namespace
}  // namespace buoyancy
