// The meshes that times and errors are measured on: the paper's three models and rocks of growing size.
#pragma once

#include <string>
#include <vector>

#include "hydrostatics/hydrostatic_mesh.h"

namespace buoyancy::bench {

struct BenchmarkMesh {
  std::string name;  // "bunny", or "rock for bunny" where the model was not at hand
  TriangleMesh source;
  HydrostaticMesh mesh;
};

// The paper's torus knot of 1,760 triangles, the bunny of 5,002 and the armadillo of 30,000. The two scanned
// models are read from $BUOYANCY_MESHES (bunny_5002.ply, armadillo_30000.ply); where they are absent rocks of
// about that size stand in, and their name says so.
std::vector<BenchmarkMesh> paper_meshes();

// A mesh file of $BUOYANCY_MESHES; where it is absent a rock of 20 frequency^2 triangles.
BenchmarkMesh model_or_rock(const std::string& name, const std::string& file, int frequency);

BenchmarkMesh torus_knot();
BenchmarkMesh rock(int frequency);

// The same mesh with its triangles in an order that has nothing to do with where they lie: the same on every
// machine. Its name says "shuffled".
BenchmarkMesh shuffled(const BenchmarkMesh& model);

}  // namespace buoyancy::bench
