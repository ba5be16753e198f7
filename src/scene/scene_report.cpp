#include "scene/scene_report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/format.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "scene/body_motions.h"
#include "scene/coefficient_warnings.h"
#include "scene/flotation_report.h"
#include "scene/mesh_report_json.h"
#include "scene/mesh_warnings.h"
#include "scene/motion_report.h"
#include "scene/subdivision_report.h"
#include "scene/subdivision_warnings.h"

namespace buoyancy {
namespace {

using Json = nlohmann::ordered_json;

std::vector<const Body*> users_of(const PreparedMesh& mesh, const Scene& scene) {
  std::vector<const Body*> users;
  for (const Body& body : scene.bodies()) {
    if (body.prepared_mesh == &mesh) users.push_back(&body);
  }
  return users;
}

std::size_t index_of(const PreparedMesh& mesh, const Scene& scene) {
  std::size_t index = 0;
  while (scene.meshes()[index].get() != &mesh) ++index;
  return index;
}

std::string bracketed(const Vec3& vector) {
  std::string text = "[";
  text += format_vector(vector);
  return text + "]";
}

std::vector<std::string> outputs_of(const Body& body) {
  std::vector<std::string> outputs{"wrench"};
  if (body.hydrostatics) outputs.emplace_back("hydrostatics");
  if (body.loads) outputs.emplace_back("loads");
  return outputs;
}

std::string body_text(const Body& body, const Scene& scene) {
  std::string text = "body " + std::to_string(body.id) + "  " + body.name + "\n";
  text += "  mesh          " + body.prepared_mesh->report.name + "\n";
  text += "  method        " + std::string(to_string(body.solver.method())) + ", tolerance " +
          format_number(body.solver.tolerance()) + "\n";
  text += "  torque about  " + bracketed(body.reference_B) + " m\n";
  text += "  outputs       ";
  for (const std::string& output : outputs_of(body)) text += (text.back() == ' ' ? "" : ", ") + output;
  text += "\n";
  const std::optional<double> mass = known_mass(body, scene.water());
  const std::optional<double> density = known_density(body, scene.water());
  if (mass) {
    const bool is_default = !body.dynamics.mass && !body.dynamics.density;
    text += "  mass          " + format_number(*mass) + " kg" +
            (density ? ", " + format_number(*density) + " kg/m^3" : "") +
            (is_default ? " (default: half the water's density)" : "") + "\n";
  } else {
    text += "  mass          unknown: the mesh is open\n";
  }
  text += subdivision_text(body);
  return text + coefficients_text(body);
}

// "body 4, 6; tank 'ballast 1' of body 2"
std::string users_text(const PreparedMesh& mesh, const Scene& scene) {
  std::string text;
  for (const Body* body : users_of(mesh, scene)) {
    text += (text.empty() ? "body " : ", ") + std::to_string(body->id);
  }
  for (const SectionUser& user : section_users_of(mesh, scene)) {
    if (!text.empty()) text += "; ";
    text += to_text(user);
  }
  return text;
}

double shortest_wavelength(const Sea& sea) {
  return 2.0 * std::numbers::pi / sea.max_wave_number();
}

// Derived numbers are rounded; the JSON report has all digits.
std::string format_rounded(double value) {
  return format_number(value, 4);
}

std::string system_text(const WaveSystemReport& system) {
  std::string text = system.type == "components" ? "" : std::string(system.type) + ", ";
  text += pluralize(static_cast<std::int64_t>(system.components), "component", "components");
  text += system.type == "regular" ? ", height " : ", Hs ";
  text += format_rounded(system.height) + " m";
  if (system.peak) {
    text += system.type == "regular" ? ", period " : ", peak period ";
    text += format_rounded(system.peak->period) + " s";
    if (system.type == "components") text += " (calculated)";
    if (system.zero_crossing_period) text += ", Tz " + format_rounded(*system.zero_crossing_period) + " s";
    text += ", steepness " + format_rounded(system.peak->steepness);
  }
  if (system.breaking) {
    const double share = system.breaking->height / system.breaking->limit;
    text += " (" + std::to_string(std::lround(100.0 * share)) + " % of breaking)";
  }
  if (system.gamma) {
    text += ", gamma " + format_rounded(*system.gamma);
    if (system.gamma_is_default) text += " (from Hs and peak period)";
  }
  return text;
}

// [s], of each system.
std::vector<double> repeat_times(const Sea& sea, const std::vector<WaveSystemReport>& systems) {
  std::vector<double> times;
  std::span<const WaveComponent> rest = sea.components();
  for (const WaveSystemReport& system : systems) {
    times.push_back(repeat_time(rest.first(system.components)));
    rest = rest.subspan(system.components);
  }
  return times;
}

std::string repeats_text(double time) {
  return std::isinf(time) ? "does not repeat within " + format_rounded(kRepeatSearch) + " mean periods"
                          : "repeats after " + format_rounded(time) + " s";
}

std::string sea_text(const Sea& sea, const std::vector<WaveSystemReport>& systems) {
  std::string text =
      "sea  " + pluralize(static_cast<std::int64_t>(systems.size()), "wave system", "wave systems");
  text += "\n";
  const std::vector<double> repeats = repeat_times(sea, systems);
  for (std::size_t i = 0; i < systems.size(); ++i) {
    std::string label = "  system " + std::to_string(i + 1);
    label.resize(std::max<std::size_t>(16, label.size() + 1), ' ');
    text += label + system_text(systems[i]) + ", " + repeats_text(repeats[i]) + "\n";
  }
  text += "  together      " + system_text(report_components(sea)) + ", shortest wave " +
          format_rounded(shortest_wavelength(sea)) + " m, " + repeats_text(std::ranges::max(repeats)) + "\n";
  text += "  depth         " +
          (std::isinf(sea.depth()) ? "inf: deep water" : format_number(sea.depth()) + " m") + "\n";
  text += "  pressure      " + std::string(to_string(sea.pressure())) + "\n";
  text += "  time          t = 0 at utime " + std::to_string(sea.time_origin()) + " us, " +
          (sea.ramp() > 0.0 ? "ramp of " + format_number(sea.ramp()) + " s" : "no ramp") + "\n";
  text += "  components    listed by --check --json\n";
  return text;
}

Json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

template <typename T>
Json to_json(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json to_json(const Water& water) {
  return {{"up", to_json(water.up_W)},
          {"level", water.level},
          {"density", water.density},
          {"gravity", water.gravity}};
}

Json to_json(const WaveSystemReport& system, double repeat_time) {
  const std::optional<PeakWave>& peak = system.peak;
  const std::optional<Breaking>& breaking = system.breaking;
  return {{"type", system.type},
          {"components", system.components},
          {"height", system.height},
          {"significant_wave_height", system.significant_wave_height},
          {"peak_period", peak ? Json(peak->period) : Json(nullptr)},
          {"peak_wavelength", peak ? Json(peak->wavelength) : Json(nullptr)},
          {"steepness", peak ? Json(peak->steepness) : Json(nullptr)},
          {"breaking_ratio", breaking ? Json(breaking->height / breaking->limit) : Json(nullptr)},
          {"zero_crossing_period", to_json(system.zero_crossing_period)},
          {"m0", system.m0},
          {"m1", system.m1},
          {"m2", system.m2},
          {"repeat_time", repeat_time},
          {"gamma", to_json(system.gamma)},
          {"gamma_is_default", system.gamma_is_default}};
}

Json to_json(const Sea& sea, const std::vector<WaveSystemReport>& reports) {
  const std::vector<double> repeats = repeat_times(sea, reports);
  Json systems = Json::array();
  for (std::size_t i = 0; i < reports.size(); ++i) systems.push_back(to_json(reports[i], repeats[i]));
  Json components = Json::array();
  for (const WaveComponent& component : sea.components()) {
    components.push_back({{"amplitude", component.amplitude},
                          {"angular_frequency", component.angular_frequency},
                          {"direction", component.direction},
                          {"phase", component.phase}});
  }
  return {{"depth", sea.depth()},
          {"wave_pressure", to_string(sea.pressure())},
          {"time_origin", sea.time_origin()},
          {"ramp", sea.ramp()},
          {"significant_wave_height", sea.significant_wave_height()},
          {"shortest_wavelength", shortest_wavelength(sea)},
          {"extreme_steepness", sea.extreme_steepness()},
          {"systems", std::move(systems)},
          {"together", to_json(report_components(sea), std::ranges::max(repeats))},
          {"components", std::move(components)}};
}

Json to_json(const Body& body, const Scene& scene) {
  Json json{{"id", body.id},
            {"name", body.name},
            {"mesh", index_of(*body.prepared_mesh, scene)},
            {"method", to_string(body.solver.method())},
            {"tolerance", body.solver.tolerance()},
            {"reference_point", to_json(body.reference_B)},
            {"outputs", outputs_of(body)},
            {"mass", to_json(known_mass(body, scene.water()))},
            {"density", to_json(known_density(body, scene.water()))}};
  add_subdivision(body, scene, json);
  if (body.hydrodynamics == nullptr) return json;
  const HydrodynamicCoefficients& coefficients = body.hydrodynamics->coefficients();
  if (coefficients.drag) json["drag"] = to_json(*coefficients.drag);
  if (coefficients.added_mass) json["added_mass"] = to_json(*coefficients.added_mass);
  return json;
}

Json sea_json(const Scene& scene) {
  if (scene.receives_sea()) return {{"received", true}};
  return scene.sea() == nullptr ? Json(nullptr) : to_json(*scene.sea(), scene.wave_systems());
}

}  // namespace

std::string scene_report_text(const Scene& scene, const SceneReportOptions& options) {
  const Water& water = scene.water();
  std::string text = scene.name() + "\n";
  text += "  water         up . x < " + format_number(water.level) + " m, up " + bracketed(water.up_W) +
          ", " + format_number(water.density) + " kg/m^3, gravity " + format_number(water.gravity) +
          " m/s^2\n";
  if (scene.current_W() != Vec3::Zero()) {
    text += "  current       " + bracketed(scene.current_W()) + " m/s\n";
  }
  text += "  instructions  " + simd_target() + "\n";
  if (scene.receives_sea()) text += "\nsea  received in messages\n";
  if (scene.sea() != nullptr) {
    text += '\n';
    text += sea_text(*scene.sea(), scene.wave_systems());
  }
  const std::vector<MotionsOfBody> motions =
      options.motions ? scene_motions(scene) : std::vector<MotionsOfBody>{};
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Body& body = scene.bodies()[i];
    text += '\n';
    text += body_text(body, scene);
    if (options.motions) text += motions_text(motions[i], body, scene.water());
    if (options.flotation != nullptr) text += flotation_text((*options.flotation)[i], body);
  }
  for (const auto& mesh : scene.meshes()) {
    text += "\nmesh " + to_text(mesh->report) + "\n  used by       " + users_text(*mesh, scene) + "\n";
  }
  return text;
}

std::string scene_report_json(const Scene& scene, const SceneReportOptions& options) {
  Json bodies = Json::array();
  const std::vector<MotionsOfBody> motions =
      options.motions ? scene_motions(scene) : std::vector<MotionsOfBody>{};
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Body& body = scene.bodies()[i];
    bodies.push_back(to_json(body, scene));
    if (!body.dynamics.given) continue;
    if (options.motions) {
      bodies.back()["motions"] = motions[i].motions ? to_json(*motions[i].motions) : Json(nullptr);
    }
    if (options.flotation != nullptr) {
      const FlotationOfBody& entry = (*options.flotation)[i];
      bodies.back()["flotation"] =
          entry.flotation ? to_json(*entry.flotation, body, scene.water()) : Json(nullptr);
    }
  }
  Json meshes = Json::array();
  for (const auto& mesh : scene.meshes()) {
    Json report = mesh_report_json(mesh->report);
    report["bodies"] = Json::array();
    for (const Body* body : users_of(*mesh, scene)) report["bodies"].push_back(body->id);
    for (const SectionUser& user : section_users_of(*mesh, scene))
      report["sections"].push_back(to_json(user));
    meshes.push_back(std::move(report));
  }
  Json water = to_json(scene.water());
  if (scene.current_W() != Vec3::Zero()) water["current"] = to_json(scene.current_W());
  const Json report{{"scene", scene.name()},       {"water", std::move(water)},
                    {"sea", sea_json(scene)},      {"simd_target", simd_target()},
                    {"bodies", std::move(bodies)}, {"meshes", std::move(meshes)}};
  // dump() writes non-finite numbers as null, and file names that are not UTF-8 with replacement characters.
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string refused_meshes_text(const std::vector<RefusedMesh>& meshes) {
  std::string text;
  for (const RefusedMesh& mesh : meshes) {
    if (!mesh.report.name.empty()) text += "mesh " + to_text(mesh.report) + "\n";
  }
  return text;
}

std::string refused_meshes_json(const std::vector<RefusedMesh>& meshes) {
  Json refused = Json::array();
  for (const RefusedMesh& mesh : meshes) {
    Json one = mesh.report.name.empty() ? Json::object() : mesh_report_json(mesh.report);
    one["error"] = mesh.error.message();
    refused.push_back(std::move(one));
  }
  return Json{{"refused", std::move(refused)}}.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<Warning> scene_warnings(const Scene& scene) {
  std::vector<Warning> warnings = coefficient_warnings(scene);
  std::ranges::move(subdivision_warnings(scene), std::back_inserter(warnings));
  std::ranges::move(mesh_warnings(scene), std::back_inserter(warnings));
  if (scene.sea() == nullptr) return warnings;
  std::vector<Warning> of_sea = sea_warnings(scene.name(), *scene.sea(), scene.wave_systems());
  std::ranges::move(warnings, std::back_inserter(of_sea));
  return of_sea;
}

}  // namespace buoyancy
