// The meshes of the benchmarks: the paper's three models and rocks of increasing size.
#pragma once

#include <string>
#include <vector>

#include "hydrostatics/hydrostatic_mesh.h"

namespace buoyancy::bench {

struct BenchmarkMesh {
  std::string name;  // "bunny", or "rock for bunny" if the model is not available
  TriangleMesh source;
  HydrostaticMesh mesh;
};

// The paper's torus knot of 1,760 triangles, the bunny of 5,002 and the armadillo of 30,000. The two scanned
// models are read from $BUOYANCY_MESHES (bunny_5002.ply, armadillo_30000.ply); a missing model is replaced by
// a rock of about that size, whose name names the model.
std::vector<BenchmarkMesh> paper_meshes();

// A mesh file of $BUOYANCY_MESHES, or a rock of 20 frequency^2 triangles if it is missing.
BenchmarkMesh model_or_rock(const std::string& name, const std::string& file, int frequency);

BenchmarkMesh torus_knot();
BenchmarkMesh rock(int frequency);

// "rock uv": the surface of the rock over a grid of longitudes and latitudes, as many tools make spheres: 2
// longitudes (bands - 1) triangles, which get narrow towards the poles and are slivers there.
BenchmarkMesh rock_uv(int longitudes, int bands);

// The same mesh with its triangles in a random order that is the same on every machine. Its name ends with
// "shuffled".
BenchmarkMesh shuffled(const BenchmarkMesh& model);

}  // namespace buoyancy::bench
