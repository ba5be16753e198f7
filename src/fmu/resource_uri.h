// The location of an FMU's resources as FMI 2.0 has it: a URI.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace buoyancy::fmu {

// Returns the path of a URI such as "file:///tmp/my%20fmu/resources" or "file:/tmp"; nullopt for any other
// scheme or host than "localhost", and for a wrong escape.
std::optional<std::filesystem::path> path_of_uri(std::string_view uri);

}  // namespace buoyancy::fmu
