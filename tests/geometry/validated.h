// Validates meshes of tests.
#pragma once

#include "geometry/mesh_validation.h"

namespace buoyancy {

inline MeshValidation validate(const TriangleMesh& mesh, OpenPolicy open = OpenPolicy::kRefuse) {
  return validate_mesh({mesh, {}}, "hull.stl", {.open = open});
}

}  // namespace buoyancy
