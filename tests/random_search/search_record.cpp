#include "tests/random_search/search_record.h"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "tests/random_search/record_files.h"

namespace buoyancy {
namespace {

using Json = nlohmann::json;

Json to_json(const SearchStats& stats) {
  Json json{{"cases", stats.cases}, {"results", stats.results}, {"failed_cases", stats.failed_cases}};
  for (std::size_t row = 0; row < kEvaluators.size(); ++row) {
    for (std::size_t column = 0; column < Figures::kNames.size(); ++column) {
      const Largest& largest = stats.largest[row][column];
      json["largest"][to_string(kEvaluators[row])][Figures::kNames[column]] = {{"value", largest.value},
                                                                               {"case", largest.at}};
    }
  }
  json["failures"] = Json::array();
  for (const FailedCase& failure : stats.failures)
    json["failures"].push_back(
        {{"case", failure.number}, {"mesh", failure.mesh}, {"violations", failure.violations}});
  return json;
}

SearchStats from_json(const Json& json) {
  SearchStats stats;
  stats.cases = json.at("cases");
  stats.results = json.at("results");
  stats.failed_cases = json.at("failed_cases");
  for (std::size_t row = 0; row < kEvaluators.size(); ++row) {
    for (std::size_t column = 0; column < Figures::kNames.size(); ++column) {
      const Json& largest = json.at("largest").at(to_string(kEvaluators[row])).at(Figures::kNames[column]);
      stats.largest[row][column] = {largest.at("value"), largest.at("case")};
    }
  }
  for (const Json& failure : json.at("failures"))
    stats.failures.push_back({failure.at("case"), failure.at("mesh"), failure.at("violations")});
  return stats;
}

constexpr RecordFiles<SearchStats> kFiles{"seed-", "a record of a search", &to_json, &from_json};

}  // namespace

Expected<SearchStats> load_stats(const std::filesystem::path& directory, std::uint64_t seed) {
  return kFiles.load(directory, seed);
}

Expected<void> save_stats(const std::filesystem::path& directory, std::uint64_t seed,
                          const SearchStats& stats) {
  return kFiles.save(directory, seed, stats);
}

Expected<SearchStats> load_all(const std::filesystem::path& directory) {
  return kFiles.load_all(directory);
}

std::string markdown(const SearchStats& stats) {
  std::string text = "| |";
  for (const char* column : Figures::kNames) text += std::string(" ") + column + " |";
  text += "\n|---|---|---|---|---|\n";
  for (std::size_t row = 0; row < kEvaluators.size(); ++row) {
    text += std::string("| `") + to_string(kEvaluators[row]) + "` |";
    for (const Largest& largest : stats.largest[row]) {
      std::array<char, 32> number;
      std::snprintf(number.data(), number.size(), " %.2g |", largest.value);
      text += largest.value > 0.0 ? number.data() : " |";
    }
    text += '\n';
  }
  return text;
}

std::string summary(const SearchStats& stats) {
  std::array<char, 160> text;
  std::snprintf(text.data(), text.size(), "%lld cases, %lld results, %lld violations",
                static_cast<long long>(stats.cases), static_cast<long long>(stats.results),
                static_cast<long long>(stats.failed_cases));
  return text.data();
}

}  // namespace buoyancy
