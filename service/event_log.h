// LCM log files, as lcm-logger writes them: events one after the other, each
//   int32 0xEDA1DA01; int64 number; int64 timestamp (us); int32 channel's length; int32 data's length;
//   the channel, not terminated; the data                                   (all big-endian)
//
// Read here and not through liblcm, whose reader loses the good event before a damage, takes a damaged length
// for an order to allocate and to skip the rest of the file, and cannot tell the end from a damage. The law
// here: an event counts if it is followed by another one's header or by the end of the file, or if it is a
// valid question; whatever else stands in the file is skipped up to the next such event and reported.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/error.h"
#include "messages/wire.h"
#include "service/input_item.h"
#include "service/input_window.h"

namespace buoyancy {

class EventLogReader {
 public:
  // Reads the questions on states_channel; events of other channels are passed over.
  static Expected<EventLogReader> open(const std::filesystem::path& path, const std::string& states_channel);

  InputItem next();
  std::int64_t offset() const { return offset_; }  // bytes read
  std::int64_t size() const { return file_.size(); }

 private:
  struct Frame {
    std::int64_t timestamp = 0;
    bool ours = false;           // on states_channel
    std::size_t data_start = 0;  // from the event's start
    std::size_t data_size = 0;
    std::int64_t next = 0;  // the file's offset after the event
  };

  EventLogReader(InputWindow file, std::string states_channel);
  tl::expected<Frame, std::string> frame_at(std::int64_t offset);  // or what is wrong with it
  bool header_or_end_at(std::int64_t offset);
  Damage skip_damage(const std::string& reason);

  InputWindow file_;
  std::string states_channel_;
  std::int64_t offset_ = 0;
};

// Replaces bytes by an event as above.
void encode_event(std::int64_t number, std::int64_t timestamp, std::string_view channel, Bytes data,
                  std::vector<std::uint8_t>& bytes);

}  // namespace buoyancy
