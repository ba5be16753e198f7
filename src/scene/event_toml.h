// Internal to scene_file.cpp: parses the sections [[body.client.event]].
#pragma once

#include <string>

#include "scene/scene_file.h"
#include "scene/toml_table.h"

namespace buoyancy {

// Reads `event` of [body.client]. body: with its compartments and tanks, which the events refer to; gets the
// events in the order of their times. body_name: identifies the body in errors.
void parse_events(TomlTable& client, const std::string& body_name, SceneParseContext& context,
                  BodyDescription& body);

}  // namespace buoyancy
