// Reads [body.drag] and [body.added_mass] of a scene file.
#pragma once

#include "scene/scene_file.h"
#include "scene/toml_table.h"

namespace buoyancy {

// Each leaves the value unchanged if its table is absent. Errors go into the context.
void parse_drag(TomlTable& body, const std::string& body_name, SceneParseContext& context,
                std::optional<DragDescription>& drag);
void parse_added_mass(TomlTable& body, const std::string& body_name, SceneParseContext& context,
                      std::optional<AddedMassDescription>& added_mass);

}  // namespace buoyancy
