// The texts that a page is made of: ours, compiled in from view/page, and three.js, read from where Debian
// installs it, so that no code of other people is in here.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace buoyancy {

inline constexpr const char* kThreeJs = "/usr/share/javascript/three/three.min.js";

// A file of view/page by its name, "style.css". Empty: there is no such file.
std::string_view page_text(std::string_view file_name);

// three.js, to be put between <script> and </script>. Errors: not readable, not three.js, a file that would
// end the script it is put into.
Expected<std::string> three_js(const std::filesystem::path& path = kThreeJs);

// A page that needs no other file: page_text(file_name) with each line "<!-- insert NAME -->" replaced by
// page_text(NAME) as style or script, by its extension; by three.js where NAME is three.js.
std::string self_contained_page(std::string_view file_name, std::string_view three);

// JSON as a script's text, where "</script>" and "<!--" would mean something: '<' is escaped.
std::string escaped_for_script(std::string_view json);

}  // namespace buoyancy
