// Internal to scene_file.cpp: checks TOML text before toml++ parses it. The parser recurses for every level
// of tables within tables, so that a text of a few thousand dots would overflow the stack.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"

namespace buoyancy {

// The most levels of a header, and of a key with the arrays and inline tables around it. The deepest key of a
// scene has 5 in all.
inline constexpr std::size_t kMaxTomlLevels = 32;

// Returns an Error that names the line if a header, or a key with the arrays and inline tables around it, has
// more than kMaxTomlLevels levels. Text that is no TOML may pass: its first fault ends the parser.
std::optional<Error> check_toml_nesting(std::string_view text, const std::string& name);

}  // namespace buoyancy
