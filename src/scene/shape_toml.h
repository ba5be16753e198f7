// A shape as a table of the scene file: { type = "box", size = [1, 1, 1] }. For scene_file.cpp only.
#pragma once

#include <optional>

#include "geometry/shapes.h"
#include "scene/toml_table.h"

namespace buoyancy {

// Reads `type` and that type's keys, which are the fields of its struct (shapes.h), and checks the shape;
// nullopt: wrong, the table's reading says how.
std::optional<Shape> parse_shape(TomlTable& table);

}  // namespace buoyancy
