// Errors that the readers of all formats share. The caller sets Error::subject.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/error.h"
#include "geometry/mesh_format.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

// triangles: after splitting polygons, at least.
std::optional<Error> check_limits(std::uint64_t vertices, std::uint64_t triangles,
                                  const ImportLimits& limits);

// message: what the reader says; may be empty.
Error unreadable(MeshFormat format, const std::string& message);

Error no_triangles(std::int64_t points_and_lines);

}  // namespace buoyancy
