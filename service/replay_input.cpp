#include "service/replay_input.h"

namespace buoyancy {

Expected<ReplayInput> ReplayInput::open(const std::filesystem::path& path, FileFormat format,
                                        const std::string& states_channel) {
  if (format == FileFormat::kCsv) {
    Expected<StateCsvReader> reader = StateCsvReader::open(path);
    if (!reader) return tl::unexpected(reader.error());
    return ReplayInput(std::move(*reader));
  }
  Expected<EventLogReader> reader = EventLogReader::open(path, states_channel);
  if (!reader) return tl::unexpected(reader.error());
  return ReplayInput(std::move(*reader));
}

}  // namespace buoyancy
