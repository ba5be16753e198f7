// The input of a replay: recorded messages from an LCM log, or requests from CSV, and a description of each
// section that could not be read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <variant>

#include "base/error.h"
#include "messages/wire.h"
#include "recording/event_log.h"
#include "recording/state_csv.h"

namespace buoyancy::service {

enum class FileFormat { kCsv, kLcmLog };

class ReplayInput {
 public:
  // wanted: the channels to read from a log. Errors: not readable, an invalid CSV header.
  static Expected<ReplayInput> open(const std::filesystem::path& path, FileFormat format,
                                    ChannelFilter wanted);

  LogItem next() {
    return std::visit([](auto& reader) { return reader.next(); }, reader_);
  }
  std::int64_t offset() const {
    return std::visit([](const auto& reader) { return reader.offset(); }, reader_);
  }
  std::int64_t size() const {
    return std::visit([](const auto& reader) { return reader.size(); }, reader_);
  }

 private:
  using Reader = std::variant<EventLogReader, StateCsvReader>;
  explicit ReplayInput(Reader reader) : reader_(std::move(reader)) {}
  Reader reader_;
};

}  // namespace buoyancy::service
