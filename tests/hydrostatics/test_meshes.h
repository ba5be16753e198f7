// Closed meshes that the hydrostatic tests share: ordinary ones, and ones that are thin, tiny, huge, hollow
// or far away.
#pragma once

#include <string>
#include <vector>

#include "tests/geometry/sample_meshes.h"

namespace buoyancy {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

TriangleMesh moved_and_scaled(TriangleMesh mesh, const Vec3& by, double scale = 1.0);

std::vector<NamedMesh> closed_test_meshes();

}  // namespace buoyancy
