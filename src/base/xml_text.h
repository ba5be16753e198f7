// Text in XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace buoyancy {

// Escapes text for XML: markup, and characters that XML 1.0 cannot hold or that are not UTF-8 become U+FFFD.
std::string escape_xml(std::string_view text);

}  // namespace buoyancy
