// Internal to scene_file.cpp: reads the sections [[water.layer]], [water.current] and
// [[water.current.profile]] of a scene file.
#pragma once

#include "base/current.h"
#include "base/water.h"
#include "scene/toml_table.h"

namespace buoyancy {

// Each leaves its values unchanged if its section is absent. Errors go into the context.

// water: with its level and density. Errors: more than kMaxWaterLayers; heights that do not fall, from the
// level down; a density below the one above it, which would not stay there.
void parse_layers(TomlTable& table, SceneParseContext& context, Water& water);

// velocity_W: of a current with a profile, that of the profile at the level. Errors: neither or both of
// `velocity` and a profile; more than kMaxCurrentPoints; heights that do not fall.
void parse_current(TomlTable& water, SceneParseContext& context, Vec3& velocity_W, CurrentProfile& profile);

}  // namespace buoyancy
