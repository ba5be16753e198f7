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

// The result of checking a mesh. It has no report if the file could not be read.
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

// Formats the report of one mesh; of several meshes, a line for each, and a summary.
std::string report_text(const std::vector<CheckedMesh>& meshes);
// {"meshes": [...], "usable": N}; a mesh has the fields of mesh_report_facts(), "usable", and "error", a text
// or null.
std::string report_json(const std::vector<CheckedMesh>& meshes);

// Returns the mesh as it is written. The importer, which reads single precision, must find nothing to repair
// in it, so that the mesh is rounded and repaired again if necessary. mesh: usable. Errors: the rounding
// causes faults that cannot be repaired, or changes the volume by more than 1e-5 of it.
Expected<CheckedMesh> as_written(CheckedMesh mesh, const std::string& output);

// Format the report of the repaired mesh and the name of the file that it was written to.
std::string repair_text(const CheckedMesh& repaired, const std::string& output);
std::string repair_json(const CheckedMesh& repaired, const std::string& output);

// Describes how two meshes differ, as text or as JSON with the same numbers. Errors: a mesh cannot be read or
// used, or is too large or too small for queries.
Expected<std::string> compare_meshes(const MeshPlan& plan, const MeshOptions& options);

}  // namespace buoyancy::service
