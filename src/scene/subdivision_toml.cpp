#include "scene/subdivision_toml.h"

#include <array>
#include <cmath>
#include <utility>

#include "scene/shape_toml.h"
#include "scene/up_axis.h"

namespace buoyancy {
namespace {

// What the sections of a body share.
struct SectionContext {
  const std::string& body_name;
  const std::filesystem::path& directory;
  SceneParseContext& context;
};

// Calls read(description, table, orientation_B) for every section [[body.<key>]]. orientation_B: of its
// frame.
template <typename Description, typename Read>
void parse_sections(TomlTable& body, std::string_view key, const SectionContext& where,
                    std::vector<Description>& descriptions, const Read& read) {
  const toml::node* node = body.node(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array != nullptr && array->empty()) return;
  const std::string section = "[body." + std::string(key) + "]";
  if (array == nullptr || !array->is_homogeneous<toml::table>()) {
    body.fail_at(key, "a list of tables: a section [" + section + "] for each",
                 node->is_table() ? section + " in single brackets" : "",
                 "Write [" + section + "] in double brackets");
    return;
  }
  for (const toml::node& element : *array) {
    const toml::table& toml = *element.as_table();
    Description& description = descriptions.emplace_back();
    description.name = std::string(key) + " " + std::to_string(descriptions.size() - 1);
    description.source_location = where.context.location(toml.source());
    const std::string label = where.body_name + ", " + description.name;
    TomlTable table(toml, label, where.context);
    table.read("name", description.name);
    const bool has_source = parse_mesh(table, label, where.directory, where.context, description.mesh);
    MeshPlacement in_body;
    table.read("position", in_body.position_B, "m");
    parse_orientation(table, in_body.orientation_B);
    description.mesh.placement = compose(in_body, description.mesh.placement);
    read(description, table, in_body.orientation_B);
    if (!has_source) {
      table.fail("neither 'mesh' nor 'shape'", "one of them", {},
                 "Add mesh = \"FILE\" or shape = { type = \"box\", size = [1, 1, 1] }");
    }
  }
}

// Reads `scale`: a number for all coordinates, or one for each.
void parse_scale(TomlTable& table, Vec3& scale) {
  const toml::node* const given = table.node("scale");
  if (given == nullptr || !given->is_array()) {
    double factor = 1.0;
    table.read("scale", factor, NumberRange::above_zero(""));
    if (given != nullptr) scale = Vec3::Constant(factor);
    return;
  }
  Vec3 factors = scale;
  table.read("scale", factors, "factors of x, y and z");
  if ((factors.array() != 0.0).all()) {
    scale = factors;
  } else {
    table.fail_at("scale", "a number above 0, or factors of x, y and z of which none is 0",
                  "a mesh without an extent", "Use a negative factor to mirror the mesh");
  }
}

// Reads `repair`, `mirror`, `close_holes` and `freeboard`.
void parse_repair(TomlTable& table, MeshRepair& repair) {
  if (const auto chosen = table.choice("repair", kRepairPolicyNames)) {
    repair.policy = *chosen == 1 ? RepairPolicy::kNone : RepairPolicy::kAutomatic;
  }
  if (const auto chosen = table.choice("mirror", kAxisNames)) repair.mirror = static_cast<Axis>(*chosen);
  std::optional<double> share;
  table.read("close_holes", share, NumberRange::above_zero("of the volume"));
  if (share) {
    repair.closing.holes = true;
    repair.closing.max_change = *share;
  }
  std::optional<double> freeboard;
  table.read("freeboard", freeboard, NumberRange::above_zero("m"));
  repair.closing.freeboard = freeboard.value_or(0.0);
}

// Reads `surface` and `fill_axis`. orientation_B: of the tank's frame, of any norm.
void read_piston(TankDescription& tank, const Eigen::Quaterniond& orientation_B, TomlTable& table) {
  constexpr std::array<std::string_view, 2> kSurfaces{"level", "none"};
  constexpr std::array<std::string_view, 6> kFillAxes{"x", "y", "z", "-x", "-y", "-z"};
  const bool has_piston = table.choice("surface", kSurfaces) == std::size_t{1};
  const std::optional<std::size_t> axis = table.choice("fill_axis", kFillAxes);
  if (has_piston) {
    tank.piston_axis_B = orientation_B.normalized() * *axis_from_name(axis ? kFillAxes[*axis] : "z");
  } else if (axis) {
    table.fail_at("fill_axis", "a fill axis only with surface = \"none\"",
                  "liquid with a level surface fills the tank from its lowest point", "Remove it");
  }
}

void read_tank(TankDescription& tank, const Water& water, const Eigen::Quaterniond& orientation_B,
               TomlTable& table) {
  tank.density = water.density;
  table.read("density", tank.density, NumberRange::from_zero("kg/m^3"));
  table.read("fill", tank.fill, NumberRange::from_zero_to(1.0));
  table.read("liquid_volume", tank.liquid_volume, NumberRange::from_zero("m^3"));
  read_piston(tank, orientation_B, table);
  table.finish();
  if (tank.fill && tank.liquid_volume) {
    table.fail("both 'fill' and 'liquid_volume'", "one of them", {}, "Remove one");
  } else if (!tank.fill && !tank.liquid_volume) {
    table.fail("neither 'fill' nor 'liquid_volume'",
               "one of them: fill, of the tank's volume, or liquid_volume (m^3)", {},
               "Add fill = 0 for an empty tank");
  }
}

}  // namespace

void parse_orientation(TomlTable& table, Eigen::Quaterniond& orientation) {
  std::array<double, 4> wxyz{1.0, 0.0, 0.0, 0.0};
  table.read("orientation", std::span<double>(wxyz), "w, x, y, z");
  Eigen::Vector4d q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double largest = q.cwiseAbs().maxCoeff();
  if (largest > 0.0) {
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (double& component : q) component = std::ldexp(component, 1 - exponent);
    orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  } else {
    table.fail_at("orientation", "a quaternion (w, x, y, z), not zero; [1, 0, 0, 0] is the identity");
  }
}

bool parse_mesh(TomlTable& table, const std::string& name, const std::filesystem::path& directory,
                SceneParseContext& context, MeshDescription& mesh) {
  const bool has_mesh = table.has("mesh");
  const bool has_scale = table.has("scale");
  const bool has_shape = table.has("shape");
  std::string file;
  parse_scale(table, mesh.placement.scale);
  parse_repair(table, mesh.repair);
  const toml::node* const given = table.node("mesh");
  if (given != nullptr && given->is_table()) {
    TomlTable placed(*given->as_table(), name + ", mesh", context);
    placed.read("file", file);
    parse_scale(placed, mesh.placement.scale);
    placed.read("position", mesh.placement.position_B, "m");
    parse_orientation(placed, mesh.placement.orientation_B);
    placed.finish();
    if (!placed.has("file")) placed.fail_missing("file", "the name of a mesh file");
    if (has_scale && placed.has("scale")) {
      table.fail("'scale' both beside and in 'mesh'", "one of them", {}, "Remove one");
    }
  } else {
    table.read("mesh", file);
  }
  if (has_mesh && has_shape) {
    table.fail("both 'mesh' and 'shape'", "one of them", {}, "Remove one");
  } else if (has_shape && has_scale) {
    table.fail("both 'scale' and 'shape'", "a scale only with a mesh file", {},
               "Give the shape its sizes in metres");
  } else if (has_shape && mesh.repair != MeshRepair{}) {
    table.fail("a repair and 'shape'",
               "'repair', 'mirror', 'close_holes' and 'freeboard' only with a mesh file", "shapes are closed",
               "Remove it");
  }
  if (has_mesh) mesh.source = MeshFile{(directory / file).lexically_normal()};
  if (const toml::table* shape = table.table("shape")) {
    TomlTable shape_table(*shape, name + ", shape", context);
    if (std::optional<Shape> read = parse_shape(shape_table)) mesh.source = *read;
  }
  return has_mesh || has_shape;
}

void parse_subdivision(TomlTable& body_table, const std::string& body_name, const Water& water,
                       const std::filesystem::path& directory, SceneParseContext& context,
                       BodyDescription& body) {
  const SectionContext where{body_name, directory, context};
  parse_sections(body_table, "part", where, body.parts,
                 [](const PartDescription&, TomlTable& table, const auto&) { table.finish(); });
  parse_sections(body_table, "compartment", where, body.compartments,
                 [](CompartmentDescription& compartment, TomlTable& table, const auto&) {
                   table.read("permeability", compartment.permeability, NumberRange::above_zero_to(1.0));
                   table.read("flooded", compartment.flooded, NumberRange::from_zero_to(1.0));
                   table.finish();
                 });
  parse_sections(body_table, "tank", where, body.tanks,
                 [&water](TankDescription& tank, TomlTable& table, const Eigen::Quaterniond& orientation_B) {
                   read_tank(tank, water, orientation_B, table);
                 });
}

}  // namespace buoyancy
