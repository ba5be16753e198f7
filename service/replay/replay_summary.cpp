#include "service/replay/replay_summary.h"

#include <spdlog/fmt/fmt.h>

namespace buoyancy::service {
namespace {

std::int64_t count_bodies(const ServiceCounters& counters) {
  std::int64_t sum = 0;
  for (const std::int64_t count : counters.bodies) sum += count;
  return sum;
}

double per_second(std::int64_t count, double seconds) {
  return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0;
}

// Visits what JSON stores of a summary, with its JSON pointer.
template <typename Summary, typename Visitor>
void visit_members(Summary& summary, const Visitor& visitor) {
  auto& counters = summary.counters;
  visitor("/requests", counters.requests);
  visitor("/computed", counters.computed);
  visitor("/retries", counters.retries);
  visitor("/rejected/truncated", counters.rejected_truncated);
  visitor("/rejected/fingerprint", counters.rejected_fingerprint);
  visitor("/rejected/count", counters.rejected_count);
  visitor("/rejected/length", counters.rejected_length);
  for (std::size_t i = 0; i < counters.bodies.size(); ++i) {
    visitor(std::string("/bodies/") + to_string(static_cast<BodyStatus>(i)), counters.bodies[i]);
  }
  visitor("/water_points", counters.water_points);
  visitor("/water_points_failed", counters.water_points_failed);
  visitor("/conditions_received", counters.conditions_received);
  visitor("/conditions_rejected", counters.conditions_rejected);
  visitor("/velocities_in_doubt", summary.doubts);
  visitor("/copied", summary.copied);
  visitor("/corrupt_sections", summary.corrupt_sections);
  visitor("/seconds", summary.seconds);
}

std::string comparison_text(const ReplayComparison& comparison) {
  std::string text =
      fmt::format("{:>8}{:>12}{:>14}{:>14}{:>14}{:>14}{:>18}{:>18}{:>18}{:>16}{:>18}\n", "body", "responses",
                  "force, N", "torque, N m", "volume, m^3", "centre, m", "force/bounds", "torque/bounds",
                  "centre/bounds", "status changed", "worst at, us");
  for (const auto& [id, body] : comparison.bodies()) {
    text += fmt::format(
        "{:>8}{:>12}{:>14.3g}{:>14.3g}{:>14.3g}{:>14.3g}{:>18.3g}{:>18.3g}{:>18.3g}{:>16}{:>18}\n", id,
        body.responses, body.largest.force, body.largest.torque, body.largest.volume, body.largest.center,
        body.largest.force_in_bounds, body.largest.torque_in_bounds, body.largest.center_in_bounds,
        body.status_changes, body.worst_utime);
  }
  const auto messages = [&text](std::int32_t id, const char* name, const MessageDifferences& differences) {
    if (differences.compared == 0) return;
    text += fmt::format("{:>8} {}: {} compared, largest difference over tolerance {:.3g}{}{}\n", id, name,
                        differences.compared, differences.in_bounds,
                        differences.worst_field.empty() ? "" : ", ", differences.worst_field);
  };
  for (const auto& [id, body] : comparison.bodies()) {
    messages(id, "hydrostatics", body.hydrostatics);
    messages(id, "loads", body.loads);
  }
  const auto line = [&text](const char* what, std::int64_t count) {
    if (count > 0) text += fmt::format("{:>12} {}\n", count, what);
  };
  line("messages were not recorded, between others of their session", comparison.not_recorded());
  line("new responses have no counterpart in the baseline", comparison.unmatched_new());
  line("responses of the baseline have no counterpart in this run", comparison.unmatched_baseline());
  line("sections or messages of the baseline could not be decoded", comparison.decode_errors());
  text += comparison.agrees()
              ? "Force, torque, centre and status of every response agree with the baseline within their "
                "bounds.\n"
              : "The responses do NOT agree with the baseline within their bounds.\n";
  return text;
}

Json comparison_json(const ReplayComparison& comparison) {
  Json bodies = Json::array();
  for (const auto& [id, body] : comparison.bodies()) {
    bodies.push_back({{"body_id", id},
                      {"responses", body.responses},
                      {"status_changes", body.status_changes},
                      {"force", body.largest.force},
                      {"torque", body.largest.torque},
                      {"volume", body.largest.volume},
                      {"center", body.largest.center},
                      {"force_in_bounds", body.largest.force_in_bounds},
                      {"torque_in_bounds", body.largest.torque_in_bounds},
                      {"center_in_bounds", body.largest.center_in_bounds},
                      {"worst_utime", body.worst_utime},
                      {"hydrostatics", body.hydrostatics.compared},
                      {"hydrostatics_in_bounds", body.hydrostatics.in_bounds},
                      {"hydrostatics_worst_field", body.hydrostatics.worst_field},
                      {"loads", body.loads.compared},
                      {"loads_in_bounds", body.loads.in_bounds},
                      {"loads_worst_field", body.loads.worst_field}});
  }
  return {{"agrees", comparison.agrees()},
          {"not_recorded", comparison.not_recorded()},
          {"unmatched_new", comparison.unmatched_new()},
          {"unmatched_baseline", comparison.unmatched_baseline()},
          {"decode_errors", comparison.decode_errors()},
          {"bodies", bodies}};
}

}  // namespace

std::string summary_text(const ReplaySummary& summary, const ReplayComparison* comparison) {
  const ServiceCounters& counters = summary.counters;
  std::string text = fmt::format("{:<22}{:>12}\n", "requests", counters.requests);
  const auto line = [&text](std::string_view what, std::int64_t count) {
    text += fmt::format("  {:<20}{:>12}\n", what, count);
  };
  line("computed", counters.computed);
  line("retries", counters.retries);
  line("rejected", counters.rejected());
  if (summary.requests && summary.requests->missing() > 0) {
    line("not recorded", summary.requests->missing());
    for (const std::string& gaps : gap_lines(*summary.requests, "requests")) text += "  " + gaps + "\n";
  }
  text += fmt::format("{:<22}{:>12}\n", "bodies", count_bodies(counters));
  for (std::size_t i = 0; i < counters.bodies.size(); ++i) {
    if (i == 0 || counters.bodies[i] > 0) line(to_string(static_cast<BodyStatus>(i)), counters.bodies[i]);
  }
  if (const std::int64_t points = counters.water_points + counters.water_points_failed; points > 0) {
    text += fmt::format("{:<22}{:>12}\n", "points of the water", points);
    line("failed", counters.water_points_failed);
  }
  if (counters.seas_received + counters.seas_rejected > 0) {
    text += fmt::format("{:<22}{:>12}\n", "seas", counters.seas_received + counters.seas_rejected);
    line("rejected", counters.seas_rejected);
  }
  if (counters.conditions_received + counters.conditions_rejected > 0) {
    text += fmt::format("{:<22}{:>12}\n", "conditions",
                        counters.conditions_received + counters.conditions_rejected);
    line("rejected", counters.conditions_rejected);
  }
  if (!summary.doubts.empty())
    text += fmt::format("{:<22}{:>12}\n", "velocities in doubt", summary.doubts.size());
  if (summary.copied > 0) text += fmt::format("{:<22}{:>12}\n", "events copied", summary.copied);
  text += fmt::format("{:<22}{:>12}\n", "corrupt sections", summary.corrupt_sections);
  text += fmt::format("{:<22}{:>12.3f}\n", "seconds", summary.seconds);
  text +=
      fmt::format("{:<22}{:>12.0f}\n", "requests per second", per_second(counters.requests, summary.seconds));
  if (comparison != nullptr) text += comparison_text(*comparison);
  return text;
}

Json summary_to_json(const ReplaySummary& summary) {
  Json json{{"complete", summary.complete()}, {"stopped_by", summary.stopped_by}};
  visit_members(summary, [&json](const std::string& pointer, const auto& member) {
    json[Json::json_pointer(pointer)] = member;
  });
  json["requests_per_second"] = per_second(summary.counters.requests, summary.seconds);
  return json;
}

ReplaySummary summary_from_json(const Json& json) {
  ReplaySummary summary;
  visit_members(summary, [&json](const std::string& pointer, auto& member) {
    json.at(Json::json_pointer(pointer)).get_to(member);
  });
  return summary;
}

std::string summary_json(const ReplaySummary& summary, const ReplayComparison* comparison) {
  Json json = summary_to_json(summary);
  if (summary.requests && summary.requests->missing() > 0)
    json["requests_not_recorded"] = summary.requests->missing();
  if (comparison != nullptr) json["compared"] = comparison_json(*comparison);
  return json_lines(json);
}

}  // namespace buoyancy::service
