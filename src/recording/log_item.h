// What a reader of recorded messages returns: an event, a corrupt section or the end.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "messages/wire.h"

namespace buoyancy {

struct RecordedEvent {
  std::int64_t timestamp = 0;  // log: of the event; CSV: utime of the rows [us]
  std::string_view channel;    // log: of the event; CSV: empty, the event is a request
  Bytes bytes;                 // not yet validated
  // Both views are valid until the reader's next call.
};
struct CorruptSection {
  std::string description;  // what could not be read, where, and how much was skipped
};
struct EndOfLog {};

using LogItem = std::variant<RecordedEvent, CorruptSection, EndOfLog>;

}  // namespace buoyancy
