#include "service/replay_summary.h"

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

namespace buoyancy {
namespace {

std::int64_t all_bodies(const Counters& counters) {
  std::int64_t sum = 0;
  for (const std::int64_t count : counters.bodies) sum += count;
  return sum;
}

double per_second(std::int64_t count, double seconds) {
  return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0;
}

}  // namespace

std::string summary_text(const ReplaySummary& summary) {
  const Counters& counters = summary.counters;
  std::string text = fmt::format("{:<22}{:>12}\n", "questions", counters.questions);
  const auto line = [&text](std::string_view what, std::int64_t count) {
    text += fmt::format("  {:<20}{:>12}\n", what, count);
  };
  line("answered", counters.answered);
  line("repeated", counters.repeated);
  line("rejected", counters.rejected());
  text += fmt::format("{:<22}{:>12}\n", "bodies", all_bodies(counters));
  for (std::size_t i = 0; i < counters.bodies.size(); ++i) {
    if (i == 0 || counters.bodies[i] > 0) line(name(static_cast<BodyStatus>(i)), counters.bodies[i]);
  }
  text += fmt::format("{:<22}{:>12}\n", "damaged places", summary.damages);
  text += fmt::format("{:<22}{:>12.3f}\n", "seconds", summary.seconds);
  text += fmt::format("{:<22}{:>12.0f}\n", "questions per second",
                      per_second(counters.questions, summary.seconds));
  return text;
}

std::string summary_json(const ReplaySummary& summary) {
  const Counters& counters = summary.counters;
  nlohmann::ordered_json bodies;
  for (std::size_t i = 0; i < counters.bodies.size(); ++i) {
    bodies[name(static_cast<BodyStatus>(i))] = counters.bodies[i];
  }
  const nlohmann::ordered_json json{
      {"complete", summary.complete()},
      {"ended_by", summary.ended_by},
      {"questions", counters.questions},
      {"answered", counters.answered},
      {"repeated", counters.repeated},
      {"rejected",
       {{"truncated", counters.rejected_truncated},
        {"fingerprint", counters.rejected_fingerprint},
        {"count", counters.rejected_count},
        {"length", counters.rejected_length}}},
      {"bodies", bodies},
      {"damaged_places", summary.damages},
      {"seconds", summary.seconds},
      {"questions_per_second", per_second(counters.questions, summary.seconds)}};
  return json.dump(2) + "\n";
}

}  // namespace buoyancy
