#include "view/live/snapshot_json.h"

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "messages/wire_layout.h"
#include "view/common/sea_json.h"

namespace buoyancy::view {
namespace {

using nlohmann::json;

// Writes the bodies without nlohmann::json: they are most of a snapshot, with a hundred bodies at 30 Hz.
class BodyWriter {
 public:
  explicit BodyWriter(std::string& text) : text_(text) {}

  BodyWriter& plain(std::string_view characters) {
    text_ += characters;
    return *this;
  }
  // Writes the shortest text that reads back as the same T.
  template <typename T>
  BodyWriter& number_as(double value) {
    const auto rounded = static_cast<T>(value);
    if (!std::isfinite(rounded)) return plain("null");
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), rounded).ptr;
    text_.append(digits.data(), end);
    return *this;
  }
  BodyWriter& list(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) plain(i == 0 ? "[" : ",").number_as<double>(values[i]);
    return plain(values.empty() ? "[]" : "]");
  }
  BodyWriter& number(double value) { return number_as<float>(value); }
  BodyWriter& whole_number(std::int64_t value) { return plain(std::to_string(value)); }
  template <std::size_t kSize>
  BodyWriter& numbers(const std::array<double, kSize>& values) {
    return numbers_as<float>(values);
  }
  template <typename T, std::size_t kSize>
  BodyWriter& numbers_as(const std::array<double, kSize>& values) {
    for (std::size_t i = 0; i < kSize; ++i) plain(i == 0 ? "[" : ",").template number_as<T>(values[i]);
    return plain("]");
  }

 private:
  std::string& text_;
};

void append(BodyWriter& out, const BodyLoads& loads) {
  const auto wrench = [&out](std::string_view key, const std::array<double, 3>& force,
                             const std::array<double, 3>& torque) {
    out.plain(key).numbers(std::array{force[0], force[1], force[2], torque[0], torque[1], torque[2]});
  };
  out.plain(R"(,"loads":{"immersion":)").number(loads.immersion);
  wrench(R"(,"buoyancy":)", loads.buoyancy_force, loads.buoyancy_torque);
  wrench(R"(,"drag":)", loads.drag_force, loads.drag_torque);
  wrench(R"(,"added_mass":)", loads.added_mass_force, loads.added_mass_torque);
  out.plain(R"(,"water_velocity":)").numbers(loads.water_velocity).plain("}");
}

// condition: nullptr: unknown.
void append(BodyWriter& out, const BodyCondition* condition) {
  out.plain(R"(,"condition":)");
  if (condition == nullptr) {
    out.plain("null");
    return;
  }
  out.plain(R"({"flooded":)").list(condition->flooded);
  out.plain(R"(,"liquid_volumes":)").list(condition->liquid_volumes).plain("}");
}

void append(std::string& text, const BusMonitor& monitor, std::size_t index, double now) {
  const BodyMonitor& body = monitor.bodies()[index];
  const bool overdue = body.response_overdue(BusMonitor::kResponseTimeout);
  const BodyWrench* const wrench = body.wrench && !overdue ? &*body.wrench : nullptr;
  const bool complete = wrench != nullptr && !body.force_torque_only;
  BodyWriter out(text);
  out.plain(R"({"id":)").whole_number(body.id).plain(R"(,"status":)");
  if (complete) {
    out.whole_number(static_cast<std::int64_t>(wrench->status));
  } else {
    out.plain("null");
  }
  // Positions are written as doubles: 5,000 km from W's origin, adjacent floats are 0.5 m apart.
  out.plain(R"(,"p":)").numbers_as<double>(body.pose->position);
  out.plain(R"(,"q":)").numbers(body.pose->quaternion_wxyz);
  if (wrench != nullptr) {
    out.plain(R"(,"f":)").numbers(wrench->force).plain(R"(,"t":)").numbers(wrench->torque);
  } else {
    out.plain(R"(,"f":null,"t":null)");
  }
  if (complete) {
    out.plain(R"(,"b":)").numbers(wrench->center_of_buoyancy);
    out.plain(R"(,"volume":)").number(wrench->submerged_volume);
    out.plain(R"(,"force_bound":)").number(wrench->force_error_bound);
    out.plain(R"(,"torque_bound":)").number(wrench->torque_error_bound);
  } else {
    out.plain(R"(,"b":null,"volume":null,"force_bound":null,"torque_bound":null)");
  }
  if (body.metacenters && !overdue) {
    const auto& [points, heights] = *body.metacenters;
    out.plain(R"(,"m":[)").numbers(points[0]).plain(",").numbers(points[1]).plain("]");
    out.plain(R"(,"gm":)").numbers(heights);
  } else {
    out.plain(R"(,"m":null,"gm":null)");
  }
  if (body.loads && !overdue) append(out, *body.loads);
  if (monitor.has_conditions() && monitor.scene().bodies()[index].subdivision != nullptr) {
    append(out, monitor.condition(index).get());
  }
  out.plain(R"(,"age":)").number(now - *body.last_request).plain("}");
}

json percentiles_json(const LatencyPercentiles& latency) {
  return {{"p50", latency.p50}, {"p99", latency.p99}, {"p999", latency.p999}, {"max", latency.max}};
}

json second_json(const SecondStats& second) {
  const auto if_any = [&second](double value) { return second.responses > 0 ? json(value) : json(); };
  return {{"number", second.number},           {"requests", second.requests},
          {"responses", second.responses},     {"unanswered", second.unanswered},
          {"p50", if_any(second.latency.p50)}, {"p99", if_any(second.latency.p99)},
          {"max", if_any(second.latency.max)}};
}

// The fields of service_status_t under their names, those in 64 bits that identify something as text, and
// sums. Conditions matter with subdivided bodies only (rest_json).
json status_json(const ServiceStatus& status) {
  const ServiceCounters& counters = status.counters;
  json bodies;
  for (int i = 0; i < kBodyStatusCount; ++i) {
    bodies[to_string(static_cast<BodyStatus>(i))] = counters.bodies[static_cast<std::size_t>(i)];
  }
  json fields = {{"instance_id", std::to_string(status.instance_id)},
                 {"version", status.version},
                 {"scene", status.scene},
                 {"scene_fingerprint", std::to_string(status.scene_fingerprint)},
                 {"injected_faults", status.injected_faults},
                 {"mode", status.mode == ServiceMode::kLockstep ? "lockstep" : "latest"},
                 {"rejected", counters.rejected()},
                 {"bodies", bodies},
                 {"latency", percentiles_json(status.latency)}};
  visit_named_trailer(status, [&fields](const Field& field, const auto& value) {
    if (!field.name.starts_with("conditions_")) fields.emplace(field.name, value);
  });
  return fields;
}

json counts_json(const BusMonitor& monitor) {
  const RequestTracker::Counts& tracker = monitor.tracker();
  const BusMonitor::Counts& counts = monitor.counts();
  json malformed;
  for (const DecodeError error :
       {DecodeError::kTruncated, DecodeError::kFingerprint, DecodeError::kCount, DecodeError::kLength}) {
    malformed[to_string(error)] = counts.malformed[static_cast<std::size_t>(error)];
  }
  return {{"requests", tracker.requests},
          {"requests_repeated", tracker.requests_repeated},
          {"requests_missed", tracker.requests_missed},
          {"responses", tracker.responses},
          {"responses_repeated", tracker.responses_repeated},
          {"responses_without_request", tracker.responses_without_request},
          {"unanswered", tracker.unanswered},
          {"sessions", tracker.sessions},
          {"malformed", malformed},
          {"packets_dropped", counts.drops.packets},
          {"fragments_dropped", counts.drops.fragments},
          {"bodies_not_in_scene", counts.bodies_not_in_scene},
          {"statuses", counts.statuses},
          {"services_started", counts.services_started},
          {"seas_rejected", counts.seas_rejected}};
}

}  // namespace

std::string snapshot_json(const BusMonitor& monitor, std::int64_t number, double time, double listening,
                          double now) {
  const auto age = [now](std::optional<double> received) {
    return received ? json(now - *received) : json();
  };
  json services = json::array();
  for (const std::int64_t id : monitor.services(now)) services.push_back(std::to_string(id));
  json rest{{"number", number},
            {"time", time},
            {"listening", listening},
            {"service", to_string(monitor.service_state(now))},
            {"services", services},
            {"status", monitor.status() ? status_json(*monitor.status()) : json()},
            {"status_age", age(monitor.status_received())},
            {"response_age", age(monitor.response_received())},
            {"request_age", age(monitor.request_received())},
            {"second", monitor.seconds().empty() ? json() : second_json(monitor.seconds().back())},
            {"latency", percentiles_json(monitor.latency())},
            {"counts", counts_json(monitor)}};
  if (monitor.in_waves()) {
    const std::shared_ptr<const SeaPeriod> period = monitor.sea_period();
    rest["sea_time"] =
        period ? json(sea_time(*period, monitor.request_time()->utime, monitor.request_time()->lead_time))
               : json();
  }
  if (monitor.scene().bodies_with_subdivision() > 0) {
    rest["counts"]["conditions_rejected"] = monitor.counts().conditions_rejected;
    if (monitor.status()) {
      rest["status"]["conditions_received"] = monitor.status()->counters.conditions_received;
      rest["status"]["conditions_rejected"] = monitor.status()->counters.conditions_rejected;
    }
  }
  std::string text = json_line(rest);
  text.back() = ',';  // replaces the closing brace
  text += R"("bodies":[)";
  bool first = true;
  for (std::size_t i = 0; i < monitor.bodies().size(); ++i) {
    if (!monitor.bodies()[i].pose) continue;
    if (!std::exchange(first, false)) text += ',';
    append(text, monitor, i, now);
  }
  text += "]}";
  return text;
}

std::string history_json(const BusMonitor& monitor) {
  json seconds = json::array();
  for (const SecondStats& second : monitor.seconds()) seconds.push_back(second_json(second));
  return json_line(seconds);
}

}  // namespace buoyancy::view
