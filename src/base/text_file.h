// Reads and writes small files that a user names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"

namespace buoyancy {

// Returns the contents of a regular file. what: what the file should be, for errors: "a scene file (TOML)".
// Errors: no such file, not a regular file, more than max_bytes, not readable.
Expected<std::string> read_text_file(const std::filesystem::path& path, const std::string& what,
                                     std::uintmax_t max_bytes);

// Writes a file, or replaces it. Errors: it cannot be written, or the disk is full.
Expected<void> write_file(const std::filesystem::path& path, const std::string& bytes);

}  // namespace buoyancy
