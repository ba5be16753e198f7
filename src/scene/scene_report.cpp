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

#include "base/facts.h"
#include "geometry/mesh_report_facts.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "scene/body_motions.h"
#include "scene/coefficient_warnings.h"
#include "scene/flotation_report.h"
#include "scene/mesh_warnings.h"
#include "scene/motion_report.h"
#include "scene/subdivision_report.h"
#include "scene/subdivision_warnings.h"

namespace buoyancy {
namespace {

std::vector<const Body*> users_of(const PreparedMesh& mesh, const Scene& scene) {
  std::vector<const Body*> users;
  for (const Body& body : scene.bodies()) {
    if (body.prepared_mesh == &mesh) users.push_back(&body);
  }
  return users;
}

std::vector<std::string> outputs_of(const Body& body) {
  std::vector<std::string> outputs{"wrench"};
  if (body.hydrostatics) outputs.emplace_back("hydrostatics");
  if (body.loads) outputs.emplace_back("loads");
  return outputs;
}

Facts body_facts(const Body& body, const Scene& scene) {
  const std::optional<double> mass = known_mass(body, scene.water());
  const bool is_default = !body.dynamics.mass && !body.dynamics.density;
  const std::vector<std::string> outputs = outputs_of(body);
  Facts facts;
  facts.heading("body {}  {}", body.id, body.name).add("id", body.id).add("name", body.name);
  facts.line("mesh").say("{}", body.prepared_mesh->report.name);
  facts.add("mesh", mesh_index(*body.prepared_mesh, scene));
  facts.line("method").add("method", to_string(body.solver.method()), "{}");
  facts.add("tolerance", body.solver.tolerance(), "tolerance {}");
  facts.line("torque about").add("reference_point", body.reference_B, "[{}] m");
  facts.line("outputs").add("outputs", outputs);
  for (const std::string& output : outputs) facts.say("{}", output);
  facts.line("mass").add("mass", mass, "{} kg");
  facts.add("density", known_density(body, scene.water()), mass ? "{} kg/m^3" : "");
  facts.say_if(!mass, "unknown: the mesh is open");
  facts.say_if(mass && is_default, " (default: half the water's density)");
  add_subdivision(body, scene, facts);
  add_coefficients(body, facts);
  return facts;
}

// The report of a mesh, and which bodies and sections of bodies use it.
Facts mesh_facts(const PreparedMesh& mesh, const Scene& scene) {
  Facts report = mesh_report_facts(mesh.report);
  Facts facts;
  facts.heading("mesh {}", report.text()).line("used by");
  facts.json() = std::move(report.json());
  Json& bodies = facts.list("bodies");
  for (const Body* body : users_of(mesh, scene)) {
    facts.say(bodies.empty() ? "body {}" : "{}", body->id);
    bodies.push_back(body->id);
  }
  bool is_first = bodies.empty();
  for (const SectionUser& user : section_users_of(mesh, scene)) {
    facts.say(std::exchange(is_first, false) ? "{} '{}' of body {}" : "; {} '{}' of body {}", user.section,
              user.name, user.body_id);
    facts.json()["sections"].push_back(to_json(user));
  }
  return facts;
}

double shortest_wavelength(const Sea& sea) {
  return 2.0 * std::numbers::pi / sea.max_wave_number();
}

// The caller adds the text about when the waves repeat.
Facts system_facts(const WaveSystemReport& system, double repeat_time) {
  const bool is_regular = system.type == "regular";
  const bool is_components = system.type == "components";
  const std::optional<PeakWave>& peak = system.peak;
  const auto of_peak = [&peak](double PeakWave::*field) {
    return peak ? std::optional((*peak).*field) : std::nullopt;
  };
  std::optional<double> share;
  if (system.breaking) share = system.breaking->height / system.breaking->limit;
  Facts facts;
  facts.add("type", system.type, is_components ? "" : "{}");
  facts.add("components", system.components);
  facts.say(pluralize(static_cast<std::int64_t>(system.components), "component", "components"));
  facts.add("height", system.height, is_regular ? "height {:4} m" : "Hs {:4} m");
  facts.add("significant_wave_height", system.significant_wave_height);
  facts.add("peak_period", of_peak(&PeakWave::period), is_regular ? "period {:4} s" : "peak period {:4} s");
  facts.say_if(peak && is_components, " (calculated)");
  if (system.zero_crossing_period) facts.say("Tz {:4} s", *system.zero_crossing_period);
  facts.add("peak_wavelength", of_peak(&PeakWave::wavelength));
  facts.add("steepness", of_peak(&PeakWave::steepness), "steepness {:4}");
  facts.add("breaking_ratio", share);
  if (share) facts.say(" ({} % of breaking)", std::int64_t{std::lround(100.0 * *share)});
  facts.add("zero_crossing_period", system.zero_crossing_period);
  facts.add("m0", system.m0).add("m1", system.m1).add("m2", system.m2).add("repeat_time", repeat_time);
  facts.add("gamma", system.gamma, "gamma {:4}");
  facts.add_flag("gamma_is_default", system.gamma_is_default, " (from Hs and peak period)");
  return facts;
}

// Returns the repeat time [s] of each system.
std::vector<double> repeat_times(const Sea& sea, const std::vector<WaveSystemReport>& systems) {
  std::vector<double> times;
  std::span<const WaveComponent> rest = sea.components();
  for (const WaveSystemReport& system : systems) {
    times.push_back(repeat_time(rest.first(system.components)));
    rest = rest.subspan(system.components);
  }
  return times;
}

void say_repeats(double time, Facts& facts) {
  if (std::isinf(time)) {
    facts.say("does not repeat within {:4} mean periods", kRepeatSearch);
  } else {
    facts.say("repeats after {:4} s", time);
  }
}

Facts sea_facts(const Sea& sea, const std::vector<WaveSystemReport>& systems) {
  Facts facts;
  facts.heading("sea  ").say(
      pluralize(static_cast<std::int64_t>(systems.size()), "wave system", "wave systems"));
  const std::vector<double> repeats = repeat_times(sea, systems);
  Json of_systems = Json::array();
  for (std::size_t i = 0; i < systems.size(); ++i) {
    Facts system = system_facts(systems[i], repeats[i]);
    facts.line("system " + std::to_string(i + 1)).say("{}", system.text());
    say_repeats(repeats[i], facts);
    of_systems.push_back(std::move(system.json()));
  }
  const double all_repeat = std::ranges::max(repeats);
  Facts together = system_facts(report_components(sea), all_repeat);
  const double shortest = shortest_wavelength(sea);
  facts.line("together").say("{}", together.text()).say("shortest wave {:4} m", shortest);
  say_repeats(all_repeat, facts);
  facts.line("depth").add("depth", sea.depth(), std::isinf(sea.depth()) ? "{}: deep water" : "{} m");
  facts.line("pressure").add("wave_pressure", to_string(sea.pressure()), "{}");
  facts.line("time").add("time_origin", sea.time_origin(), "t = 0 at utime {} us");
  facts.add("ramp", sea.ramp(), sea.ramp() > 0.0 ? "ramp of {} s" : "");
  facts.say_if(!(sea.ramp() > 0.0), "no ramp");
  facts.line("components").say("listed by --check --json");
  facts.add("significant_wave_height", sea.significant_wave_height());
  facts.add("shortest_wavelength", shortest).add("extreme_steepness", sea.extreme_steepness());
  facts.add("systems", std::move(of_systems)).add("together", std::move(together.json()));
  Json& components = facts.list("components");
  for (const WaveComponent& component : sea.components()) {
    components.push_back({{"amplitude", component.amplitude},
                          {"angular_frequency", component.angular_frequency},
                          {"direction", component.direction},
                          {"phase", component.phase}});
  }
  return facts;
}

Facts water_facts(const Scene& scene) {
  const Water& water = scene.water();
  Facts facts;
  facts.line("water").say("up . x < {} m", water.level).add("up", water.up_W, "up [{}]");
  facts.add("level", water.level).add("density", water.density, "{} kg/m^3");
  facts.add("gravity", water.gravity, "gravity {} m/s^2");
  if (!water.layers.empty()) {
    Json& layers = facts.list("layers");
    for (const WaterLayer& layer : water.layers) {
      facts.line("layer").say("up . x < {} m, {} kg/m^3", layer.below, layer.density);
      layers.push_back({{"below", layer.below}, {"density", layer.density}});
    }
  }
  const CurrentProfile& profile = scene.current().profile;
  if (profile.empty() && scene.current_W() != Vec3::Zero()) {
    facts.line("current").add("current", scene.current_W(), "[{}] m/s");
  }
  if (!profile.empty()) {
    Json& points = facts.list("current_profile");
    for (const CurrentPoint& point : profile) {
      facts.line("current").say("[{}] m/s at a height of {} m", point.velocity_W, point.height);
      points.push_back({{"height", point.height}, {"velocity", point.velocity_W}});
    }
  }
  return facts;
}

void add_sea(const Scene& scene, Facts& facts) {
  if (scene.receives_sea()) {
    const bool grids = scene.receives_grids();
    facts.heading("").heading(grids ? "sea  received on grids" : "sea  received in messages");
    facts.add("sea", grids ? Json{{"received", true}, {"grid", true}} : Json{{"received", true}});
  } else if (scene.sea() != nullptr) {
    facts.heading("").include("sea", sea_facts(*scene.sea(), scene.wave_systems()));
  } else {
    facts.add("sea", nullptr);
  }
}

Facts scene_facts(const Scene& scene, const SceneReportOptions& options) {
  Facts facts;
  facts.heading("{}", scene.name()).add("scene", scene.name()).include("water", water_facts(scene));
  // In the text, the instructions come before the sea.
  facts.line("instructions").say("{}", simd_target());
  add_sea(scene, facts);
  facts.add("simd_target", simd_target());
  const std::vector<MotionsOfBody> motions =
      options.motions ? scene_motions(scene) : std::vector<MotionsOfBody>{};
  MeshesWithTrees meshes;
  facts.list("bodies");
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Body& body = scene.bodies()[i];
    Facts one = body_facts(body, scene);
    if (options.motions) add_motions(motions[i], body, scene.water(), one);
    if (options.flotation != nullptr) add_flotation((*options.flotation)[i], body, scene.water(), one);
    if (!options.drafts.empty()) add_upright(body, scene.water(), options.drafts, meshes, one);
    facts.heading("").include_in("bodies", std::move(one));
  }
  facts.list("meshes");
  for (const auto& mesh : scene.meshes()) facts.heading("").include_in("meshes", mesh_facts(*mesh, scene));
  return facts;
}

}  // namespace

std::string scene_report_text(const Scene& scene, const SceneReportOptions& options) {
  return scene_facts(scene, options).text() + "\n";
}

std::string scene_report_json(const Scene& scene, const SceneReportOptions& options) {
  return json_lines(scene_facts(scene, options).json());
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
    Json one = mesh.report.name.empty() ? Json::object() : mesh_report_facts(mesh.report).json();
    one["error"] = mesh.error.message();
    refused.push_back(std::move(one));
  }
  return json_lines({{"refused", std::move(refused)}});
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
