// Validates meshes of tests.
#pragma once

#include "geometry/mesh_validation.h"

namespace buoyancy {

inline MeshValidation validate(const TriangleMesh& mesh, OpenPolicy open = OpenPolicy::kRefuse) {
  return validate_mesh({mesh, {}}, "hull.stl", {.open = open});
}

// What the validation repaired of this kind; null if nothing.
inline const RepairStep* step_of(const MeshValidation& validation, RepairKind kind) {
  for (const RepairStep& step : validation.report.repair.steps) {
    if (step.kind == kind) return &step;
  }
  return nullptr;
}

}  // namespace buoyancy
