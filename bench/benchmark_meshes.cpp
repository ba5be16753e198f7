#include "benchmark_meshes.h"

#include <cstdlib>
#include <filesystem>

#include "geometry/mesh_import.h"
#include "geometry/mesh_validation.h"
#include "geometry/shapes.h"

namespace buoyancy {
namespace {

BenchmarkMesh from_shape(const std::string& name, const Shape& shape) {
  TriangleMesh source = make_shape(shape);
  HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}});
  return {name, std::move(source), std::move(mesh)};
}

std::filesystem::path mesh_directory() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): read once, before any thread is started
  const char* const named = std::getenv("BUOYANCY_MESHES");
  return named != nullptr ? named : BUOYANCY_SOURCE_DIR "/../shared/meshes";
}

}  // namespace

BenchmarkMesh rock(int frequency) {
  return from_shape("rock", RockShape{.frequency = frequency});
}

BenchmarkMesh model_or_rock(const std::string& name, const std::string& file, int frequency) {
  const std::filesystem::path path = mesh_directory() / file;
  if (std::filesystem::exists(path)) {
    if (const auto imported = import_mesh(path)) {
      MeshValidation validation = validate_mesh(*imported, file);
      if (validation.mesh) {
        HydrostaticMesh mesh = make_hydrostatic_mesh(*validation.mesh);
        return {name, std::move(validation.mesh->mesh), std::move(mesh)};
      }
    }
  }
  return rock(frequency);
}

std::vector<BenchmarkMesh> paper_meshes() {
  std::vector<BenchmarkMesh> meshes;
  meshes.push_back(from_shape("torus knot", TorusKnotShape{}));
  meshes.push_back(model_or_rock("bunny", "bunny_5002.ply", 16));
  meshes.push_back(model_or_rock("armadillo", "armadillo_30000.ply", 39));
  return meshes;
}

}  // namespace buoyancy
