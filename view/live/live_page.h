// The resources of the live page, served by PageServer: the page, its scripts and styles, and the scene as
// JSON. Scripts and styles are separate files, so that the content security policy can forbid inline scripts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"
#include "view/live/page_server.h"

namespace buoyancy::view {

// version: of this program, as displayed. Errors: three.js cannot be read.
Expected<std::vector<StaticResource>> live_page(const Scene& scene, const std::string& version,
                                                const std::filesystem::path& three);

}  // namespace buoyancy::view
