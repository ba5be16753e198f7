// Builds logs as lcm-logger records them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recording/event_log.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {

class RecordedLog {
 public:
  void add(std::int64_t timestamp, std::string_view channel, Bytes data) {
    std::vector<std::uint8_t> event;
    encode_event(events_++, timestamp, channel, data, event);
    text_.append(event.begin(), event.end());
  }

  std::int64_t events() const { return events_; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::int64_t events_ = 0;
};

}  // namespace buoyancy
