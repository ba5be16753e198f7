// What an input holds: the channels of a log with their types, or the format of a table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "service/replay/replay_input.h"

namespace buoyancy::service {

struct ListedChannel {
  std::string channel;           // of a table "-"
  std::string type;              // see type_name(); of a table its format
  std::int64_t messages = 0;     // of a table: requests
  std::int64_t bytes = 0;        // of the messages; of a table: the file's size
  std::int64_t first_utime = 0;  // [us]; of a log the timestamp of the event
  std::int64_t last_utime = 0;
};

struct ChannelList {
  std::vector<ListedChannel> channels;  // sorted by name; one of several types is listed once for each
  std::int64_t others = 0;              // messages on further channels: a list has at most kMaxListedChannels
  std::int64_t corrupt_sections = 0;
};
inline constexpr std::size_t kMaxListedChannels = 1000;

// Reads the whole input. O(size). Errors: see ReplayInput::open(); not readable to its end.
Expected<ChannelList> list_channels(const std::filesystem::path& path, FileFormat format,
                                    const TableOptions& table);

std::string list_text(const ChannelList& list);
std::string list_json(const ChannelList& list);
// The first 20 channels in one line, for a message: "POSE (bot_core.pose_t), BUOYANCY_STATES (...) and 3
// more".
std::string list_line(const ChannelList& list);

}  // namespace buoyancy::service
