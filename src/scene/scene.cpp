#include "scene/scene.h"

#include <algorithm>
#include <utility>

#include "base/format.h"
#include "scene/body_mass.h"
#include "scene/scene_meshes.h"

namespace buoyancy {
namespace {

Error with_body(const BodyDescription& body, Error error) {
  if (!body.source_location.empty()) {
    error.subject = body.source_location + ": body " + std::to_string(body.id) + ", " + error.subject;
  }
  return error;
}

MeshUser user_of(const BodyDescription& body) {
  return {body.source_location, "body " + std::to_string(body.id)};
}

MeshUser user_of(const BodyDescription& body, std::string_view section, const std::string& name,
                 const std::string& source_location) {
  if (section.empty()) return user_of(body);
  std::string user = "body " + std::to_string(body.id);
  user += ", ";
  user += section;
  user += " '" + name + "'";
  return {source_location, std::move(user), false};
}

// Returns nullptr for water at rest.
Expected<std::shared_ptr<const PreparedSea>> make_sea(const SceneDescription& scene) {
  if (scene.sea.systems.empty()) return nullptr;
  Expected<Sea> sea = Sea::make(scene.sea, scene.water);
  if (!sea) {
    Error error = std::move(sea.error());
    if (!scene.water_location.empty()) {
      error.subject = scene.water_location + ": [water], " + error.subject;
    }
    return make_error(std::move(error));
  }
  if (sea->is_still()) return nullptr;
  return std::make_shared<const PreparedSea>(*std::move(sea));
}

// given: the description of a body, or the coefficients made from it.
template <typename DragAndAddedMass>
bool scales_with_wetted_area(const DragAndAddedMass& given) {
  const auto by_area = [](const auto& table) {
    return table && table->immersion == ImmersionScaling::kWettedArea;
  };
  return by_area(given.drag) || by_area(given.added_mass);
}

// Returns an error if the description of a body needs water at rest.
std::optional<Error> error_in_waves(const BodyDescription& body) {
  const std::string subject =
      (body.source_location.empty() ? "" : body.source_location + ": ") + "body " + std::to_string(body.id);
  // A tolerance that is left out becomes kDefaultWaveTolerance.
  if (std::optional<Error> error =
          method_error_in_waves(subject, body.method, body.tolerance.value_or(kDefaultWaveTolerance))) {
    return error;
  }
  if (body.hydrostatics) {
    return Error{subject, "outputs = [\"wrench\", \"hydrostatics\"]", "[\"wrench\"] in waves",
                 "waterplane, metacentres and stiffness belong to a plane water surface",
                 "Remove \"hydrostatics\", or compute it in a scene without waves"};
  }
  if (scales_with_wetted_area(body)) {
    return Error{subject, "immersion = \"wetted_area\"", "\"volume\" or \"none\" in waves",
                 "the wetted area is computed under a plane water surface, which waves are not",
                 "Use immersion = \"volume\""};
  }
  return std::nullopt;
}

// The centre of drag or of added mass.
Expected<Vec3> coefficient_center(const BodyDescription& body, const PreparedMesh& prepared,
                                  const char* table, const std::optional<Vec3>& given,
                                  ImmersionScaling immersion) {
  const bool open = prepared.mesh.is_open();
  if (open && immersion == ImmersionScaling::kVolume) {
    return make_error(
        with_body(body, {table, "immersion = \"volume\" with an open mesh", "\"wetted_area\" or \"none\"",
                         "an open mesh encloses no volume that the submerged one could be compared with",
                         "Set immersion, or close the mesh"}));
  }
  if (given) return *given;
  if (const std::optional<Vec3> known = given_center_of_mass(body.dynamics, prepared)) return *known;
  if (!open) return prepared.mass_properties.centroid_B;
  return make_error(with_body(body, {table, "no center", "center = [x, y, z] (m, body frame)",
                                     "an open mesh encloses no volume whose centroid could be taken", ""}));
}

Expected<HydrodynamicCoefficients> make_coefficients(const BodyDescription& body,
                                                     const PreparedMesh& prepared) {
  HydrodynamicCoefficients coefficients;
  if (body.drag) {
    const Expected<Vec3> center =
        coefficient_center(body, prepared, "[body.drag]", body.drag->center_B, body.drag->immersion);
    if (!center) return make_error(center.error());
    coefficients.drag = {body.drag->linear, body.drag->quadratic, *center, body.drag->immersion};
  }
  if (body.added_mass) {
    const Expected<Vec3> center = coefficient_center(body, prepared, "[body.added_mass]",
                                                     body.added_mass->center_B, body.added_mass->immersion);
    if (!center) return make_error(center.error());
    coefficients.added_mass = {body.added_mass->matrix, *center, body.added_mass->immersion};
  }
  return coefficients;
}

// Returns the model of an equal body among the last few, or adds one: equal bodies then read the same memory,
// and usually follow one another.
const HydrodynamicModel* find_or_add_model(const HydrodynamicCoefficients& coefficients,
                                           const Vec3& reference_B,
                                           std::vector<std::unique_ptr<HydrodynamicModel>>& models) {
  constexpr std::size_t kCompared = 8;
  const std::size_t first = models.size() - std::min(models.size(), kCompared);
  for (std::size_t i = models.size(); i-- > first;) {
    const HydrodynamicModel& model = *models[i];
    if (model.reference_B() == reference_B && model.coefficients() == coefficients) return &model;
  }
  return models.emplace_back(std::make_unique<HydrodynamicModel>(coefficients, reference_B)).get();
}

// The mesh of a body, and the parts that it was made of.
struct BodyMesh {
  PreparedMesh* prepared = nullptr;
  std::vector<BodyPart> parts;
};

Expected<BodyMesh> prepare_body_mesh(const BodyDescription& body, SceneMeshes& meshes) {
  BodyMesh result;
  if (!body.is_parts_only) {
    const Expected<PreparedMesh*> prepared = meshes.find_or_prepare(body.mesh, body.open, user_of(body));
    if (!prepared) return make_error(prepared.error());
    result.prepared = *prepared;
    const bool is_alone = body.parts.empty() && body.compartments.empty() && body.tanks.empty();
    if ((*prepared)->mesh.is_open() && !is_alone) {
      return make_error(with_body(body, {(*prepared)->report.name, "an open mesh", "a closed mesh",
                                         "a body with parts, compartments or tanks has an inside",
                                         "Close the mesh, for example a hull with its deck"}));
    }
    if (body.parts.empty()) return result;
    result.parts.push_back({"hull", *prepared});
  }
  for (const PartDescription& part : body.parts) {
    const Expected<PreparedMesh*> prepared = meshes.find_or_prepare(
        part.mesh, OpenPolicy::kRefuse, user_of(body, "part", part.name, part.source_location));
    if (!prepared) return make_error(prepared.error());
    result.parts.push_back({part.name, *prepared});
  }
  std::vector<const PreparedMesh*> merged;
  for (const BodyPart& part : result.parts) merged.push_back(part.prepared_mesh);
  result.prepared = meshes.find_or_merge(merged);
  return result;
}

// What the queries of a mesh need besides its surface.
struct QueryNeeds {
  bool tree = false;
  bool meshlets = false;
  bool waves = false;
};

std::optional<Error> prepare_queries(PreparedMesh& prepared, const QueryNeeds& needs, const MeshUser& user) {
  if (needs.tree && !prepared.mesh.tree) prepared.mesh.tree = build_moment_tree(prepared.mesh);
  if (needs.meshlets && !prepared.mesh.meshlets) {
    prepared.mesh.meshlets = std::make_shared<const Meshlets>(build_meshlets(prepared.mesh.surface));
  }
  if (needs.waves && !prepared.wave_mesh) {
    if (std::optional<Error> error = size_error_in_waves(prepared.report.name, prepared.mesh)) {
      return user.error(*std::move(error));
    }
    prepared.wave_mesh = make_wave_mesh(prepared.mesh);
  }
  return std::nullopt;
}

// volume: [m^3], as a user wrote it down.
Expected<double> check_liquid_volume(double volume, double capacity, const MeshUser& user) {
  constexpr double kRounding = 1e-9;  // relative
  if (volume <= capacity * (1.0 + kRounding)) return std::min(volume, capacity);
  return make_error(user.error({"liquid_volume", format_shortest(volume) + " m^3",
                                "at most the tank's volume, " + format_number(capacity) + " m^3",
                                "a tank in another unit, or litres", "Set scale, or give fill (0 to 1)"}));
}

Expected<double> liquid_volume_of(const TankDescription& tank, const PreparedMesh& prepared,
                                  const MeshUser& user) {
  const double capacity = prepared.mesh.volume;
  if (tank.fill) return *tank.fill * capacity;
  return check_liquid_volume(tank.liquid_volume.value_or(0.0), capacity, user);
}

// Events in which a tank gets more than it can hold are errors.
Expected<void> check_events(const BodyDescription& body, const Subdivision& subdivision,
                            std::vector<ConditionEvent>& events) {
  for (ConditionEvent& event : events) {
    if (!event.is_tank) continue;
    const auto index = static_cast<std::size_t>(event.index);
    const TankDescription& described = body.tanks[index];
    const Expected<double> volume =
        check_liquid_volume(event.value, subdivision.tanks[index].capacity(),
                            user_of(body, "event of tank", described.name, described.source_location));
    if (!volume) return make_error(volume.error());
    event.value = *volume;
  }
  return {};
}

Expected<Subdivision> prepare_subdivision(const BodyDescription& body, double tolerance,
                                          const QueryNeeds& needs, SceneMeshes& meshes) {
  Subdivision subdivision;
  for (const CompartmentDescription& described : body.compartments) {
    const MeshUser user = user_of(body, "compartment", described.name, described.source_location);
    const Expected<PreparedMesh*> prepared =
        meshes.find_or_prepare(described.mesh, OpenPolicy::kRefuse, user);
    if (!prepared) return make_error(prepared.error());
    QueryNeeds with_tree = needs;
    with_tree.tree = true;
    if (std::optional<Error> error = prepare_queries(**prepared, with_tree, user)) return make_error(*error);
    subdivision.compartments.push_back({described.name, *prepared,
                                        Solver((*prepared)->mesh, body.method, tolerance),
                                        described.permeability, described.flooded});
  }
  for (const TankDescription& described : body.tanks) {
    const MeshUser user = user_of(body, "tank", described.name, described.source_location);
    const Expected<PreparedMesh*> prepared =
        meshes.find_or_prepare(described.mesh, OpenPolicy::kRefuse, user);
    if (!prepared) return make_error(prepared.error());
    if (std::optional<Error> error = prepare_queries(**prepared, {.tree = true}, user)) {
      return make_error(*error);
    }
    const Expected<double> volume = liquid_volume_of(described, **prepared, user);
    if (!volume) return make_error(volume.error());
    subdivision.tanks.push_back(
        {described.name, *prepared, described.density, *volume, described.piston_axis_B});
  }
  return subdivision;
}

// Prepares every mesh, and collects the reports of those that cannot be used.
std::vector<RefusedMesh> find_refused_meshes(const std::vector<BodyDescription>& bodies,
                                             SceneMeshes& meshes) {
  std::vector<RefusedMesh> refused;
  for (const BodyDescription& body : bodies) {
    for_each_mesh(body, [&](const MeshDescription& mesh, std::string_view section, const std::string& name,
                            const std::string& source_location) {
      const OpenPolicy open = section.empty() ? body.open : OpenPolicy::kRefuse;
      MeshReport report;
      const Expected<PreparedMesh*> prepared =
          meshes.find_or_prepare(mesh, open, user_of(body, section, name, source_location), &report);
      if (!prepared) refused.push_back({prepared.error(), std::move(report)});
    });
  }
  return refused;
}

}  // namespace

Expected<Scene> Scene::prepare(const SceneDescription& description, const PrepareOptions& options) {
  Scene scene;
  scene.name_ = description.name;
  scene.water_ = description.water;
  scene.sea_messages_ = description.sea_messages;
  scene.text_fingerprint_ = description.text_fingerprint;
  scene.current_ = {description.sea.current_W, description.current_profile};
  Expected<std::shared_ptr<const PreparedSea>> sea = make_sea(description);
  if (!sea) return make_error(std::move(sea.error()));
  scene.sea_ = *std::move(sea);
  if (scene.sea_ != nullptr) scene.wave_systems_ = report_wave_systems(description.sea, *scene.sea_);
  const bool has_waves = scene.sea_ != nullptr || scene.receives_sea();
  if (has_waves) {
    for (const BodyDescription& body : description.bodies) {
      if (std::optional<Error> error = error_in_waves(body)) return make_error(*std::move(error));
    }
  }
  const double default_tolerance = has_waves ? kDefaultWaveTolerance : 0.0;
  SceneMeshes meshes(description.limits, {OpenPolicy::kRefuse, options.count_intersecting_pairs});
  if (options.refused != nullptr) {
    *options.refused = find_refused_meshes(description.bodies, meshes);
    if (!options.refused->empty()) return make_error(options.refused->front().error);
  }
  for (const BodyDescription& body : description.bodies) {
    Expected<BodyMesh> mesh = prepare_body_mesh(body, meshes);
    if (!mesh) return make_error(std::move(mesh.error()));
    PreparedMesh& prepared = *mesh->prepared;
    const Expected<HydrodynamicCoefficients> coefficients = make_coefficients(body, prepared);
    if (!coefficients) return make_error(coefficients.error());
    const QueryNeeds needs{.tree = body.method == Method::kHierarchical || body.hydrostatics ||
                                   scales_with_wetted_area(*coefficients),
                           .meshlets = is_of_paper(body.method),
                           .waves = has_waves};
    if (std::optional<Error> error = prepare_queries(prepared, needs, user_of(body))) {
      return make_error(*std::move(error));
    }
    const double tolerance = body.tolerance.value_or(default_tolerance);
    Expected<Subdivision> subdivision = prepare_subdivision(body, tolerance, needs, meshes);
    if (!subdivision) return make_error(std::move(subdivision.error()));
    DynamicsSpec dynamics = body.dynamics;
    if (const Expected<void> checked = check_events(body, *subdivision, dynamics.events); !checked) {
      return make_error(checked.error());
    }
    if (body.hydrostatics) ++scene.bodies_with_hydrostatics_;
    if (body.loads) ++scene.bodies_with_loads_;
    const HydrodynamicModel* hydrodynamics = nullptr;
    if (coefficients->any()) {
      ++scene.bodies_with_hydrodynamics_;
      hydrodynamics = find_or_add_model(*coefficients, body.reference_B, scene.hydrodynamic_models_);
    }
    Body& added = scene.bodies_.emplace_back(Body{
        body.id, body.name, &prepared, Solver(prepared.mesh, body.method, tolerance), body.reference_B,
        axes_with_up(body.up_B.value_or(nearest_axis(scene.water_.up_W))), body.hydrostatics, body.loads,
        hydrodynamics, given_center_of_mass(body.dynamics, prepared), std::move(dynamics), nullptr, nullptr});
    if (!mesh->parts.empty()) {
      scene.parts_.push_back(std::make_unique<std::vector<BodyPart>>(std::move(mesh->parts)));
      added.parts = scene.parts_.back().get();
    }
    if (!body.compartments.empty() || !body.tanks.empty()) {
      scene.subdivisions_.push_back(std::make_unique<Subdivision>(*std::move(subdivision)));
      added.subdivision = scene.subdivisions_.back().get();
    }
  }
  scene.meshes_ = meshes.release();
  std::vector<std::int32_t> ids;
  for (const Body& body : scene.bodies_) ids.push_back(body.id);
  scene.index_ = IdIndex(std::move(ids));
  return scene;
}

Expected<Scene> Scene::load(const std::filesystem::path& path, const PrepareOptions& options) {
  Expected<SceneDescription> description = read_scene_file(path);
  if (!description) return make_error(std::move(description.error()));
  return prepare(*description, options);
}

const Body* Scene::find(std::int32_t id) const {
  const std::optional<std::size_t> index = index_of(id);
  return index ? &bodies_[*index] : nullptr;
}

}  // namespace buoyancy
