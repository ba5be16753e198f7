// Internal to scene.cpp: the meshes of a scene, each imported or generated, placed, validated and prepared
// once.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/prepared_mesh.h"
#include "scene/scene_file.h"

namespace buoyancy {

// Identifies in errors what needs a mesh.
struct MeshUser {
  std::string source_location;  // "scene.toml:12"; empty without a scene file
  std::string name;             // "body 3", "body 3, tank 'ballast 1'"
  bool may_be_open = true;      // the user may accept an open mesh

  // Returns the error with the user before its subject.
  Error error(Error error) const;
};

class SceneMeshes {
 public:
  SceneMeshes(const ImportLimits& limits, const ValidationOptions& options)
      : limits_(limits), options_(options) {}

  // Errors: those of import_mesh() and prepare_mesh(). refused: see prepare_mesh(); a mesh that has been
  // refused before is not read again, has no report, and an error that names its first user.
  Expected<PreparedMesh*> find_or_prepare(const MeshDescription& mesh, OpenPolicy open, const MeshUser& user,
                                          MeshReport* refused = nullptr);

  // Returns all of these meshes as one, see merge_meshes(). Precondition: they are from this object and
  // closed.
  PreparedMesh* find_or_merge(const std::vector<const PreparedMesh*>& meshes);

  std::vector<std::unique_ptr<PreparedMesh>> release() { return std::move(meshes_); }

 private:
  // Identifies a prepared mesh: two bodies with equal keys share it.
  struct Key {
    std::variant<std::filesystem::path, Shape> source;  // canonical path
    Vec3 scale = Vec3::Ones();
    Vec3 position_B = Vec3::Zero();
    Eigen::Vector4d orientation_B = Eigen::Vector4d::Zero();
    MeshRepair repair;
    OpenPolicy open = OpenPolicy::kRefuse;
    std::vector<const PreparedMesh*> merged;  // then nothing else is set

    bool operator==(const Key&) const = default;
  };

  static Key key_of(const MeshDescription& mesh, OpenPolicy open);
  PreparedMesh* find(const Key& key) const;  // nullptr if there is none
  PreparedMesh* add(Key key, PreparedMesh mesh);

  ImportLimits limits_;
  ValidationOptions options_;
  std::vector<std::unique_ptr<PreparedMesh>> meshes_;
  std::vector<Key> keys_;  // in the order of meshes_
  struct RefusedKey {
    Key key;
    std::string first_user;
  };
  std::vector<RefusedKey> refused_;
};

}  // namespace buoyancy
