#include "scene/scene_file.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <Eigen/Eigenvalues>

#include "base/format.h"
#include "base/spelling_suggestion.h"
#include "base/text_file.h"
#include "scene/event_toml.h"
#include "scene/loads_toml.h"
#include "scene/sea_toml.h"
#include "scene/subdivision_toml.h"
#include "scene/toml_nesting.h"
#include "scene/toml_table.h"
#include "scene/up_axis.h"
#include "scene/water_toml.h"

namespace buoyancy {
namespace {

constexpr std::uintmax_t kMaxSceneFileBytes = 64'000'000;

void read_world(TomlTable table, Water& water) {
  table.read("gravity", water.gravity, NumberRange::from_zero("m/s^2"));
  Vec3 up_W = water.up_W;
  table.read("up", up_W, "");
  const double largest = up_W.cwiseAbs().maxCoeff();
  if (largest > 0.0) {
    water.up_W = (up_W / largest).normalized();
  } else {
    table.fail_at("up", "a direction: three numbers, not all zero");
  }
  table.finish();
}

void read_water(const toml::table& toml, SceneDescription& scene, const std::filesystem::path& directory,
                SceneParseContext& context) {
  TomlTable table(toml, "[water]", context);
  scene.water_location = context.location(toml.source());
  table.read("level", scene.water.level, NumberRange::any("m"));
  table.read("density", scene.water.density, NumberRange::from_zero("kg/m^3"));
  scene.sea_messages = parse_sea(table, directory, context, scene.sea);
  parse_current(table, context, scene.sea.current_W, scene.current_profile);
  parse_layers(table, context, scene.water);
  table.finish();
}

void read_limits(TomlTable table, ImportLimits& limits) {
  table.read("mesh_bytes", limits.mesh_bytes, 1);
  table.read("vertices", limits.vertices, 1);
  table.read("faces", limits.faces, 1);
  table.read("import_seconds", limits.import_seconds, NumberRange::above_zero("s"));
  table.finish();
}

// Tolerance relative to the largest principal moment. For a thin plate this moment is the sum of the other
// two, and numbers rounded to three digits can exceed the sum by that much.
constexpr double kInertiaRounding = 0.01;

// Every principal moment of a rigid body, about any point, is above 0 and at most the sum of the other two.
void check_inertia(TomlTable& table, const Mat3& inertia_B) {
  const double scale = inertia_B.cwiseAbs().maxCoeff();
  Vec3 principal = Vec3::Zero();  // ascending
  if (scale > 0.0) {
    principal = Eigen::SelfAdjointEigenSolver<Mat3>(inertia_B / scale, Eigen::EigenvaluesOnly).eigenvalues();
  }
  const std::string here = " (here they are " + format_vector(scale * principal, 4) + " kg m^2)";
  const std::string other_order = "another order of the numbers (URDF's is Ixx, Ixy, Ixz, Iyy, Iyz, Izz)";
  const std::string hint =
      "Give [Ixx, Iyy, Izz] or [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] about the centre of mass, or leave inertia "
      "out: it then follows from a closed mesh";
  if (!(principal[0] > 0.0)) {
    table.fail_at(
        "inertia", "a positive definite matrix: principal moments above 0" + here,
        "a moment is not above 0, a product of inertia is too large for its moments, or " + other_order,
        hint);
  } else if (principal[2] > principal[0] + principal[1] + kInertiaRounding * principal[2]) {
    table.fail_at("inertia",
                  "principal moments of which none exceeds the sum of the other two, as for any body" + here,
                  "a number in another unit, " + other_order +
                      ", a product of inertia of the wrong sign, sums of m x^2 instead of m (y^2 + z^2), or "
                      "too large a correction from another point to the centre of mass",
                  hint);
  }
}

void read_inertia(TomlTable& table, DynamicsSpec& dynamics) {
  constexpr std::array<std::size_t, 2> kCounts{3, 6};
  std::vector<double> numbers = table.numbers("inertia", kCounts, "kg m^2");
  if (numbers.empty()) return;
  numbers.resize(6, 0.0);
  Mat3 inertia_B;
  inertia_B << numbers[0], numbers[3], numbers[4],  //
      numbers[3], numbers[1], numbers[5],           //
      numbers[4], numbers[5], numbers[2];
  check_inertia(table, inertia_B);
  dynamics.inertia_B = inertia_B;
}

// Reads `start`, once the velocities are known.
void read_start(TomlTable& table, DynamicsSpec& dynamics) {
  constexpr std::array<std::string_view, 2> kWords{"pose", "equilibrium"};
  if (table.choice("start", kWords) != 1U) return;
  dynamics.start = StartKind::kEquilibrium;
  for (const auto& [key, velocity] : {std::pair{"linear_velocity", &dynamics.linear_velocity},
                                      std::pair{"angular_velocity", &dynamics.angular_velocity}}) {
    if (*velocity == Vec3::Zero()) continue;
    table.fail_at(key, "no velocity with start = \"equilibrium\"", "a body at equilibrium is at rest",
                  "Remove it, or start = \"equilibrium\"");
  }
}

// body: already read, except for this section.
void read_dynamics(TomlTable table, const std::string& body_name, SceneParseContext& context,
                   BodyDescription& body) {
  DynamicsSpec& dynamics = body.dynamics;
  dynamics.given = true;
  table.read("mass", dynamics.mass, NumberRange::above_zero("kg"));
  table.read("density", dynamics.density, NumberRange::above_zero("kg/m^3"));
  if (table.has("center_of_mass")) {
    dynamics.center_of_mass_B = Vec3::Zero();
    table.read("center_of_mass", *dynamics.center_of_mass_B, "m");
  }
  read_inertia(table, dynamics);
  table.read("position", dynamics.position, "m");
  table.read("linear_velocity", dynamics.linear_velocity, "m/s");
  table.read("angular_velocity", dynamics.angular_velocity, "rad/s");
  read_start(table, dynamics);
  table.read("linear_damping", dynamics.linear_damping, NumberRange::from_zero("N/(m/s)"));
  table.read("linear_damping_quadratic", dynamics.linear_damping_quadratic,
             NumberRange::from_zero("N/(m/s)^2"));
  table.read("angular_damping", dynamics.angular_damping, NumberRange::from_zero("N m/(rad/s)"));
  table.read("angular_damping_quadratic", dynamics.angular_damping_quadratic,
             NumberRange::from_zero("N m/(rad/s)^2"));

  parse_orientation(table, dynamics.orientation);
  dynamics.orientation.normalize();
  parse_events(table, body_name, context, body);
  table.finish();
  if (dynamics.mass && dynamics.density) {
    table.fail("both 'mass' and 'density'",
               "at most one of them; without either, the density is half the water's", {}, "Remove one");
  }
}

void read_method(TomlTable& table, Method& method) {
  std::array<std::string_view, kAllMethods.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = to_string(kAllMethods[i]);
  if (const auto chosen = table.choice("method", names)) method = kAllMethods[*chosen];
}

void read_open_policy(TomlTable& table, OpenPolicy& open) {
  std::array<std::string_view, kOpenPolicyNames.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kOpenPolicyNames[i].first;
  if (const auto chosen = table.choice("open", names)) open = kOpenPolicyNames[*chosen].second;
}

void read_up(TomlTable& table, std::optional<Vec3>& up_B) {
  constexpr std::array<std::string_view, 6> kNames{"x", "-x", "y", "-y", "z", "-z"};
  if (const auto chosen = table.choice("up", kNames)) up_B = axis_from_name(kNames[*chosen]);
}

// Every response holds wrenches, so that only the other outputs need a flag.
void read_outputs(TomlTable& table, BodyDescription& body) {
  constexpr std::string_view kExpected = "[\"wrench\"], with \"hydrostatics\" and \"loads\" in it as needed";
  constexpr std::array<std::string_view, 3> kWords{"wrench", "hydrostatics", "loads"};
  const toml::node* outputs = table.node("outputs");
  if (outputs == nullptr) return;
  const toml::array* array = outputs->as_array();
  std::array<int, kWords.size()> named{};
  if (array != nullptr) {
    for (const toml::node& output : *array) {
      const auto text = output.value<std::string_view>();
      if (!text) return table.fail_at("outputs", std::string(kExpected));
      const auto word = std::find(kWords.begin(), kWords.end(), *text);
      if (word == kWords.end()) {
        return table.fail_at("outputs", std::string(kExpected), {},
                             "The nearest to '" + std::string(*text) + "' is '" +
                                 std::string(nearest_word(*text, kWords)) + "'");
      }
      ++named[static_cast<std::size_t>(word - kWords.begin())];
    }
  }
  if (array == nullptr || array->empty() || *std::max_element(named.begin(), named.end()) > 1) {
    return table.fail_at("outputs", std::string(kExpected));
  }
  if (named[0] == 0) {
    return table.fail_at("outputs", std::string(kExpected), "every response holds wrenches",
                         "Add \"wrench\" to the list");
  }
  body.hydrostatics = named[1] == 1;
  body.loads = named[2] == 1;
}

BodyDescription read_body(const toml::table& toml, std::size_t number, const Water& water,
                          const std::filesystem::path& directory, SceneParseContext& context) {
  TomlTable table(toml, "[[body]] number " + std::to_string(number), context);
  BodyDescription body;
  table.read("id", body.id);
  const bool has_id = table.has("id");
  if (has_id) table.rename("body " + std::to_string(body.id));
  body.name = "body " + std::to_string(body.id);
  body.source_location = context.location(toml.source());

  table.read("name", body.name);
  const bool has_source = parse_mesh(table, "body " + std::to_string(body.id), directory, context, body.mesh);
  read_method(table, body.method);
  table.read("tolerance", body.tolerance, NumberRange::from_zero_to(1.0));
  read_open_policy(table, body.open);
  table.read("reference_point", body.reference_B, "m");
  read_up(table, body.up_B);
  read_outputs(table, body);
  const std::string body_name = "body " + std::to_string(body.id);
  parse_drag(table, body_name, context, body.drag);
  parse_added_mass(table, body_name, context, body.added_mass);
  parse_subdivision(table, body_name, water, directory, context, body);
  const toml::table* client = table.table("client");

  // Missing keys are checked last, so that a mistyped key is reported as unknown and not as missing.
  table.finish();
  if (!has_id) table.fail_missing("id", "a unique whole number for each body");
  body.is_parts_only = !has_source && !body.parts.empty();
  if (body.is_parts_only && table.has("scale")) {
    table.fail_at("scale", "a scale only with a mesh file", "the body has no mesh beside its parts",
                  "Give each part its own scale");
  }
  if (!has_source && body.parts.empty()) {
    table.fail("neither 'mesh' nor 'shape'", "one of them, or sections [[body.part]]", {},
               "Add mesh = \"FILE\" or shape = { type = \"box\", size = [1, 1, 1] }");
  }
  if (client != nullptr) {
    read_dynamics(TomlTable(*client, body_name + ", [body.client]", context), body_name, context, body);
  }
  const Vec3 up_B = body.dynamics.orientation.conjugate() * water.up_W;
  for_each_mesh(body, [&up_B](MeshDescription& mesh, auto&&...) {
    // Only a freeboard depends on up: without one, bodies share a mesh whatever their orientation.
    if (mesh.repair.closing.freeboard > 0.0) mesh.repair.closing.up_B = up_B;
  });
  return body;
}

void read_bodies(TomlTable& top, SceneDescription& scene, const std::filesystem::path& directory,
                 SceneParseContext& context) {
  const toml::node* bodies = top.node("body");
  if (bodies == nullptr) return;
  const toml::array* array = bodies->as_array();
  if (array != nullptr && array->empty()) return;
  if (array == nullptr || !array->is_homogeneous<toml::table>()) {
    top.fail("'body' is not a list of tables", "a section [[body]] for each body",
             bodies->is_table() ? "[body] in single brackets" : "", "Write [[body]] in double brackets");
    return;
  }
  std::map<std::int32_t, std::string> locations;  // by id
  for (const toml::node& element : *array) {
    const toml::table& toml = *element.as_table();
    scene.bodies.push_back(read_body(toml, scene.bodies.size() + 1, scene.water, directory, context));
    const BodyDescription& body = scene.bodies.back();
    if (const auto [earlier, is_new] = locations.emplace(body.id, body.source_location); !is_new) {
      TomlTable(toml, "body " + std::to_string(body.id), context)
          .fail("id = " + std::to_string(body.id), "a unique id for each body",
                "the body at " + earlier->second + " has the same id");
    }
    if (context.error) return;
  }
}

// Every TOML text of all programs and libraries is parsed here.
Expected<toml::table> parse_toml(std::string_view text, const std::string& name) {
  if (text.size() > kMaxSceneFileBytes) {
    return make_error({name, std::to_string(text.size()) + " bytes",
                       "at most " + std::to_string(kMaxSceneFileBytes) + " bytes of TOML", "", ""});
  }
  if (std::optional<Error> too_deep = check_toml_nesting(text, name)) return make_error(*std::move(too_deep));
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const toml::source_position& position = error.source().begin;
    return make_error({name + ":" + std::to_string(position.line) + ":" + std::to_string(position.column),
                       printable(std::string(error.description())),
                       "TOML (https://toml.io)",
                       {},
                       {}});
  }
}

// Parses a scene, or the sections [world] and [water] alone.
Expected<SceneDescription> parse(std::string_view text, const std::string& name,
                                 const std::filesystem::path& directory, bool has_bodies) {
  const Expected<toml::table> root = parse_toml(text, name);
  if (!root) return make_error(root.error());
  SceneParseContext context{name, std::nullopt};
  SceneDescription scene;
  scene.name = name;
  TomlTable top(*root, has_bodies ? "the scene" : "the water", context);
  if (const toml::table* world = top.table("world")) read_world({*world, "[world]", context}, scene.water);
  if (const toml::table* water = top.table("water")) read_water(*water, scene, directory, context);
  if (has_bodies) {
    if (const toml::table* limits = top.table("limits"))
      read_limits({*limits, "[limits]", context}, scene.limits);
    read_bodies(top, scene, directory, context);
  }
  top.finish();
  if (has_bodies && scene.bodies.empty()) top.fail("no body", "at least one section [[body]]");
  if (context.error) return make_error(*std::move(context.error));
  scene.text_fingerprint = fingerprint_of(*root);
  return scene;
}

}  // namespace

Expected<SceneDescription> parse_scene(std::string_view text, const std::string& name,
                                       const std::filesystem::path& directory) {
  return parse(text, name, directory, true);
}

Expected<SceneDescription> parse_water(std::string_view text, const std::string& name,
                                       const std::filesystem::path& directory) {
  return parse(text, name, directory, false);
}

Expected<SceneDescription> read_scene_file(const std::filesystem::path& path) {
  const Expected<std::string> text = read_text_file(path, "a scene file (TOML)", kMaxSceneFileBytes);
  if (!text) return make_error(text.error());
  return parse_scene(*text, path.string(), path.parent_path());
}

SceneDescription single_mesh_scene(const std::filesystem::path& mesh, Method method, double tolerance,
                                   OpenPolicy open, const MeshPlacement& placement) {
  BodyDescription body;
  body.id = 1;
  body.name = mesh.filename().string();
  body.mesh = {MeshFile{mesh}, placement, {}};
  body.method = method;
  body.tolerance = tolerance;
  body.open = open;

  SceneDescription scene;
  scene.name = mesh.string();
  scene.bodies.push_back(std::move(body));
  return scene;
}

}  // namespace buoyancy
