// One thing that a reader of recorded questions found.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "messages/wire.h"

namespace buoyancy {

struct RecordedQuestion {
  std::int64_t timestamp = 0;  // us: of the log's event; of CSV the rows' utime
  Bytes bytes;                 // valid until the reader is asked again; not yet validated
};
struct Damage {
  std::string description;  // what could not be read, where, and how much of it was skipped
};
struct EndOfInput {};

using InputItem = std::variant<RecordedQuestion, Damage, EndOfInput>;

}  // namespace buoyancy
