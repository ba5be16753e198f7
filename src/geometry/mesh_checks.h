// Says why a mesh cannot carry a hydrostatic query, in words that a person can act on: how many of which
// fault, where the first or largest of them is, and what to do about it.
#pragma once

#include <optional>

#include "base/error.h"
#include "geometry/mesh_report.h"
#include "geometry/mesh_topology.h"
#include "geometry/mesh_validation.h"

namespace buoyancy {

// Each: the reason to refuse, if there is one. report: as far as it is filled in when the check can be made.

// Vertices that faces use must be finite.
std::optional<Error> check_finite(const TriangleMesh& mesh, const std::string& name);

// There must be faces, and their extent, area and volume must be numbers.
std::optional<Error> check_size(const MeshReport& report);

// Every edge must have its partner, but for boundaries that `open` accepts.
std::optional<Error> check_edges(const TriangleMesh& mesh, const MeshTopology& topology,
                                 const MeshReport& report, OpenPolicy open);

// volume, m^3: that the mesh encloses, or would with its holes closed, cavities taken away; must be above its
// own rounding error eps (64 |V| + L A), A the mesh's rounding_area().
std::optional<Error> check_volume(const TriangleMesh& mesh, double volume, const MeshReport& report);

}  // namespace buoyancy
