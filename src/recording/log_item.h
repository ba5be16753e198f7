// One thing that a reader of recorded messages found.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "messages/wire.h"

namespace buoyancy {

struct RecordedEvent {
  std::int64_t timestamp = 0;  // us: of the log's event; of CSV the rows' utime
  std::string_view channel;    // of the log's event; of CSV empty: a request
  Bytes bytes;                 // not yet validated
  // Both views are valid until the reader is asked again.
};
struct CorruptSection {
  std::string description;  // what could not be read, where, and how much of it was skipped
};
struct EndOfLog {};

using LogItem = std::variant<RecordedEvent, CorruptSection, EndOfLog>;

}  // namespace buoyancy
