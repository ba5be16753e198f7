#include "benchmark_meshes.h"

#include <cstdlib>
#include <filesystem>
#include <random>
#include <utility>

#include "geometry/mesh_import.h"
#include "geometry/mesh_validation.h"
#include "geometry/shapes.h"

namespace buoyancy::bench {
namespace {

BenchmarkMesh from_shape(const std::string& name, const Shape& shape) {
  TriangleMesh source = make_shape(shape);
  HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}});
  return {name, std::move(source), std::move(mesh)};
}

std::filesystem::path mesh_directory() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): read once, before any thread is started
  const char* const directory = std::getenv("BUOYANCY_MESHES");
  return directory != nullptr ? directory : BUOYANCY_SOURCE_DIR "/../shared/meshes";
}

}  // namespace

BenchmarkMesh torus_knot() {
  return from_shape("torus knot", TorusKnotShape{});
}

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
  BenchmarkMesh substitute = rock(frequency);
  substitute.name += " for " + name;
  return substitute;
}

BenchmarkMesh shuffled(const BenchmarkMesh& model) {
  TriangleMesh source = model.source;
  // Fisher-Yates shuffle, because std::shuffle may differ between standard libraries. The modulo bias, 1e6 of
  // 2^64, is negligible.
  std::mt19937_64 generator(1);
  for (std::size_t i = source.triangles.size(); i > 1; --i) {
    std::swap(source.triangles[i - 1], source.triangles[generator() % i]);
  }
  HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}});
  return {model.name + " shuffled", std::move(source), std::move(mesh)};
}

std::vector<BenchmarkMesh> paper_meshes() {
  std::vector<BenchmarkMesh> meshes;
  meshes.push_back(torus_knot());
  meshes.push_back(model_or_rock("bunny", "bunny_5002.ply", 16));
  meshes.push_back(model_or_rock("armadillo", "armadillo_30000.ply", 39));
  return meshes;
}

}  // namespace buoyancy::bench
