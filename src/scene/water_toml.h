// Internal to scene_file.cpp: reads the sections [water.current] and [[water.current.profile]] of a scene file.
#pragma once

#include "base/current.h"
#include "scene/toml_table.h"

namespace buoyancy {

// Leaves its values unchanged if the section is absent. Errors go into the context.
//
// velocity_W: of a current with a profile, that of the profile at the level. Errors: neither or both of
// `velocity` and a profile; more than kMaxCurrentPoints; heights that do not fall.
void parse_current(TomlTable& water, SceneParseContext& context, Vec3& velocity_W, CurrentProfile& profile);

}  // namespace buoyancy
