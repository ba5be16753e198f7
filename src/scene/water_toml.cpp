#include "scene/water_toml.h"

#include <string>

#include "base/format.h"

namespace buoyancy {
namespace {

constexpr NumberRange kDensity = NumberRange::above_zero_to(1e5, "kg/m^3");
constexpr NumberRange kHeight = NumberRange::from_to(-1e5, 1e5, "m");

// Calls read(table) for each section of a list. section: its name in the file, without brackets.
template <typename Read>
void read_sections(TomlTable& parent, std::string_view key, const std::string& section, std::size_t max,
                   SceneParseContext& context, const Read& read) {
  const toml::node* node = parent.node(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr || !(array->empty() || array->is_homogeneous<toml::table>())) {
    return parent.fail_at(key, "a list of tables: a section [[" + section + "]] for each",
                          node->is_table() ? "[" + section + "] in single brackets" : "",
                          "Write [[" + section + "]] in double brackets");
  }
  if (array->size() > max) {
    return parent.fail(std::to_string(array->size()) + " sections [[" + section + "]]",
                       "at most " + std::to_string(max), {}, "Combine those that differ least");
  }
  int number = 0;
  for (const toml::node& element : *array) {
    TomlTable table(*element.as_table(), "[[" + section + "]] number " + std::to_string(++number), context);
    read(table);
    if (context.error) return;
  }
}

void require(TomlTable& table, std::string_view key, const std::string& expected) {
  if (!table.has(key)) table.fail_missing(key, expected);
}

// Sections are written in the order of the water, from the top down.
void fail_order(TomlTable& table, std::string_view key, double above, const std::string& of_what) {
  table.fail_at(key, "less than " + format_shortest(above) + " m, " + of_what,
                "sections are in the order of the water, from the top down");
}

WaterLayer read_layer(TomlTable& table, const Water& water) {
  WaterLayer layer;
  table.read("below", layer.below, NumberRange::any("m"));
  table.read("density", layer.density, kDensity);
  // Missing keys are checked last, so that a mistyped key is reported as unknown and not as missing.
  table.finish();
  require(table, "below", "the height of its top (m): where up . x < below");
  require(table, "density", kDensity.describe());
  if (table.failed()) return layer;
  const bool is_first = water.layers.empty();
  const double height_above = is_first ? water.level : water.layers.back().below;
  const double density_above = deepest_density(water);
  if (!(layer.below < height_above)) {
    fail_order(table, "below", height_above,
               is_first ? "the level of the water" : "that of the layer above it");
  }
  if (layer.density < density_above) {
    table.fail_at("density",
                  "at least " + format_shortest(density_above) + " kg/m^3, the density of the water above it",
                  "lighter water rises", "Exchange the densities, or correct [water] density");
  }
  return layer;
}

CurrentPoint read_point(TomlTable& table, const CurrentProfile& profile) {
  CurrentPoint point;
  table.read("height", point.height, kHeight);
  table.read("velocity", point.velocity_W, "m/s");
  table.finish();
  require(table, "height", "the height over the level of the water (m), below 0 under the surface");
  require(table, "velocity", "velocity = [x, y, z] (m/s, W)");
  if (table.failed()) return point;
  if (!profile.empty() && !(point.height < profile.back().height)) {
    fail_order(table, "height", profile.back().height, "the height of the one above it");
  }
  return point;
}

}  // namespace

void parse_layers(TomlTable& table, SceneParseContext& context, Water& water) {
  read_sections(table, "layer", "water.layer", kMaxWaterLayers, context,
                [&water](TomlTable& section) { water.layers.push_back(read_layer(section, water)); });
  if (water.layers.empty() || water.density > 0.0) return;
  table.fail("density = 0 over layers", "a density above 0 (kg/m^3)",
             "the density of what is above the first layer is left out or wrong");
}

void parse_current(TomlTable& water, SceneParseContext& context, Vec3& velocity_W, CurrentProfile& profile) {
  const toml::table* toml = water.table("current");
  if (toml == nullptr) return;
  TomlTable table(*toml, "[water.current]", context);
  table.read("velocity", velocity_W, "m/s");
  read_sections(table, "profile", "water.current.profile", kMaxCurrentPoints, context,
                [&profile](TomlTable& section) { profile.push_back(read_point(section, profile)); });
  table.finish();
  if (table.has("velocity") && table.has("profile")) {
    table.fail("both 'velocity' and sections [[water.current.profile]]", "one of them", {}, "Remove one");
  }
  if (profile.empty()) {
    require(table, "velocity", "velocity = [x, y, z] (m/s, W)");
  } else {
    velocity_W = velocity_at(profile, 0.0);
  }
}

}  // namespace buoyancy
