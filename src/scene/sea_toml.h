// Internal to scene_file.cpp: parses the keys of [water] that describe the sea, and its wave systems.
#pragma once

#include <filesystem>

#include "scene/toml_table.h"
#include "waves/sea_description.h"

namespace buoyancy {

// Reads `depth`, `wave_pressure`, `time_origin`, `ramp` and `waves`, and the files of components that `waves`
// names, relative to `directory`. Errors go into the context. The sea as a whole is checked by
// Sea::make(). Returns which messages bring the sea, if it is not described.
SeaMessages parse_sea(TomlTable& water, const std::filesystem::path& directory, SceneParseContext& context,
                      SeaDescription& sea);

}  // namespace buoyancy
