#include "view/live/metrics.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "base/format.h"
#include "messages/wire_layout.h"

namespace buoyancy::view {
namespace {

// The integer fields that are gauges in the sense of Prometheus; all others are counters.
constexpr std::array<std::string_view, 6> kGauges{"mode",         "simd_target", "threads",
                                                  "scene_bodies", "sessions",    "retained_bytes"};

std::string escaped(std::string_view label) {
  std::string text;
  for (const char c : label) {
    if (c == '\\' || c == '"') text += '\\';
    text += c == '\n' ? "\\n" : std::string(1, c);
  }
  return text;
}

void add_metric(std::string& text, const std::string& name, const char* type, const std::string& value,
                const std::string& labels = "") {
  text += "# TYPE " + name + " " + type + "\n" + name + labels + " " + value + "\n";
}

}  // namespace

std::string metrics_text(const ServiceStatus* status) {
  std::string text;
  add_metric(text, "buoyancy_up", "gauge", status != nullptr ? "1" : "0");
  if (status == nullptr) return text;
  add_metric(text, "buoyancy_info", "gauge", "1",
             "{version=\"" + escaped(status->version) + "\",scene=\"" + escaped(status->scene) +
                 "\",injected_faults=\"" + escaped(status->injected_faults) + "\",instance_id=\"" +
                 std::to_string(status->instance_id) + "\",scene_fingerprint=\"" +
                 std::to_string(status->scene_fingerprint) + "\"}");
  visit_named_trailer(*status, [&text]<typename Value>(const Field& field, const Value& value) {
    if (field.name == "scene_fingerprint") return;
    std::string metric = "buoyancy_" + std::string(field.name);
    if constexpr (std::is_floating_point_v<Value>) {
      if (field.unit == "s") metric += "_seconds";
      add_metric(text, metric, "gauge", format_shortest(value));
    } else {
      const bool is_gauge = std::ranges::find(kGauges, field.name) != kGauges.end();
      if (!is_gauge) metric += "_total";
      add_metric(text, metric, is_gauge ? "gauge" : "counter",
                 std::to_string(static_cast<std::int64_t>(value)));
    }
  });
  return text;
}

}  // namespace buoyancy::view
