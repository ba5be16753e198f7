#include "tests/random_search/wave_record.h"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "tests/random_search/record_files.h"

namespace buoyancy {
namespace {

using Json = nlohmann::json;

// Calls visit(name, member) for every counter.
template <typename Figures, typename Visit>
void visit_counters(Figures& figures, const Visit& visit) {
  visit("cases", figures.cases);
  visit("loads", figures.loads);
  visit("undecided", figures.undecided);
  visit("capped", figures.capped);
  visit("too_steep", figures.too_steep);
  visit("long_waves", figures.long_waves);
  visit("long_within", figures.long_within);
}
template <typename Figures, typename Visit>
void visit_largest(Figures& figures, const Visit& visit) {
  visit("force", figures.force);
  visit("torque", figures.torque);
  visit("volume", figures.volume);
}

Json to_json(const WaveSearchStats& stats) {
  Json json{{"failed_cases", stats.failed_cases}};
  for (std::size_t i = 0; i < kSeaKinds.size(); ++i) {
    Json& of_kind = json["figures"][std::string(to_string(kSeaKinds[i]))];
    const WaveFigures& figures = stats.figures[i];
    visit_counters(figures, [&](const char* name, std::int64_t value) { of_kind[name] = value; });
    visit_largest(figures, [&](const char* name, const LargestInWaves& largest) {
      of_kind[name] = {{"value", largest.value}, {"case", largest.at}};
    });
    of_kind["ratios"] = figures.ratios.counts;
  }
  json["failures"] = Json::array();
  for (const FailedWaveCase& failure : stats.failures) {
    json["failures"].push_back(
        {{"case", failure.number}, {"text", failure.text}, {"violations", failure.violations}});
  }
  return json;
}

WaveSearchStats from_json(const Json& json) {
  WaveSearchStats stats;
  stats.failed_cases = json.at("failed_cases");
  for (std::size_t i = 0; i < kSeaKinds.size(); ++i) {
    const Json& of_kind = json.at("figures").at(std::string(to_string(kSeaKinds[i])));
    WaveFigures& figures = stats.figures[i];
    visit_counters(figures, [&](const char* name, std::int64_t& value) { value = of_kind.at(name); });
    visit_largest(figures, [&](const char* name, LargestInWaves& largest) {
      largest = {of_kind.at(name).at("value"), of_kind.at(name).at("case")};
    });
    figures.ratios.counts = of_kind.at("ratios");
  }
  for (const Json& failure : json.at("failures")) {
    stats.failures.push_back({failure.at("case"), failure.at("text"), failure.at("violations")});
  }
  return stats;
}

constexpr RecordFiles<WaveSearchStats> kFiles{"waves-seed-", "a record of a search in waves", &to_json,
                                              &from_json};

double percent(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 100.0;
}

std::string row_of(const std::string& name, const WaveFigures& figures) {
  std::array<char, 240> text;
  std::snprintf(text.data(), text.size(),
                "| %s | %lld | %.2g | %.2g | %.2g | %.0f | %.2f %% | %lld | %lld | %lld |\n", name.c_str(),
                static_cast<long long>(figures.cases), figures.force.value, figures.torque.value,
                figures.volume.value, figures.ratios.median(),
                percent(figures.long_within, figures.long_waves), static_cast<long long>(figures.capped),
                static_cast<long long>(figures.too_steep), static_cast<long long>(figures.undecided));
  return text.data();
}

}  // namespace

Expected<WaveSearchStats> load_wave_stats(const std::filesystem::path& directory, std::uint64_t seed) {
  return kFiles.load(directory, seed);
}

Expected<void> save_wave_stats(const std::filesystem::path& directory, std::uint64_t seed,
                               const WaveSearchStats& stats) {
  return kFiles.save(directory, seed, stats);
}

Expected<WaveSearchStats> load_all_wave_stats(const std::filesystem::path& directory) {
  return kFiles.load_all(directory);
}

std::string markdown(const WaveSearchStats& stats) {
  std::string text =
      "| sea | cases | largest error / bound, force | torque | volume | median bound / error | "
      "long waves: bound within the tolerance | capped | too steep | undecided |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  for (std::size_t i = 0; i < kSeaKinds.size(); ++i) {
    text += row_of(std::string(to_string(kSeaKinds[i])), stats.figures[i]);
  }
  return text + row_of("all", stats.total());
}

std::string summary(const WaveSearchStats& stats) {
  const WaveFigures total = stats.total();
  std::array<char, 320> text;
  std::snprintf(
      text.data(), text.size(),
      "%lld cases in waves, %lld loads, %lld violations, %lld undecided; largest error/bound: force "
      "%.3g (case %lld), torque %.3g (case %lld), volume %.3g (case %lld)",
      static_cast<long long>(total.cases), static_cast<long long>(total.loads),
      static_cast<long long>(stats.failed_cases), static_cast<long long>(total.undecided), total.force.value,
      static_cast<long long>(total.force.at), total.torque.value, static_cast<long long>(total.torque.at),
      total.volume.value, static_cast<long long>(total.volume.at));
  return text.data();
}

}  // namespace buoyancy
