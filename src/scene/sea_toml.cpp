#include "scene/sea_toml.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "waves/sea_ranges.h"
#include "waves/wave_components_csv.h"

namespace buoyancy {
namespace {

constexpr std::array kPressures{WavePressure::kWheeler, WavePressure::kHydrostatic};
constexpr std::array kPressureNames{to_string(kPressures[0]), to_string(kPressures[1])};

enum class WaveType { kRegular, kJonswap, kPiersonMoskowitz, kComponents };
constexpr std::array<std::string_view, 4> kTypeNames{"regular", "jonswap", "pierson_moskowitz", "components"};

constexpr std::int32_t kDefaultDirections = 5;  // where the waves are spread

void require(TomlTable& table, std::string_view key, const NumberRange& range) {
  if (!table.has(key)) table.fail_missing(key, range.describe());
}

void read_depth(TomlTable& table, double& depth) {
  const toml::node* node = table.node("depth");
  if (node == nullptr) return;
  const std::optional<double> number = node->value<double>();
  if (number && (sea_ranges::kDepth.contains(*number) || *number == HUGE_VAL)) {
    depth = *number;
  } else {
    table.fail_at("depth", sea_ranges::kDepth.describe() + ", or inf for deep water");
  }
}

RegularWave read_regular_wave(TomlTable& table) {
  RegularWave wave;
  table.read("height", wave.height, sea_ranges::kHeight);
  table.read("period", wave.period, sea_ranges::kPeriod);
  table.read("direction", wave.direction, sea_ranges::kAngle);
  table.read("phase", wave.phase, sea_ranges::kAngle);
  // Missing keys are checked last, so that a mistyped key is reported as unknown and not as missing.
  table.finish();
  require(table, "height", sea_ranges::kHeight);
  require(table, "period", sea_ranges::kPeriod);
  return wave;
}

IrregularWaves read_irregular_waves(TomlTable& table, WaveType type) {
  IrregularWaves waves;
  table.read("significant_wave_height", waves.significant_wave_height, sea_ranges::kHeight);
  table.read("peak_period", waves.peak_period, sea_ranges::kPeriod);
  if (type == WaveType::kJonswap) {
    table.read("gamma", waves.gamma, sea_ranges::kGamma);
  } else {
    if (table.has("gamma")) {
      table.fail_at("gamma", "no gamma with type = \"pierson_moskowitz\", which is jonswap with gamma 1", {},
                    "Remove it, or write type = \"jonswap\"");
    }
    waves.gamma = 1.0;
  }
  table.read("direction", waves.direction, sea_ranges::kAngle);
  table.read("spreading", waves.spreading, sea_ranges::kSpreading);
  if (table.has("frequencies")) table.read("frequencies", waves.frequencies.emplace(), sea_ranges::kBins);
  if (waves.spreading) waves.directions = kDefaultDirections;
  table.read("directions", waves.directions, sea_ranges::kBins);
  if (!waves.spreading && waves.directions > 1) {
    table.fail_at("directions", "1 without a spreading",
                  "waves without a spreading are long-crested: all run in one direction",
                  "Add spreading, the s of cos^2s, for example spreading = 10, or remove directions");
  }
  table.read("cutoff", waves.cutoff, sea_ranges::kCutoff);
  table.read("seed", waves.seed, 0);
  table.finish();
  require(table, "significant_wave_height", sea_ranges::kHeight);
  require(table, "peak_period", sea_ranges::kPeriod);
  return waves;
}

WaveComponent read_component(TomlTable table) {
  WaveComponent component;
  table.read("amplitude", component.amplitude, sea_ranges::kHeight);
  table.read("angular_frequency", component.angular_frequency, sea_ranges::kAngularFrequency);
  table.read("direction", component.direction, sea_ranges::kAngle);
  table.read("phase", component.phase, sea_ranges::kAngle);
  table.finish();
  require(table, "amplitude", sea_ranges::kHeight);
  require(table, "angular_frequency", sea_ranges::kAngularFrequency);
  return component;
}

WaveComponents read_component_list(TomlTable& table, const std::string& name, SceneParseContext& context) {
  WaveComponents components;
  const toml::node* node = table.node("components");
  const toml::array* array = node->as_array();
  if (array == nullptr || !(array->empty() || array->is_homogeneous<toml::table>())) {
    table.fail_at("components", "an array of tables { amplitude, angular_frequency, direction, phase }");
    return components;
  }
  for (const toml::node& element : *array) {
    std::string element_name = name;
    element_name += ", components number " + std::to_string(components.size() + 1);
    components.push_back(read_component({*element.as_table(), std::move(element_name), context}));
    if (table.failed()) break;
  }
  return components;
}

WaveComponents read_components(TomlTable& table, const std::string& name,
                               const std::filesystem::path& directory, SceneParseContext& context) {
  std::string file;
  table.read("file", file);
  const bool has_file = table.has("file");
  const bool has_list = table.has("components");
  table.finish();
  if (has_file == has_list) {
    table.fail(has_file ? "both 'file' and 'components'" : "neither 'file' nor 'components'", "one of them",
               {},
               has_file ? "Remove one" : "Add file = \"FILE.csv\" or components = [{ amplitude = 0.5, ...}]");
  }
  if (table.failed()) return {};
  if (has_list) return read_component_list(table, name, context);
  Expected<WaveComponents> components = read_wave_components((directory / file).lexically_normal());
  if (components) return *std::move(components);
  table.fail_in("file", std::move(components.error()));
  return {};
}

WaveSystem read_wave_system(const toml::table& toml, const std::string& name,
                            const std::filesystem::path& directory, SceneParseContext& context) {
  TomlTable table(toml, name, context);
  const std::optional<std::size_t> type = table.choice("type", kTypeNames);
  if (!type) {
    table.fail_missing("type", "type = \"jonswap\" or another type of waves");
    return RegularWave{};
  }
  switch (static_cast<WaveType>(*type)) {
    case WaveType::kRegular:
      return read_regular_wave(table);
    case WaveType::kComponents:
      return read_components(table, name, directory, context);
    case WaveType::kJonswap:
    case WaveType::kPiersonMoskowitz:
      break;
  }
  return read_irregular_waves(table, static_cast<WaveType>(*type));
}

void read_wave_systems(TomlTable& water, const std::filesystem::path& directory, SceneParseContext& context,
                       std::vector<WaveSystem>& systems) {
  const toml::node* waves = water.node("waves");
  if (waves == nullptr) return;
  if (const toml::table* table = waves->as_table()) {
    systems.push_back(read_wave_system(*table, "[water.waves]", directory, context));
    return;
  }
  const toml::array* array = waves->as_array();
  if (array == nullptr || !(array->empty() || array->is_homogeneous<toml::table>())) {
    water.fail_at("waves", "a table [[water.waves]] for each wave system, \"received\", or \"grid\"");
    return;
  }
  for (const toml::node& element : *array) {
    const std::string name = "[[water.waves]] number " + std::to_string(systems.size() + 1);
    systems.push_back(read_wave_system(*element.as_table(), name, directory, context));
    if (context.error) return;
  }
}

// Refuses the keys whose values come with a received sea.
void refuse_keys_of_received_sea(TomlTable& water, SeaMessages messages) {
  for (const std::string_view key : {"depth", "wave_pressure", "time_origin", "ramp"}) {
    if (!water.has(key)) continue;
    water.fail_at(key, "no " + std::string(key) + " with " + to_string(messages),
                  messages == SeaMessages::kGrids
                      ? "a grid is the surface at its time, over hydrostatic pressure"
                      : "the message of the sea says it",
                  "Remove it");
  }
}

SeaMessages sea_messages(TomlTable& water) {
  const toml::node* waves = water.node("waves");
  const toml::value<std::string>* text = waves == nullptr ? nullptr : waves->as_string();
  if (text == nullptr) return SeaMessages::kNone;
  if (text->get() == "received") return SeaMessages::kComponents;
  return text->get() == "grid" ? SeaMessages::kGrids : SeaMessages::kNone;
}

}  // namespace

SeaMessages parse_sea(TomlTable& water, const std::filesystem::path& directory, SceneParseContext& context,
                      SeaDescription& sea) {
  read_depth(water, sea.depth);
  if (const auto chosen = water.choice("wave_pressure", kPressureNames)) sea.pressure = kPressures[*chosen];
  water.read("time_origin", sea.time_origin, "us");
  water.read("ramp", sea.ramp, sea_ranges::kRamp);
  const SeaMessages messages = sea_messages(water);
  if (messages != SeaMessages::kNone) {
    refuse_keys_of_received_sea(water, messages);
    sea = {};
    return messages;
  }
  read_wave_systems(water, directory, context, sea.systems);
  return messages;
}

}  // namespace buoyancy
