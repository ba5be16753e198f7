// What the commands of buoyancy-mesh do; they print nothing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "geometry/mesh_validation.h"
#include "service/mesh/mesh_options.h"

namespace buoyancy::service {

// How far a wrap is from the mesh that it replaces [m], see largest_distance().
struct WrapReport {
  double gap = 0.0;
  double from_mesh = 0.0;  // of the mesh's surface from the wrap
  double from_wrap = 0.0;  // and the other way
};

// A mesh, checked; without a report if the file could not be read.
struct CheckedMesh {
  std::string name;
  std::optional<MeshReport> report;
  std::optional<TriangleMesh> mesh;  // if it is usable
  std::optional<Error> error;        // if not
  std::optional<WrapReport> wrap;    // if it is a wrap of what the file has
};
CheckedMesh check_mesh(const std::filesystem::path& path, const MeshPreparation& preparation);

// Replaces the mesh by a wrap around it, or around the file's faces if it could not be used (mesh_wrap.h).
// Errors: those of import_mesh() and wrap_mesh().
Expected<CheckedMesh> wrapped(const CheckedMesh& mesh, const MeshPlan& plan, double gap);

// One mesh: its report; several: a line for each, and a summary.
std::string report_text(const std::vector<CheckedMesh>& meshes);
// {"meshes": [...], "usable": N}; a mesh has the fields of mesh_report_facts(), "usable", and "error", a text
// or null.
std::string report_json(const std::vector<CheckedMesh>& meshes);

// The mesh as it is written: one that the importer, which reads single precision, gives back as it is, so
// that no further repair is made of it. Coordinates are rounded only if that takes it. mesh: usable. Errors:
// the rounding makes faults that cannot be repaired, or that change the volume by more than 1e-5.
Expected<CheckedMesh> as_written(CheckedMesh mesh, const std::string& output);

// The report of the repaired mesh and where it was written.
std::string repair_text(const CheckedMesh& repaired, const std::string& output);
std::string repair_json(const CheckedMesh& repaired, const std::string& output);

// What lies between two meshes, as text or as JSON with the same numbers. Errors: those of the meshes; one
// that is too large or too small for queries.
Expected<std::string> compare_meshes(const MeshPlan& plan, const MeshOptions& options);

}  // namespace buoyancy::service
