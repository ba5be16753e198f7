// LCM log files, as lcm-logger writes them: events one after the other, each
//   int32 0xEDA1DA01; int64 number; int64 timestamp (us); int32 channel's length; int32 data's length;
//   the channel, not terminated; the data                                   (all big-endian)
//
// Read here and not through liblcm, whose reader loses the good event before a damage, takes a damaged length
// for an order to allocate and to skip the rest of the file, and cannot tell the end from a damage. The law
// here: an event counts if it is followed by another one's header or by the end of the file, or if it is a
// valid request or pose; whatever else stands in the file is skipped up to the next such event and reported.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "messages/wire.h"
#include "recording/file_window.h"
#include "recording/log_item.h"

namespace buoyancy {

// Is a channel's event wanted? Asked for every event of a log.
using ChannelFilter = std::function<bool(std::string_view channel)>;
ChannelFilter only_channel(std::string channel);

class EventLogReader {
 public:
  // Reads the events on the channels that are wanted; others are passed over.
  static Expected<EventLogReader> open(const std::filesystem::path& path, ChannelFilter wanted);

  LogItem next();
  std::int64_t offset() const { return offset_; }  // bytes read
  std::int64_t size() const { return file_.size(); }

 private:
  struct Frame {
    std::int64_t timestamp = 0;
    bool wanted = false;
    std::size_t data_start = 0;  // from the event's start
    std::size_t data_size = 0;
    std::int64_t next = 0;  // the file's offset after the event
  };

  EventLogReader(FileWindow file, ChannelFilter wanted);
  tl::expected<Frame, std::string> frame_at(std::int64_t offset);  // or what is wrong with it
  bool header_or_end_at(std::int64_t offset);
  CorruptSection skip_damage(const std::string& reason);

  FileWindow file_;
  ChannelFilter wanted_;
  std::int64_t offset_ = 0;
};

// Replaces bytes by an event as above.
void encode_event(std::int64_t number, std::int64_t timestamp, std::string_view channel, Bytes data,
                  std::vector<std::uint8_t>& bytes);

// Gives an encoded event another number.
void renumber_event(std::int64_t number, std::span<std::uint8_t> event);

}  // namespace buoyancy
