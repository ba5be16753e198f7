// Creates the errors that the readers of all formats share. The caller sets Error::subject.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/error.h"
#include "geometry/mesh_format.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

// Returns an error if the mesh exceeds the limits. triangles: a lower bound, after splitting polygons.
std::optional<Error> check_limits(std::uint64_t vertices, std::uint64_t triangles,
                                  const ImportLimits& limits);

// message: the text of the format's reader; may be empty.
Error unreadable(MeshFormat format, const std::string& message);

Error no_triangles(std::int64_t points_and_lines);

}  // namespace buoyancy
