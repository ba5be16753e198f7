// What a reader of recorded messages returns: an event, a corrupt section, the limit or the end.
//
// A recording can be read in pieces. Every reader has
//   LogItem next(limit)     the next item, or LimitReached if a cut for `limit` comes first;
//   bool reached(limit)     whether that is so;
//   void seek(offset)       moves to the cut for `offset`;
//   position()              where the next item starts.
// Each reader defines its cuts (event_log.h, state_csv.h) such that a piece that is read up to the cut for an
// offset and a piece that is read from there on together hold the items of the whole recording.
#pragma once

#include <cstdint>
#include <limits>
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
struct LimitReached {};  // returned only if next() was called with a limit
struct EndOfLog {};      // or of what can be read of it: see FileWindow::broken_off()

using LogItem = std::variant<RecordedEvent, CorruptSection, LimitReached, EndOfLog>;

inline constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();

}  // namespace buoyancy
