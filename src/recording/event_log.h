// Reads and encodes LCM log files in the format of lcm-logger: a sequence of events, each
//   int32 0xEDA1DA01; int64 number; int64 timestamp [us]; int32 channel length; int32 data length;
//   the channel, not terminated; the data                                   (all big-endian)
//
// liblcm's own reader is not used: it loses the intact event before a corrupt section, allocates and skips as
// many bytes as a corrupt length states, and does not distinguish corruption from the end of the file.
// Contract of this reader: an event is valid if the header of another event or the end of the file follows
// it, or if it is a valid request or pose; anything else is skipped up to the next such event and reported.
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

// Returns whether the events of a channel are wanted. Called for every event of a log.
using ChannelFilter = std::function<bool(std::string_view channel)>;
ChannelFilter only_channel(std::string channel);

class EventLogReader {
 public:
  // Reads the events of the wanted channels and skips the others.
  static Expected<EventLogReader> open(const std::filesystem::path& path, ChannelFilter wanted);

  LogItem next();
  std::int64_t offset() const { return offset_; }  // read so far [bytes]
  std::int64_t size() const { return file_.size(); }

 private:
  struct Frame {
    std::int64_t timestamp = 0;
    bool wanted = false;
    std::size_t data_start = 0;  // offset from the event's start
    std::size_t data_size = 0;
    std::int64_t next = 0;  // file offset after the event
  };

  EventLogReader(FileWindow file, ChannelFilter wanted);
  tl::expected<Frame, std::string> frame_at(std::int64_t offset);  // or the reason why it is invalid
  bool header_or_end_at(std::int64_t offset);
  CorruptSection skip_corrupt_section(const std::string& reason);

  FileWindow file_;
  ChannelFilter wanted_;
  std::int64_t offset_ = 0;
};

// Replaces bytes by an encoded event.
void encode_event(std::int64_t number, std::int64_t timestamp, std::string_view channel, Bytes data,
                  std::vector<std::uint8_t>& bytes);

// Changes the number of an encoded event.
void renumber_event(std::int64_t number, std::span<std::uint8_t> event);

}  // namespace buoyancy
