// Internal to scene_file.cpp: parses a shape table, { type = "box", size = [1, 1, 1] }.
#pragma once

#include <optional>

#include "geometry/shapes.h"
#include "scene/toml_table.h"

namespace buoyancy {

// Reads `type` and that type's keys, which are the fields of its struct (shapes.h), and checks the shape.
// Returns nullopt on an error, which is then in the table's context.
std::optional<Shape> parse_shape(TomlTable& table);

}  // namespace buoyancy
