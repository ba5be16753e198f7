#include "scene/shape_toml.h"

#include <limits>

namespace buoyancy {
namespace {

// The readers check types; check_shape checks ranges.
void read_length(TomlTable& table, std::string_view key, double& value) {
  table.read(key, value, NumberRange::any("m"));
}

void read_fields(TomlTable& table, BoxShape& box) {
  table.read("size", std::span<double>(box.size), "m");
  table.read("segments", std::span<std::int32_t>(box.segments));
}
void read_fields(TomlTable& table, SphereShape& sphere) {
  read_length(table, "radius", sphere.radius);
  table.read("segments", sphere.segments);
}
void read_fields(TomlTable& table, CylinderShape& cylinder) {
  read_length(table, "radius", cylinder.radius);
  read_length(table, "height", cylinder.height);
  table.read("segments", cylinder.segments);
  table.read("stacks", cylinder.stacks);
}
void read_fields(TomlTable& table, ConeShape& cone) {
  read_length(table, "radius", cone.radius);
  read_length(table, "height", cone.height);
  table.read("segments", cone.segments);
  table.read("stacks", cone.stacks);
}
void read_fields(TomlTable& table, TorusKnotShape& knot) {
  read_length(table, "radius", knot.radius);
  read_length(table, "tube", knot.tube);
  table.read("p", knot.p);
  table.read("q", knot.q);
  table.read("tubular", knot.tubular);
  table.read("radial", knot.radial);
}
void read_fields(TomlTable& table, WigleyShape& hull) {
  read_length(table, "length", hull.length);
  read_length(table, "beam", hull.beam);
  read_length(table, "draft", hull.draft);
  read_length(table, "freeboard", hull.freeboard);
  table.read("segments", hull.segments);
  table.read("levels", hull.levels);
}
void read_fields(TomlTable& table, RockShape& rock) {
  read_length(table, "radius", rock.radius);
  table.read("frequency", rock.frequency);
  table.read("roughness", rock.roughness, NumberRange::any(""));
  table.read("seed", rock.seed, 0);
}

constexpr std::size_t kShapeCount = std::variant_size_v<Shape>;

// Returns one shape of each type, with default sizes.
template <std::size_t... kIndices>
std::array<Shape, kShapeCount> all_shapes(std::index_sequence<kIndices...>) {
  return {Shape(std::in_place_index<kIndices>)...};
}

}  // namespace

std::optional<Shape> parse_shape(TomlTable& table) {
  std::array<Shape, kShapeCount> shapes = all_shapes(std::make_index_sequence<kShapeCount>());
  std::array<std::string_view, kShapeCount> names;
  for (std::size_t i = 0; i < kShapeCount; ++i) names[i] = type_name(shapes[i]);

  const std::optional<std::size_t> type = table.choice("type", names);
  if (!type) {
    table.fail_missing("type", "type = \"box\" or another shape's name");
    return std::nullopt;
  }
  Shape& shape = shapes[*type];
  std::visit([&](auto& fields) { read_fields(table, fields); }, shape);
  table.finish();
  if (table.failed()) return std::nullopt;

  Expected<Shape> checked = check_shape(shape);
  if (!checked) {
    const Error& error = checked.error();
    table.fail(error.actual, error.expected, error.cause, error.hint);
    return std::nullopt;
  }
  return *std::move(checked);
}

}  // namespace buoyancy
