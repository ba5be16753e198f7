// The files that a page consists of: those of view/page, compiled in, and three.js, which is read from where
// Debian installs it, so that the repository holds no third-party code.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace buoyancy::view {

inline constexpr const char* kThreeJs = "/usr/share/javascript/three/three.min.js";

// The contents of a file of view/page, such as "style.css"; empty if there is no such file. subdivision:
// whether the scene has compartments or tanks; for others, the lines with the comment "only with subdivision"
// are left out, so that their pages do not grow.
std::string page_text(std::string_view file_name, bool subdivision = false);

// Reads three.js for insertion between <script> and </script>. Errors: the file cannot be read, is not
// three.js, or contains "</script", which would end the element.
Expected<std::string> three_js(const std::filesystem::path& path = kThreeJs);

// A page that needs no other file: page_text(file_name) in which each "<!-- insert NAME -->" is replaced by
// page_text(NAME) as a style or script element, depending on its extension, or by `three` for three.js.
// subdivision: as for page_text().
std::string self_contained_page(std::string_view file_name, std::string_view three, bool subdivision = false);

// Puts JSON in the place of "<!-- data -->" of a page, as the script element "data".
void insert_data(std::string& page, std::string_view json);

// Escapes '<' in JSON, so that "</script>" and "<!--" have no effect inside a script element.
std::string escaped_for_script(std::string_view json);

}  // namespace buoyancy::view
