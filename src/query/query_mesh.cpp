#include "query/query_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/format.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxBodies = 32;  // that a mesh keeps

std::optional<Error> error_of(const QueryMeshOptions& options, const std::string& name) {
  const auto& [scale, position_B, orientation_B] = options.placement;
  if (!scale.allFinite() || (scale.array() == 0.0).any()) {
    return Error{name, "scale = " + format_vector(scale), "finite factors of x, y and z, none of them 0", "",
                 "For millimetres pass 0.001, for metres leave the scale out"};
  }
  if (!position_B.allFinite()) {
    return Error{name, "position = " + format_vector(position_B), "three finite numbers (m)", "", ""};
  }
  const double norm = orientation_B.norm();
  if (std::isfinite(norm) && norm > 0.0) return std::nullopt;
  return Error{name, "an orientation whose quaternion has the norm " + format_number(norm),
               "a quaternion (w, x, y, z) that is finite and not 0", "", ""};
}

Expected<TriangleMesh> to_mesh(std::span<const double> vertices, std::span<const std::int64_t> faces,
                               const std::string& name) {
  if (vertices.size() % 3 != 0 || faces.size() % 3 != 0) {
    return make_error({name,
                       std::to_string(vertices.size()) + " coordinates and " + std::to_string(faces.size()) +
                           " vertex indices",
                       "three coordinates per vertex and three indices per triangle", "", ""});
  }
  const std::size_t count = vertices.size() / 3;
  if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    return make_error({name, std::to_string(count) + " vertices", "fewer than 2^31", "", ""});
  }
  if (faces.empty())
    return make_error({name, "no face", "at least four triangles, a closed surface", "", ""});
  TriangleMesh mesh;
  for (std::vector<double>* const coordinates : {&mesh.x, &mesh.y, &mesh.z}) coordinates->reserve(count);
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    mesh.add_vertex({vertices[i], vertices[i + 1], vertices[i + 2]});
  }
  mesh.triangles.reserve(faces.size() / 3);
  for (std::size_t i = 0; i < faces.size(); i += 3) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::int64_t index = faces[i + corner];
      if (index >= 0 && index < static_cast<std::int64_t>(count)) continue;
      return make_error(
          {name, "face " + std::to_string(i / 3) + " has the vertex index " + std::to_string(index),
           "0 to " + std::to_string(static_cast<std::int64_t>(count) - 1),
           index == static_cast<std::int64_t>(count) ? "the indices count from 1, as in OBJ files"
                                                     : "faces and vertices belong to different meshes",
           "Number vertices from 0"});
    }
    mesh.triangles.push_back({static_cast<std::int32_t>(faces[i]), static_cast<std::int32_t>(faces[i + 1]),
                              static_cast<std::int32_t>(faces[i + 2])});
  }
  return mesh;
}

MeshPreparation preparation_of(const QueryMeshOptions& options) {
  MeshPreparation preparation{
      options.repair.mirror, options.placement, {options.open, options.count_intersecting_pairs}};
  preparation.validation.repair = options.repair.policy;
  preparation.validation.closing = options.repair.closing;
  return preparation;
}

}  // namespace

QueryMesh::QueryMesh(PreparedMesh prepared) : prepared_(std::move(prepared)) {
  prepared_.mesh.tree = build_moment_tree(prepared_.mesh);
}

Expected<std::shared_ptr<const QueryMesh>> QueryMesh::load(const std::filesystem::path& path,
                                                           const QueryMeshOptions& options,
                                                           MeshReport* refused) {
  if (std::optional<Error> error = error_of(options, path.string())) return make_error(*std::move(error));
  Expected<ImportedMesh> imported = import_mesh(path, options.limits);
  if (!imported) return make_error(std::move(imported.error()));
  Expected<PreparedMesh> prepared =
      prepare_mesh(*std::move(imported), path.string(), preparation_of(options), refused);
  if (!prepared) return make_error(std::move(prepared.error()));
  return std::shared_ptr<const QueryMesh>(new QueryMesh(*std::move(prepared)));
}

Expected<std::shared_ptr<const QueryMesh>> QueryMesh::make(std::span<const double> vertices,
                                                           std::span<const std::int64_t> faces,
                                                           const std::string& name,
                                                           const QueryMeshOptions& options,
                                                           MeshReport* refused) {
  if (std::optional<Error> error = error_of(options, name)) return make_error(*std::move(error));
  Expected<TriangleMesh> mesh = to_mesh(vertices, faces, name);
  if (!mesh) return make_error(std::move(mesh.error()));
  ImportedMesh imported;
  imported.mesh = *std::move(mesh);
  imported.source.format = "arrays";
  Expected<PreparedMesh> prepared = prepare_mesh(std::move(imported), name, preparation_of(options), refused);
  if (!prepared) return make_error(std::move(prepared.error()));
  return std::shared_ptr<const QueryMesh>(new QueryMesh(*std::move(prepared)));
}

Expected<void> QueryMesh::prepare_for_waves() const {
  if (prepared_.wave_mesh) return {};
  if (std::optional<Error> error = size_error_in_waves(prepared_.report.name, prepared_.mesh)) {
    return make_error(*std::move(error));
  }
  prepared_.wave_mesh = make_wave_mesh(prepared_.mesh);
  return {};
}

Expected<std::shared_ptr<const Body>> QueryMesh::body(Method method, double tolerance, bool in_waves) const {
  if (!(tolerance >= 0.0 && tolerance <= 1.0)) {
    return make_error({prepared_.report.name, "tolerance = " + format_shortest(tolerance),
                       "0 to 1, relative to the weight of the full displacement", "", ""});
  }
  if (method != Method::kHierarchical)
    tolerance = 0.0;  // only kHierarchical has a tolerance
  else if (in_waves && tolerance == 0.0)
    tolerance = kDefaultWaveTolerance;
  const std::lock_guard lock(mutex_);
  if (in_waves) {
    if (std::optional<Error> error = method_error_in_waves(prepared_.report.name, method, tolerance)) {
      return make_error(*std::move(error));
    }
    if (const Expected<void> ready = prepare_for_waves(); !ready) return make_error(ready.error());
  }
  for (const std::shared_ptr<const Body>& known : bodies_) {
    if (known->solver.method() == method && known->solver.tolerance() == tolerance) return known;
  }
  if (is_of_paper(method) && prepared_.mesh.meshlets == nullptr) {
    prepared_.mesh.meshlets = std::make_shared<const Meshlets>(build_meshlets(prepared_.mesh.surface));
  }
  if (bodies_.size() == kMaxBodies) bodies_.erase(bodies_.begin());
  bodies_.push_back(std::make_shared<const Body>(Body{0,
                                                      prepared_.report.name,
                                                      &prepared_,
                                                      Solver(prepared_.mesh, method, tolerance),
                                                      Vec3::Zero(),
                                                      {},
                                                      false,
                                                      false,
                                                      nullptr,
                                                      std::nullopt,
                                                      {}}));
  return bodies_.back();
}

}  // namespace buoyancy
