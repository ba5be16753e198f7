// An output file that always ends at the end of a record: if the disk fills up within a record, the file is
// truncated to the last complete record. A pipe cannot be truncated: it receives complete records as far as
// they fit into PIPE_BUF, and can end within a record only if that record is larger.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/unique_fd.h"
#include "messages/wire.h"
#include "recording/staged_file.h"

namespace buoyancy {

class RecordWriter {
 public:
  // The time that a pipe's reader may stall after the signal of give_up_after().
  static constexpr std::chrono::seconds kGrace{1};

  // Creates or truncates the file. Blocks until a named pipe has a reader. Errors: the file cannot be
  // written.
  static Expected<RecordWriter> create(const std::filesystem::path& path);
  // Truncates the temporary file and writes it. Errors: the file cannot be written.
  static Expected<RecordWriter> create(const StagedFile& staged);

  // signal: a descriptor that becomes readable, such as a signalfd. Once it is readable, a write to a full
  // pipe or terminal fails after kGrace, counted from the first such write.
  void give_up_after(int signal) { signal_ = signal; }

  // Records are buffered, so that an error may concern an earlier one. After an error the writer must not be
  // used further. Errors: disk full, the file or its reader is gone, a stalled reader (see give_up_after()).
  Expected<void> append(Bytes record);
  Expected<void> append(std::string_view record);

  // Writes the buffered records. Errors: see append().
  Expected<void> flush();

 private:
  using Clock = std::chrono::steady_clock;

  RecordWriter(std::filesystem::path path, UniqueFd file, bool is_pipe);
  std::size_t end_of_write(std::size_t begin) const;
  bool wait_until_writable();

  std::filesystem::path path_;
  UniqueFd file_;
  bool is_pipe_;
  int signal_ = -1;                            // see give_up_after(); -1: none
  std::optional<Clock::time_point> deadline_;  // set once the signal was observed
  std::int64_t written_ = 0;                   // bytes in the file; ends at a record's end
  std::vector<std::uint8_t> buffer_;           // records not yet written
  std::vector<std::size_t> record_ends_;       // offsets in buffer_
};

}  // namespace buoyancy
