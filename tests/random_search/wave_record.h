// The results of the search in waves so far, on disk: one JSON file per seed in a directory, beside those of
// the search in still water (search_record.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "tests/random_search/wave_search.h"

namespace buoyancy {

// Returns zeros if there is no such file. Error: the file is not a record of a search in waves.
Expected<WaveSearchStats> load_wave_stats(const std::filesystem::path& directory, std::uint64_t seed);
// Replaces the file atomically. Error: the directory or the file cannot be written.
Expected<void> save_wave_stats(const std::filesystem::path& directory, std::uint64_t seed,
                               const WaveSearchStats& stats);
// Adds up the records of all seeds in the directory.
Expected<WaveSearchStats> load_all_wave_stats(const std::filesystem::path& directory);

// The figures by kind of sea as a Markdown table.
std::string markdown(const WaveSearchStats& stats);
// A summary in one line.
std::string summary(const WaveSearchStats& stats);

}  // namespace buoyancy
