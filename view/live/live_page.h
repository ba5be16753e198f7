// The texts of the live page, as PageServer serves them: the page, its scripts and styles, and the scene as
// JSON. Nothing of it is inline, so that the browser may be told to run nothing else.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"
#include "view/live/page_server.h"

namespace buoyancy {

// version: of this program, as shown. Errors: three.js cannot be read.
Expected<std::vector<StaticResource>> live_page(const Scene& scene, const std::string& version,
                                                const std::filesystem::path& three);

}  // namespace buoyancy
