// The input of a replay, or of a part of it: recorded messages from an LCM log, or requests from a table (CSV
// or the poses of another program), block by block (replay_part.h), and a description of each section that
// could not be read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "base/error.h"
#include "messages/wire.h"
#include "recording/event_log.h"
#include "recording/state_csv.h"
#include "service/replay/range_hash.h"
#include "service/replay/replay_part.h"

namespace buoyancy::service {

enum class FileFormat { kCsv, kLcmLog };

class ReplayInput {
 public:
  // wanted: the channels to read from a log. table: the format of what is no log. Errors: not readable, those
  // of StateCsvReader::open().
  static Expected<ReplayInput> open(const std::filesystem::path& path, FileFormat format,
                                    ChannelFilter wanted, const TableOptions& table = {});

  // Restricts the input to a part and hashes what it reads from then on; to be called before next(). start:
  // where the part before ended, if that is known; otherwise the events before the part are searched for it.
  // Errors: not readable.
  Expected<void> restrict_to(const Part& part, std::optional<std::int64_t> start);

  // Ends the input once stop() is true, also while nothing but damage is read.
  void stop_when(std::function<bool()> stop) { file().stop_when(std::move(stop)); }
  // LimitReached: the block has ended. EndOfLog: the input or the part has ended, or it was broken off.
  LogItem next();

  // For a progress bar: bytes read of the input or part, of about bytes_expected().
  std::int64_t bytes_read() const { return position() - begin_; }
  std::int64_t bytes_expected() const;

  std::int64_t size() const { return file().size(); }  // of the file [bytes]
  FileFormat format() const {
    return std::holds_alternative<StateCsvReader>(reader_) ? FileFormat::kCsv : FileFormat::kLcmLog;
  }
  // Can its requests have velocities? False only for a table without their columns.
  bool states_velocities() const {
    const auto* csv = std::get_if<StateCsvReader>(&reader_);
    return csv == nullptr || csv->states_velocities();
  }
  // The layout and the body of another program's poses; nullptr and nullopt: the input has none.
  const PoseTable* table() const {
    const auto* csv = std::get_if<StateCsvReader>(&reader_);
    return csv == nullptr ? nullptr : csv->table();
  }
  std::optional<std::int32_t> body() const {
    if (table() == nullptr) return std::nullopt;
    return std::get<StateCsvReader>(reader_).body();
  }
  void set_body(std::int32_t id) {
    if (auto* csv = std::get_if<StateCsvReader>(&reader_)) csv->set_body(id);
  }
  bool stopped() const { return file().stopped(); }  // by stop_when()
  const std::optional<Error>& read_error() const { return file().read_error(); }

  // The range of bytes that was read [bytes], from begin() to before position(). The first part begins at 0.
  std::int64_t begin() const { return begin_; }
  std::int64_t position() const {
    return std::visit([](const auto& reader) { return reader.position(); }, reader_);
  }
  // The hash of that range; only of a part. Errors: bytes of the input could not be read.
  Expected<std::string> hash();

 private:
  using Reader = std::variant<EventLogReader, StateCsvReader>;
  explicit ReplayInput(Reader reader);

  const FileWindow& file() const {
    return std::visit([](const auto& reader) -> const FileWindow& { return reader.file(); }, reader_);
  }
  FileWindow& file() {
    return std::visit([](auto& reader) -> FileWindow& { return reader.file(); }, reader_);
  }
  void update_hash();
  bool reached(std::int64_t limit) const {
    return std::visit([limit](const auto& reader) { return reader.reached(limit); }, reader_);
  }

  Reader reader_;
  std::int64_t block_size_;
  std::int64_t block_end_;
  std::int64_t begin_ = 0;
  std::int64_t end_ = kNoLimit;  // of the last block
  std::optional<RangeHash> hash_;
  std::optional<Error> hash_error_;
};

}  // namespace buoyancy::service
