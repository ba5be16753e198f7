// The results of the search so far, on disk: one JSON file per seed in a directory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "tests/random_search/search.h"

namespace buoyancy {

// Returns zeros if there is no such file. Error: the file is not a record of a search.
Expected<SearchStats> load_stats(const std::filesystem::path& directory, std::uint64_t seed);
// Replaces the file atomically. Error: the directory or the file cannot be written.
Expected<void> save_stats(const std::filesystem::path& directory, std::uint64_t seed,
                          const SearchStats& stats);
// Adds up the records of all seeds in the directory.
Expected<SearchStats> load_all(const std::filesystem::path& directory);

// The largest error ratios as a Markdown table: evaluators x error over gate and over bound.
std::string markdown(const SearchStats& stats);
// A summary in one line.
std::string summary(const SearchStats& stats);

}  // namespace buoyancy
