#include "scene/scene.h"

#include <algorithm>
#include <utility>

#include "base/format.h"

namespace buoyancy {
namespace {

// Identifies a prepared mesh: two bodies with equal keys share it.
struct MeshKey {
  std::variant<std::filesystem::path, Shape> source;  // canonical path
  double scale = 1.0;
  OpenPolicy open = OpenPolicy::kRefuse;

  bool operator==(const MeshKey&) const = default;
};

MeshKey key_of(const BodyDescription& body) {
  MeshKey key{{}, body.scale, body.open};
  if (const auto* file = std::get_if<MeshFile>(&body.source)) {
    std::error_code code;
    std::filesystem::path canonical = std::filesystem::weakly_canonical(file->path, code);
    if (code) canonical = file->path;
    key.source = std::move(canonical);
  } else {
    key.source = std::get<Shape>(body.source);
  }
  return key;
}

Error with_body(const BodyDescription& body, Error error) {
  if (!body.source_location.empty()) {
    error.subject = body.source_location + ": body " + std::to_string(body.id) + ", " + error.subject;
  }
  return error;
}

std::string source_name(const BodyDescription& body) {
  if (const auto* file = std::get_if<MeshFile>(&body.source)) return file->path.string();
  return std::string(type_name(std::get<Shape>(body.source)));
}

Expected<ImportedMesh> read_source(const BodyDescription& body, const ImportLimits& limits) {
  if (const auto* file = std::get_if<MeshFile>(&body.source)) return import_mesh(file->path, limits);
  ImportedMesh generated;
  generated.mesh = make_shape(std::get<Shape>(body.source));
  generated.source.format = "generated";
  return generated;
}

Expected<std::unique_ptr<PreparedMesh>> prepare_body_mesh(const BodyDescription& body,
                                                          const ImportLimits& limits,
                                                          const PrepareOptions& options) {
  Expected<ImportedMesh> imported = read_source(body, limits);
  if (!imported) return make_error(with_body(body, std::move(imported.error())));
  Expected<PreparedMesh> prepared = prepare_mesh(*std::move(imported), source_name(body), body.scale,
                                                 {body.open, options.count_intersecting_pairs});
  if (!prepared) return make_error(with_body(body, std::move(prepared.error())));
  return std::make_unique<PreparedMesh>(*std::move(prepared));
}

std::optional<Vec3> center_of_mass(const DynamicsSpec& dynamics, const PreparedMesh& prepared) {
  if (dynamics.center_of_mass_B) return dynamics.center_of_mass_B;
  if (prepared.mesh.is_open() || !(dynamics.mass || dynamics.density)) return std::nullopt;
  return prepared.mass_properties.centroid_B;
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

// Of a body's description, or of the coefficients made from it.
template <typename DragAndAddedMass>
bool scales_with_wetted_area(const DragAndAddedMass& given) {
  const auto by_area = [](const auto& table) {
    return table && table->immersion == ImmersionScaling::kWettedArea;
  };
  return by_area(given.drag) || by_area(given.added_mass);
}

// What of a body's description needs water at rest.
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
  if (const std::optional<Vec3> known = center_of_mass(body.dynamics, prepared)) return *known;
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

}  // namespace

Expected<Scene> Scene::prepare(const SceneDescription& description, const PrepareOptions& options) {
  Scene scene;
  scene.name_ = description.name;
  scene.water_ = description.water;
  scene.receives_sea_ = description.waves_received;
  scene.current_W_ = description.current_W;
  Expected<std::shared_ptr<const PreparedSea>> sea = make_sea(description);
  if (!sea) return make_error(std::move(sea.error()));
  scene.sea_ = *std::move(sea);
  if (scene.sea_ != nullptr) scene.wave_systems_ = report_wave_systems(description.sea, scene.sea_->sea());
  const bool has_waves = scene.sea_ != nullptr || scene.receives_sea_;
  if (has_waves) {
    for (const BodyDescription& body : description.bodies) {
      if (std::optional<Error> error = error_in_waves(body)) return make_error(*std::move(error));
    }
  }
  const double default_tolerance = has_waves ? kDefaultWaveTolerance : 0.0;
  std::vector<MeshKey> keys;  // in the order of scene.meshes_
  for (const BodyDescription& body : description.bodies) {
    MeshKey key = key_of(body);
    const auto known = std::find(keys.begin(), keys.end(), key);
    const auto index = static_cast<std::size_t>(known - keys.begin());
    if (known == keys.end()) {
      Expected<std::unique_ptr<PreparedMesh>> prepared = prepare_body_mesh(body, description.limits, options);
      if (!prepared) return make_error(std::move(prepared.error()));
      scene.meshes_.push_back(*std::move(prepared));
      keys.push_back(std::move(key));
    }
    PreparedMesh& prepared = *scene.meshes_[index];
    const Expected<HydrodynamicCoefficients> coefficients = make_coefficients(body, prepared);
    if (!coefficients) return make_error(coefficients.error());
    if ((body.method == Method::kHierarchical || body.hydrostatics ||
         scales_with_wetted_area(*coefficients)) &&
        !prepared.mesh.tree) {
      prepared.mesh.tree = build_moment_tree(prepared.mesh);
    }
    if (is_of_paper(body.method) && !prepared.mesh.meshlets) {
      prepared.mesh.meshlets = std::make_shared<const Meshlets>(build_meshlets(prepared.mesh.surface));
    }
    if (has_waves && !prepared.wave_mesh) {
      if (std::optional<Error> error = size_error_in_waves(source_name(body), prepared.mesh)) {
        return make_error(with_body(body, *std::move(error)));
      }
      prepared.wave_mesh = make_wave_mesh(prepared.mesh);
    }
    if (body.hydrostatics) ++scene.bodies_with_hydrostatics_;
    if (body.loads) ++scene.bodies_with_loads_;
    const HydrodynamicModel* hydrodynamics = nullptr;
    if (coefficients->any()) {
      ++scene.bodies_with_hydrodynamics_;
      hydrodynamics = find_or_add_model(*coefficients, body.reference_B, scene.hydrodynamic_models_);
    }
    scene.bodies_.push_back({body.id, body.name, &prepared,
                             Solver(prepared.mesh, body.method, body.tolerance.value_or(default_tolerance)),
                             body.reference_B, body.hydrostatics, body.loads, hydrodynamics,
                             center_of_mass(body.dynamics, prepared), body.dynamics});
  }
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
