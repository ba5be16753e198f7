// The sea and the bodies of a scene, ready for evaluation: meshes are validated, prepared once and shared.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "flotation/ship_axes.h"
#include "hydrodynamics/hydrodynamic_load.h"
#include "hydrostatics/solver.h"
#include "scene/id_index.h"
#include "scene/prepared_mesh.h"
#include "scene/scene_file.h"
#include "scene/subdivision.h"
#include "wave_loads/prepared_sea.h"
#include "waves/sea_report.h"

namespace buoyancy {

// A mesh that cannot be used.
struct RefusedMesh {
  Error error;
  MeshReport report;  // without a name if the file could not be read
};

struct PrepareOptions {
  bool count_intersecting_pairs =
      false;  // for the report; takes several times as long as the rest of the validation
  // Unless nullptr: preparation goes on after a mesh that cannot be used, and puts all of them here.
  std::vector<RefusedMesh>* refused = nullptr;
};

struct Body {
  std::int32_t id = 0;
  std::string name;
  const PreparedMesh* prepared_mesh = nullptr;  // owned by the scene
  Solver solver;
  Vec3 reference_B = Vec3::Zero();  // torque reference point [m]
  ShipAxes axes;                    // where its heel and trim are 0
  bool hydrostatics = false;        // requested; the mesh then has a moment tree
  bool loads = false;               // requested
  // nullptr without drag and added mass; owned by the scene, and shared by equal bodies. A body whose
  // coefficients scale with the wetted area has a mesh with a moment tree.
  const HydrodynamicModel* hydrodynamics = nullptr;
  // [m]; see given_center_of_mass() (body_mass.h).
  std::optional<Vec3> center_of_mass_B;
  DynamicsSpec dynamics;  // section [body.client]
  // nullptr without parts, or without compartments and tanks; owned by the scene. The parts of a body begin
  // with the body's own mesh, if it has one.
  const std::vector<BodyPart>* parts = nullptr;
  const Subdivision* subdivision = nullptr;
};

class Scene {
 public:
  // Imports or generates each mesh once, scales it in double, validates and prepares it. Errors name the
  // scene file, the line, the body and the mesh. A body with drag or added mass has a closed mesh where its
  // volume scales them, and a centre, given or derived, for each. In waves, also where they are received,
  // these are errors: the methods fast, improved and exact; hydrostatics; a tolerance of 0 for hierarchical;
  // coefficients that scale with the wetted area. Parts, compartments and tanks are closed, and so is the
  // mesh of a body that has them; a tank holds the liquid that is in it.
  static Expected<Scene> prepare(const SceneDescription& description, const PrepareOptions& options = {});

  // Reads a scene file and prepares the scene.
  static Expected<Scene> load(const std::filesystem::path& path, const PrepareOptions& options = {});

  const std::string& name() const { return name_; }  // the scene file's name as given
  const Water& water() const { return water_; }
  // The sea that the file describes; nullptr if the water is at rest (no amplitude is above 0), and if waves
  // are received.
  const Sea* sea() const { return sea_ == nullptr ? nullptr : sea_.get(); }
  const std::shared_ptr<const PreparedSea>& prepared_sea() const { return sea_; }  // of sea()
  // Does the sea come in messages, and are they grids?
  bool receives_sea() const { return sea_messages_ != SeaMessages::kNone; }
  bool receives_grids() const { return sea_messages_ == SeaMessages::kGrids; }
  SeaMessages sea_messages() const { return sea_messages_; }
  // One per wave system; none if the water is at rest.
  const std::vector<WaveSystemReport>& wave_systems() const { return wave_systems_; }
  const Vec3& current_W() const { return current_.velocity_W; }  // [m/s], at the level: it carries the waves
  const Current& current() const { return current_; }            // of the water beside the waves
  const std::vector<Body>& bodies() const { return bodies_; }    // in the order of the file
  const std::vector<std::unique_ptr<PreparedMesh>>& meshes() const { return meshes_; }
  const Body* find(std::int32_t id) const;  // nullptr if unknown; O(1)
  // Index into bodies(), or nullopt if unknown. likely: an index that is tried first, see IdIndex. O(1).
  std::optional<std::size_t> index_of(std::int32_t id, std::size_t likely = 0) const {
    return index_.find(id, likely);
  }
  std::uint64_t text_fingerprint() const { return text_fingerprint_; }  // of its SceneDescription
  std::size_t bodies_with_hydrostatics() const { return bodies_with_hydrostatics_; }
  std::size_t bodies_with_loads() const { return bodies_with_loads_; }  // that request this output
  // The bodies with drag or added mass, whose wrenches depend on their velocities.
  std::size_t bodies_with_hydrodynamics() const { return bodies_with_hydrodynamics_; }
  std::size_t bodies_with_subdivision() const { return subdivisions_.size(); }  // with compartments or tanks

 private:
  std::string name_;
  Water water_;
  std::shared_ptr<const PreparedSea> sea_;
  SeaMessages sea_messages_ = SeaMessages::kNone;
  std::vector<WaveSystemReport> wave_systems_;
  Current current_;
  std::uint64_t text_fingerprint_ = 0;
  std::vector<std::unique_ptr<PreparedMesh>> meshes_;
  std::vector<std::unique_ptr<HydrodynamicModel>> hydrodynamic_models_;
  std::vector<std::unique_ptr<std::vector<BodyPart>>> parts_;
  std::vector<std::unique_ptr<Subdivision>> subdivisions_;
  std::vector<Body> bodies_;
  IdIndex index_;  // into bodies_
  std::size_t bodies_with_hydrostatics_ = 0;
  std::size_t bodies_with_loads_ = 0;
  std::size_t bodies_with_hydrodynamics_ = 0;
};

}  // namespace buoyancy
