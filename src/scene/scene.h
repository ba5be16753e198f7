// The bodies of a scene, ready to be asked: meshes imported or generated, validated, prepared once and
// shared.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/error.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_report.h"
#include "hydrostatics/solver.h"
#include "scene/scene_file.h"

namespace buoyancy {

struct PrepareOptions {
  bool count_intersecting_pairs = false;  // for the report; several times the rest of the validation
};

// A mesh as several bodies may share it: one per source (file or shape), scale and open policy.
struct PreparedMesh {
  MeshReport report;
  HydrostaticMesh mesh;
  MassProperties mass_properties;  // density 1; of an open mesh: of what there is
};

struct Body {
  std::int32_t id = 0;
  std::string name;
  const PreparedMesh* prepared_mesh = nullptr;  // owned by the scene
  Solver solver;
  Vec3 reference_B = Vec3::Zero();  // m
  bool hydrostatics = false;        // asked for; the mesh then has its tree
  // m: where [body.client] says how the mass lies (mass, density or center_of_mass) and the centre is known:
  // an open mesh has none but what it is given.
  std::optional<Vec3> center_of_mass_B;
  DynamicsSpec client;
};

class Scene {
 public:
  // Imports and prepares what the description names; each mesh once. Scales are applied in double, before the
  // mesh is looked at. Errors name the scene file, the line, the body and the mesh.
  static Expected<Scene> prepare(const SceneDescription& description, const PrepareOptions& options = {});

  // Reads the file and prepares it.
  static Expected<Scene> load(const std::filesystem::path& path, const PrepareOptions& options = {});

  const std::string& name() const { return name_; }  // of the scene file, as named
  const Water& water() const { return water_; }
  const std::vector<Body>& bodies() const { return bodies_; }  // in the file's order
  const std::vector<std::unique_ptr<PreparedMesh>>& meshes() const { return meshes_; }
  const Body* find(std::int32_t id) const;                     // nullptr: unknown; O(1)
  std::optional<std::size_t> index_of(std::int32_t id) const;  // into bodies()
  bool any_hydrostatics() const { return any_hydrostatics_; }  // of any body

 private:
  std::string name_;
  Water water_;
  std::vector<std::unique_ptr<PreparedMesh>> meshes_;
  std::vector<Body> bodies_;
  std::unordered_map<std::int32_t, std::size_t> index_;  // position in bodies_ by id
  bool any_hydrostatics_ = false;
};

}  // namespace buoyancy
