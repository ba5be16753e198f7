// A mesh that is validated and prepared for queries, as the bodies of a scene share it.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "base/error.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_report.h"
#include "geometry/mesh_validation.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/solver.h"
#include "scene/mesh_placement.h"
#include "wave_loads/wave_buoyancy.h"

namespace buoyancy {

inline constexpr double kDefaultWaveTolerance = 1e-3;  // of `hierarchical` in waves, see docs/waves.md

// One per source (file, shape or arrays), scale and open policy.
struct PreparedMesh {
  MeshReport report;
  HydrostaticMesh mesh;
  MassProperties mass_properties;     // density 1 kg/m^3; for an open mesh, the integrals over its faces
  std::optional<WaveMesh> wave_mesh;  // if queries in waves need it
};

// Scales the mesh in double, moves it and rounds once, validates and prepares it; without a moment tree.
// name: identifies it in the report and in errors. Errors: those of validate_mesh(). Complexity: O(n log n).
Expected<PreparedMesh> prepare_mesh(ImportedMesh imported, const std::string& name,
                                    const MeshPlacement& placement, const ValidationOptions& options);

// All triangles of closed meshes as one mesh, as they are: where meshes overlap, their volume counts as often
// as they do. Its report is the sum of theirs. Precondition: at least one mesh. Complexity: O(n log n).
PreparedMesh merge_meshes(std::span<const PreparedMesh* const> meshes);

// What makes a method or a tolerance unusable in waves. subject: of the error.
std::optional<Error> method_error_in_waves(const std::string& subject, Method method, double tolerance);

// Whether a mesh is too small or too large for the float32 numbers of wave loads. name: of the mesh.
std::optional<Error> size_error_in_waves(const std::string& name, const HydrostaticMesh& mesh);

}  // namespace buoyancy
