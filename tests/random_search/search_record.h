// What runs of the search have found so far, on disk: one JSON file per seed in a directory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "tests/random_search/search.h"

namespace buoyancy {

// Zeros where there is no such file. Errors: a file that is not one of ours.
Expected<SearchStats> load_stats(const std::filesystem::path& directory, std::uint64_t seed);
// Replaces the file at once or not at all. Errors: a directory that cannot be written.
Expected<void> save_stats(const std::filesystem::path& directory, std::uint64_t seed,
                          const SearchStats& tally);
// Of all seeds of the directory.
Expected<SearchStats> load_all(const std::filesystem::path& directory);

// The largest figures as a Markdown table: who answers x error over gate and over bound.
std::string markdown(const SearchStats& tally);
// One line.
std::string summary(const SearchStats& tally);

}  // namespace buoyancy
