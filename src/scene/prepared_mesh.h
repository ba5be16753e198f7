// A mesh that is validated and prepared for queries, as the bodies of a scene share it.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "base/error.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_report.h"
#include "geometry/mesh_validation.h"
#include "geometry/mirroring.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/solver.h"
#include "scene/mesh_placement.h"
#include "wave_loads/wave_buoyancy.h"

namespace buoyancy {

inline constexpr double kDefaultWaveTolerance = 1e-3;  // of `hierarchical` in waves, see docs/waves.md

// What is done to the coordinates of a source (file, shape or arrays).
struct MeshPreparation {
  std::optional<Axis> mirror;  // the mirror image is added first, in the source's own axes (mirroring.h)
  MeshPlacement placement;
  ValidationOptions validation;
};

// A mesh ready for queries. A scene has one per source and preparation.
struct PreparedMesh {
  MeshReport report;
  HydrostaticMesh mesh;
  MassProperties mass_properties;     // density 1 kg/m^3; for an open mesh, the integrals over its faces
  std::optional<WaveMesh> wave_mesh;  // if queries in waves need it
  Vec3 scale = Vec3::Ones();          // of the file's coordinates; without meaning for several meshes
};

// Mirrors the mesh, scales it in double, moves it and rounds once, and validates it. name: identifies it in
// the report and in errors. Complexity: O(n log n).
MeshValidation validate_mesh(ImportedMesh imported, const std::string& name,
                             const MeshPreparation& preparation);

// Validates the mesh and prepares it, without a moment tree. Errors: those of validation. refused: set to the
// report of a mesh that is refused, unless nullptr. Complexity: O(n log n).
Expected<PreparedMesh> prepare_mesh(ImportedMesh imported, const std::string& name,
                                    const MeshPreparation& preparation, MeshReport* refused = nullptr);

// Returns all triangles of closed meshes as one mesh: where meshes overlap, the common volume counts for each
// of them. Its report is the sum of theirs. Precondition: at least one mesh. Complexity: O(n log n).
PreparedMesh merge_meshes(std::span<const PreparedMesh* const> meshes);

// Returns an error if the method or the tolerance cannot be used in waves. subject: of the error.
std::optional<Error> method_error_in_waves(const std::string& subject, Method method, double tolerance);

// Returns an error if the mesh is too small or too large for the float32 numbers of wave loads.
std::optional<Error> size_error_in_waves(const std::string& name, const HydrostaticMesh& mesh);

}  // namespace buoyancy
