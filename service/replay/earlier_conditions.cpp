#include "service/replay/earlier_conditions.h"

#include <variant>

namespace buoyancy::service {

Expected<ConditionTimeline> conditions_before(std::int64_t offset, const std::filesystem::path& log,
                                              ReplayChannels& channels, const Scene& scene) {
  // The filter is that of the replay: which events a reader takes for valid may depend on it.
  Expected<EventLogReader> reader = EventLogReader::open(
      log, [&channels](std::string_view channel) { return channels.role_of(channel).any(); });
  if (!reader) return make_error(reader.error());
  ConditionTimeline conditions(scene);
  while (true) {
    const LogItem item = reader->next(offset);
    if (std::holds_alternative<EndOfLog>(item) || std::holds_alternative<LimitReached>(item)) break;
    const auto* const event = std::get_if<RecordedEvent>(&item);
    if (event == nullptr || !channels.role_of(event->channel).condition) continue;
    conditions.receive(event->bytes, scene);
  }
  if (reader->file().read_error()) return make_error(*reader->file().read_error());
  return conditions;
}

}  // namespace buoyancy::service
