#include "scene/event_toml.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/format.h"

namespace buoyancy {
namespace {

// What an event may change, and by which key.
struct EventKind {
  bool is_tank;
  std::string_view section;  // the key that holds the index
  std::string_view value;    // the key that holds the new value
  NumberRange range;
};

const std::array<EventKind, 2>& event_kinds() {
  static const std::array<EventKind, 2> kinds{
      EventKind{false, "compartment", "flooded", NumberRange::from_zero_to(1.0)},
      EventKind{true, "tank", "liquid_volume", NumberRange::from_zero("m^3")}};
  return kinds;
}

void check_index(TomlTable& table, const EventKind& kind, std::size_t count, std::int32_t index) {
  if (index >= 0 && static_cast<std::size_t>(index) < count) return;
  const std::string section(kind.section);
  if (count == 0) {
    table.fail_at(kind.section, "a body with sections [[body." + section + "]]", "the body has none");
    return;
  }
  table.fail_at(kind.section,
                "an index from 0 to " + std::to_string(count - 1) + ", in the order of the scene file",
                "counted from 1, or that of another body");
}

ConditionEvent read_event(TomlTable& table, const BodyDescription& body) {
  ConditionEvent event;
  table.read("time", event.time, NumberRange::above_zero("s"));
  const EventKind* chosen = nullptr;
  int sections = 0;
  for (const EventKind& kind : event_kinds()) {
    if (!table.has(kind.section)) continue;
    ++sections;
    chosen = &kind;
    event.is_tank = kind.is_tank;
    table.read(kind.section, event.index);
    check_index(table, kind, kind.is_tank ? body.tanks.size() : body.compartments.size(), event.index);
    table.read(kind.value, event.value, kind.range);
  }
  table.finish();
  if (!table.has("time")) table.fail_missing("time", "the time of the event (s), from the start of the run");
  if (sections != 1) {
    table.fail(sections == 0 ? "neither 'compartment' nor 'tank'" : "both 'compartment' and 'tank'",
               "one of them: its number, from 0", {},
               "Write compartment = 0 and flooded = 1.0, or tank = 0 and liquid_volume = 2.0");
  } else if (!table.has(chosen->value)) {
    table.fail_missing(chosen->value, chosen->is_tank ? "the volume of liquid from then on (m^3)"
                                                      : "the share that is open to the sea from then on");
  }
  return event;
}

}  // namespace

void parse_events(TomlTable& client, const std::string& body_name, SceneParseContext& context,
                  BodyDescription& body) {
  const toml::node* node = client.node("event");
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array != nullptr && array->empty()) return;
  if (array == nullptr || !array->is_homogeneous<toml::table>()) {
    client.fail_at("event", "a list of tables: a section [[body.client.event]] for each",
                   node->is_table() ? "[body.client.event] in single brackets" : "",
                   "Write [[body.client.event]] in double brackets");
    return;
  }
  std::vector<ConditionEvent>& events = body.dynamics.events;
  for (const toml::node& element : *array) {
    TomlTable table(*element.as_table(), body_name + ", event " + std::to_string(events.size()), context);
    events.push_back(read_event(table, body));
  }
  std::ranges::stable_sort(events, {}, &ConditionEvent::time);
}

}  // namespace buoyancy
