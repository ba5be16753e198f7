// The page of `buoyancy-mesh repair --html`: the mesh before and after, which rotate together, with the open
// edges and the faces that changed, and the report. It contains everything that it needs and loads nothing.
#pragma once

#include <string>

#include "base/error.h"
#include "service/mesh/mesh_commands.h"

namespace buoyancy::service {

// repaired: with a report. Reads the file again. Errors: those of import_mesh().
Expected<std::string> mesh_page(const MeshPlan& plan, const CheckedMesh& repaired);

}  // namespace buoyancy::service
