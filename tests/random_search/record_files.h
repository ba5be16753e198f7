// The results of a search so far, on disk: one JSON file per seed in a directory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace buoyancy {

// Stats: default-constructible, with operator+=.
template <typename Stats>
struct RecordFiles {
  const char* prefix;       // of the files' names
  const char* description;  // for errors, such as "a record of a search"
  nlohmann::json (*to_json)(const Stats&);
  Stats (*from_json)(const nlohmann::json&);

  // Returns Stats{} if there is no such file. Error: the file is not a record.
  Expected<Stats> load(const std::filesystem::path& directory, std::uint64_t seed) const {
    const std::filesystem::path path = file_of(directory, seed);
    if (!std::filesystem::exists(path)) return Stats{};
    return load_file(path);
  }

  // Replaces the file atomically. Error: the directory or the file cannot be written.
  Expected<void> save(const std::filesystem::path& directory, std::uint64_t seed, const Stats& stats) const {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    const std::filesystem::path path = file_of(directory, seed);
    const std::filesystem::path fresh = path.string() + ".new";
    std::ofstream file(fresh);
    file << to_json(stats).dump(1) << '\n';
    file.close();
    if (file) std::filesystem::rename(fresh, path, error);
    if (!file || error) {
      return make_error({path.string(), "cannot be written", "a writable directory for the records", "",
                         "Choose another directory with --record"});
    }
    return {};
  }

  // Adds up the records of all seeds in the directory.
  Expected<Stats> load_all(const std::filesystem::path& directory) const {
    Stats total;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with(prefix) || entry.path().extension() != ".json") continue;
      Expected<Stats> stats = load_file(entry.path());
      if (!stats) return stats;
      total += *stats;
    }
    return total;
  }

 private:
  std::filesystem::path file_of(const std::filesystem::path& directory, std::uint64_t seed) const {
    return directory / (prefix + std::to_string(seed) + ".json");
  }

  Expected<Stats> load_file(const std::filesystem::path& path) const {
    std::ifstream file(path);
    const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
    try {
      return from_json(json);
    } catch (const nlohmann::json::exception&) {
      return make_error({path.string(), std::string("is not ") + description,
                         "a file written by an earlier run", "another version or another program wrote it",
                         "Remove the file"});
    }
  }
};

}  // namespace buoyancy
