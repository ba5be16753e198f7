#include "service/replay/replay_input.h"

#include <utility>

namespace buoyancy::service {

Expected<ReplayInput> ReplayInput::open(const std::filesystem::path& path, FileFormat format,
                                        ChannelFilter wanted) {
  if (format == FileFormat::kCsv) {
    Expected<StateCsvReader> reader = StateCsvReader::open(path);
    if (!reader) return tl::unexpected(reader.error());
    return ReplayInput(std::move(*reader));
  }
  Expected<EventLogReader> reader = EventLogReader::open(path, std::move(wanted));
  if (!reader) return tl::unexpected(reader.error());
  return ReplayInput(std::move(*reader));
}

}  // namespace buoyancy::service
