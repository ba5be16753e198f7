#include "client/ping/ping_report.h"

#include <algorithm>

#include "base/format.h"
#include "base/json.h"

namespace buoyancy::ping {
namespace {

constexpr std::size_t kMaxBodiesShown = 20;

// Returns the largest ratio of a difference to its limit in all checks of a body.
double worst_of(const BodyChecks& body) {
  double worst = 0.0;
  for (const CheckResult& check : body.results) worst = std::max(worst, check.worst);
  return worst;
}

bool has_failed(const BodyChecks& body) {
  return std::ranges::any_of(body.results, [](const CheckResult& check) { return check.failed > 0; });
}

const char* verdict(const PingResult& result) {
  if (result.agrees() && result.checks.identical() < result.checks.replies()) {
    return "The service agrees with this program within the published bounds, but not to the last bit: it "
           "has\n"
           "another version, processor, method or tolerance, or a difference that the bounds hide "
           "(--identical).\n";
  }
  if (result.agrees()) return "The service agrees with this program within the published bounds.\n";
  if (!result.checks.all_passed()) return "The service does NOT agree with this program.\n";
  if (result.checks.replies() == 0) return "The service was NOT checked: there was no response.\n";
  return "The values agree, but the check has FAILED for the reasons that the error messages give.\n";
}

const char* mode_name(ServiceMode mode) {
  return mode == ServiceMode::kLatest ? "latest" : "lockstep";
}

}  // namespace

std::string describe_check(const CheckResult& check) {
  return format_text("{} of {} replies differ; {}", check.failed, check.compared, check.failure);
}

std::vector<std::string> failure_lines(const PingResult& result) {
  constexpr std::size_t kMaxChecksShown = 20;
  std::vector<std::string> lines;
  for (const RunFailure& failure : result.failures) lines.push_back(failure.check + ": " + failure.message);
  std::size_t failed = 0;
  for (const BodyChecks& body : result.checks.bodies()) {
    for (const Check check : kAllChecks) {
      if (body.at(check).failed == 0 || ++failed > kMaxChecksShown) continue;
      lines.push_back(format_text("body {} ({}), {}: {}", body.body_id, body.name, to_string(check),
                                  describe_check(body.at(check))));
    }
  }
  if (failed > kMaxChecksShown) {
    lines.push_back(std::to_string(failed - kMaxChecksShown) + " more checks failed; --json lists all");
  }
  for (const std::string& cause : result.likely_causes) lines.push_back("likely cause: " + cause);
  return lines;
}

std::string to_text(const PingTask& task, const PingResult& result) {
  std::string text;
  append_line(text, "%-12s %.300s, seed %llu", "scene", task.scene.name().c_str(),
              static_cast<unsigned long long>(task.seed));
  if (!result.url.empty()) {
    append_line(text, "%-12s %.160s, channels %.64s and %.64s", "network", result.url.c_str(),
                task.link.states_channel.c_str(), task.link.wrenches_channel.c_str());
  }
  if (result.service.status) {
    const ServiceStatus& status = *result.service.status;
    append_line(text, "%-12s version %.40s, scene %.300s, mode %s", "service", status.version.c_str(),
                status.scene.c_str(), mode_name(status.mode));
  }
  append_line(text, "%-12s %lld sent, %lld without a complete reply, %lld retries", "requests",
              static_cast<long long>(result.requests), static_cast<long long>(result.unanswered),
              static_cast<long long>(result.retries));
  append_line(text, "%-12s %lld compared, %lld of them identical to the last bit", "replies",
              static_cast<long long>(result.checks.replies()),
              static_cast<long long>(result.checks.identical()));
  append_line(text, "%-12s %lld undecodable, %lld duplicates, %lld conflicting", "messages",
              static_cast<long long>(result.link.undecodable.count),
              static_cast<long long>(result.link.duplicates),
              static_cast<long long>(result.link.conflicting));
  const RoundTrips times = summarize_round_trips(result.round_trips);
  if (!result.round_trips.empty()) {
    append_line(text, "%-12s min %.1f us, median %.1f us, p90 %.1f us, p99 %.1f us, max %.1f us",
                "round trip", 1e6 * times.min, 1e6 * times.median, 1e6 * times.p90, 1e6 * times.p99,
                1e6 * times.max);
  }
  append_line(text, "%6s  %-20s %9s %11s %11s %11s %11s %11s  %s", "body", "name", "compared", "force N",
              "torque N m", "volume m^3", "centre m", "over limit", "result");
  // Bodies that differ come first, so that they are among those shown.
  std::vector<const BodyChecks*> bodies;
  for (const BodyChecks& body : result.checks.bodies()) bodies.push_back(&body);
  std::ranges::stable_sort(
      bodies, [](const BodyChecks* a, const BodyChecks* b) { return has_failed(*a) && !has_failed(*b); });
  for (std::size_t i = 0; i < std::min(kMaxBodiesShown, bodies.size()); ++i) {
    const BodyChecks& body = *bodies[i];
    const WrenchDifferences& largest = body.largest;
    const std::int64_t compared = body.at(Check::kStatus).compared;
    append_line(text, "%6d  %-20.60s %9lld %11.3g %11.3g %11.3g %11.3g %11.3g  %s", body.body_id,
                body.name.c_str(), static_cast<long long>(compared), largest.force, largest.torque,
                largest.volume, largest.center, worst_of(body),
                compared == 0 ? "-" : (has_failed(body) ? "DIFFERS" : "agrees"));
  }
  if (bodies.size() > kMaxBodiesShown) {
    append_line(text, "        and %zu more; --json lists all", bodies.size() - kMaxBodiesShown);
  }
  text += verdict(result);
  return text;
}

std::string to_json(const PingTask& task, const PingResult& result) {
  Json bodies = Json::array();
  for (const BodyChecks& body : result.checks.bodies()) {
    Json checks;
    for (const Check check : kAllChecks) {
      const CheckResult& of = body.at(check);
      std::string key(to_string(check));
      std::ranges::replace(key, ' ', '_');
      checks[key] = {{"compared", of.compared}, {"failed", of.failed}, {"over_limit", of.worst}};
      if (of.failed > 0) checks[key]["failure"] = of.failure;
    }
    bodies.push_back({{"body_id", body.body_id},
                      {"name", body.name},
                      {"force", body.largest.force},
                      {"torque", body.largest.torque},
                      {"volume", body.largest.volume},
                      {"center", body.largest.center},
                      {"checks", checks}});
  }
  Json service = nullptr;
  if (result.service.status) {
    const ServiceStatus& status = *result.service.status;
    service = {{"version", status.version},
               {"scene", status.scene},
               {"scene_bodies", status.scene_bodies},
               {"mode", mode_name(status.mode)},
               {"instances", result.service.instance_ids.size()}};
  }
  Json failures = Json::array();
  for (const RunFailure& failure : result.failures) {
    failures.push_back({{"check", failure.check}, {"message", failure.message}});
  }
  const RoundTrips times = summarize_round_trips(result.round_trips);
  return json_lines(Json{{"agrees", result.agrees()},
                         {"scene", task.scene.name()},
                         {"url", result.url},
                         {"states_channel", task.link.states_channel},
                         {"wrenches_channel", task.link.wrenches_channel},
                         {"seed", task.seed},
                         {"requests", result.requests},
                         {"replies", result.checks.replies()},
                         {"identical", result.checks.identical()},
                         {"unanswered", result.unanswered},
                         {"retries", result.retries},
                         {"undecodable", result.link.undecodable.count},
                         {"duplicates", result.link.duplicates},
                         {"conflicting", result.link.conflicting},
                         {"seconds", result.seconds},
                         {"round_trip",
                          {{"min", times.min},
                           {"median", times.median},
                           {"p90", times.p90},
                           {"p99", times.p99},
                           {"max", times.max}}},
                         {"stopped_by", result.stopped_by},
                         {"service", service},
                         {"failures", failures},
                         {"likely_causes", result.likely_causes},
                         {"bodies", bodies}});
}

}  // namespace buoyancy::ping
