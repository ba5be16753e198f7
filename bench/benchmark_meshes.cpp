#include "benchmark_meshes.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>
#include <utility>

#include "geometry/mesh_import.h"
#include "geometry/mesh_validation.h"
#include "geometry/shape_generators.h"
#include "geometry/shapes.h"

namespace buoyancy::bench {
namespace {

BenchmarkMesh prepared(const std::string& name, TriangleMesh source) {
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
  return prepared("torus knot", make_shape(TorusKnotShape{}));
}

BenchmarkMesh rock(int frequency) {
  return prepared("rock", make_shape(RockShape{.frequency = frequency}));
}

BenchmarkMesh rock_uv(int longitudes, int bands) {
  TriangleMesh mesh;
  const RockShape shape;
  // float32, as in a mesh file.
  const auto add = [&](const Vec3& direction) {
    return mesh.add_vertex(rock_surface_point(shape, direction).cast<float>().cast<double>());
  };
  const std::int32_t north = add(Vec3::UnitZ());
  const std::int32_t south = add(-Vec3::UnitZ());
  const auto at = [&](int ring, int i) { return 2 + (ring - 1) * longitudes + i % longitudes; };
  for (int ring = 1; ring < bands; ++ring) {
    const double polar = std::numbers::pi * ring / bands;
    for (int i = 0; i < longitudes; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / longitudes;
      add({std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)});
    }
  }
  for (int i = 0; i < longitudes; ++i) mesh.triangles.push_back({north, at(1, i), at(1, i + 1)});
  for (int ring = 1; ring + 1 < bands; ++ring) {
    for (int i = 0; i < longitudes; ++i) {
      mesh.triangles.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
      mesh.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
    }
  }
  for (int i = 0; i < longitudes; ++i)
    mesh.triangles.push_back({at(bands - 1, i), south, at(bands - 1, i + 1)});
  return prepared("rock uv", std::move(mesh));
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
  return prepared(model.name + " shuffled", std::move(source));
}

std::vector<BenchmarkMesh> paper_meshes() {
  std::vector<BenchmarkMesh> meshes;
  meshes.push_back(torus_knot());
  meshes.push_back(model_or_rock("bunny", "bunny_5002.ply", 16));
  meshes.push_back(model_or_rock("armadillo", "armadillo_30000.ply", 39));
  return meshes;
}

}  // namespace buoyancy::bench
