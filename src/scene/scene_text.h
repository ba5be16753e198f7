// Changes the text of a scene file, and leaves all that it does not change as it is, comments too.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace buoyancy {

// Replaces the name of each file, of meshes and of wave components, by new_name(name, is_mesh). New names
// have no characters that a TOML string escapes. Precondition: parse_scene() accepts the text. O(text *
// names).
std::string rename_files(std::string_view text,
                         const std::function<std::string(const std::string& name, bool is_mesh)>& new_name);

}  // namespace buoyancy
