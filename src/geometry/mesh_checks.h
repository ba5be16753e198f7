// Checks whether a mesh is usable for hydrostatic queries.
//
// Contract: each check returns an Error if the mesh fails it, else nullopt. The Error states the number of
// faults by kind, the location of the first or largest one, and how to fix them. A check reads only those
// fields of `report` that validation fills in before it.
#pragma once

#include <optional>

#include "base/error.h"
#include "geometry/mesh_report.h"
#include "geometry/mesh_topology.h"
#include "geometry/mesh_validation.h"

namespace buoyancy {

// Requires finite coordinates for every vertex that a face uses.
std::optional<Error> check_finite(const TriangleMesh& mesh, const std::string& name);

// Requires faces whose extent, area and volume are finite and whose extent and area do not underflow to 0.
std::optional<Error> check_size(const MeshReport& report);

// Returns whether every edge is matched, except for a boundary that `open` accepts.
bool edges_are_usable(const MeshTopology& topology, OpenPolicy open);

// Requires edges_are_usable().
std::optional<Error> check_edges(const TriangleMesh& mesh, const MeshTopology& topology,
                                 const MeshReport& report, const ValidationOptions& options);

// Returns the error for a mesh whose components overlap so often that orient_closed() cannot nest them.
Error too_many_overlaps(const MeshReport& report);

// Requires V > eps (64 |V| + L A), where A is the mesh's sheet_rounding_area(). volume [m^3]: the volume V
// that the mesh encloses, or would enclose with its holes closed, less its cavities.
std::optional<Error> check_volume(const TriangleMesh& mesh, double volume, const MeshReport& report);

}  // namespace buoyancy
