#include "scene/scene_meshes.h"

#include <algorithm>
#include <utility>

namespace buoyancy {
namespace {

std::string source_name(const MeshDescription& mesh) {
  if (const auto* file = std::get_if<MeshFile>(&mesh.source)) return file->path.string();
  return std::string(type_name(std::get<Shape>(mesh.source)));
}

Expected<ImportedMesh> read_source(const MeshDescription& mesh, const ImportLimits& limits) {
  if (const auto* file = std::get_if<MeshFile>(&mesh.source)) return import_mesh(file->path, limits);
  ImportedMesh generated;
  generated.mesh = make_shape(std::get<Shape>(mesh.source));
  generated.source.format = "generated";
  return generated;
}

}  // namespace

Error MeshUser::error(Error error) const {
  if (source_location.empty()) return error;
  error.subject.insert(0, source_location + ": " + name + ", ");
  return error;
}

SceneMeshes::Key SceneMeshes::key_of(const MeshDescription& mesh, OpenPolicy open) {
  Key key{.source = {},
          .scale = mesh.placement.scale,
          .position_B = mesh.placement.position_B,
          .orientation_B = mesh.placement.orientation_B.coeffs(),
          .repair = mesh.repair,
          .open = open,
          .merged = {}};
  if (const auto* file = std::get_if<MeshFile>(&mesh.source)) {
    std::error_code code;
    std::filesystem::path canonical = std::filesystem::weakly_canonical(file->path, code);
    if (code) canonical = file->path;
    key.source = std::move(canonical);
  } else {
    key.source = std::get<Shape>(mesh.source);
  }
  return key;
}

PreparedMesh* SceneMeshes::find(const Key& key) const {
  const auto known = std::find(keys_.begin(), keys_.end(), key);
  return known == keys_.end() ? nullptr : meshes_[static_cast<std::size_t>(known - keys_.begin())].get();
}

PreparedMesh* SceneMeshes::add(Key key, PreparedMesh mesh) {
  keys_.push_back(std::move(key));
  return meshes_.emplace_back(std::make_unique<PreparedMesh>(std::move(mesh))).get();
}

Expected<PreparedMesh*> SceneMeshes::find_or_prepare(const MeshDescription& mesh, OpenPolicy open,
                                                     const MeshUser& user, MeshReport* refused) {
  Key key = key_of(mesh, open);
  if (PreparedMesh* known = find(key)) return known;
  const auto known = std::ranges::find(refused_, key, &RefusedKey::key);
  if (known != refused_.end()) {
    return make_error(user.error(
        {source_name(mesh), "refused for " + known->first_user, "a mesh that can be used", "", ""}));
  }
  const auto refuse = [&](Error error) {
    refused_.push_back({std::move(key), user.name});
    return make_error(user.error(std::move(error)));
  };
  Expected<ImportedMesh> imported = read_source(mesh, limits_);
  if (!imported) return refuse(std::move(imported.error()));
  MeshPreparation preparation{mesh.repair.mirror, mesh.placement, options_};
  preparation.validation.open = open;
  preparation.validation.may_be_open = user.may_be_open;
  preparation.validation.repair = mesh.repair.policy;
  preparation.validation.closing = mesh.repair.closing;
  Expected<PreparedMesh> prepared =
      prepare_mesh(*std::move(imported), source_name(mesh), preparation, refused);
  if (!prepared) return refuse(std::move(prepared.error()));
  return add(std::move(key), *std::move(prepared));
}

PreparedMesh* SceneMeshes::find_or_merge(const std::vector<const PreparedMesh*>& meshes) {
  Key key;
  key.merged = meshes;
  if (PreparedMesh* known = find(key)) return known;
  return add(std::move(key), merge_meshes(meshes));
}

}  // namespace buoyancy
