// Closed meshes that the hydrostatics tests share: ordinary ones, and thin, tiny, huge, hollow or distant
// ones.
#pragma once

#include <string>
#include <vector>

#include "hydrostatics/hydrostatic_mesh.h"
#include "tests/geometry/sample_meshes.h"

namespace buoyancy {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

TriangleMesh moved_and_scaled(TriangleMesh mesh, const Vec3& by, double scale = 1.0);

// The mesh as a file of float32 coordinates holds it.
TriangleMesh rounded_to_float32(TriangleMesh mesh);

std::vector<NamedMesh> closed_test_meshes();

inline HydrostaticMesh mesh_of(const Shape& shape) {
  return make_hydrostatic_mesh({make_shape(shape), {}});
}

}  // namespace buoyancy
