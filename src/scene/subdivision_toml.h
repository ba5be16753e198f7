// Internal to scene_file.cpp: parses where the meshes of a body come from, and the sections [[body.part]],
// [[body.compartment]] and [[body.tank]].
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_file.h"
#include "scene/toml_table.h"

namespace buoyancy {

// Reads `orientation`, a quaternion (w, x, y, z) of any norm but 0, which is scaled by a power of 2 to a norm
// of about 1.
void parse_orientation(TomlTable& table, Eigen::Quaterniond& orientation);

// Reads `mesh`, `scale` and `shape`. name: of the table, for errors. Returns whether there is a mesh or a
// shape.
bool parse_mesh(TomlTable& table, const std::string& name, const std::filesystem::path& directory,
                SceneParseContext& context, MeshDescription& mesh);

// Reads `part`, `compartment` and `tank`. body_name: identifies the body in errors. water: of the scene.
void parse_subdivision(TomlTable& body_table, const std::string& body_name, const Water& water,
                       const std::filesystem::path& directory, SceneParseContext& context,
                       BodyDescription& body);

}  // namespace buoyancy
