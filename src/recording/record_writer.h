// An output file that ends at the end of a record, whatever happens: records are written whole and, where the
// disk is full in the middle of one, the file is cut back to the last whole record. A pipe cannot be cut
// back: it is given whole records as far as they fit PIPE_BUF, and ends within one only if that is larger.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/unique_fd.h"
#include "messages/wire.h"

namespace buoyancy {

class RecordWriter {
 public:
  // How long a reader that reads nothing is waited for after the signal of give_up_after().
  static constexpr std::chrono::seconds kGrace{1};

  // Creates or empties the file. Waits for the reader of a named pipe. Errors: it cannot be written.
  static Expected<RecordWriter> create(const std::filesystem::path& path);

  // signal: a descriptor that becomes readable, such as a signalfd. From kGrace after that on, counted from
  // the first time that there was no room in a pipe or terminal, nobody waits for its reader any more.
  void give_up_after(int signal) { signal_ = signal; }

  // Buffered: an error may be of an earlier record. After an error the file takes nothing more.
  // Errors: disk full, the file went away, given up as give_up_after() says.
  Expected<void> append(Bytes record);

  // Writes what is buffered. Errors: as of append.
  Expected<void> flush();

 private:
  using Clock = std::chrono::steady_clock;

  RecordWriter(std::filesystem::path path, UniqueFd file, bool is_pipe);
  std::size_t end_of_write(std::size_t begin) const;
  bool wait_for_room();

  std::filesystem::path path_;
  UniqueFd file_;
  bool is_pipe_;
  int signal_ = -1;                            // of give_up_after(); -1: none
  std::optional<Clock::time_point> deadline_;  // once it was seen
  std::int64_t written_ = 0;                   // bytes in the file; a record's end
  std::vector<std::uint8_t> buffer_;           // what follows
  std::vector<std::size_t> record_ends_;       // in buffer_
};

}  // namespace buoyancy
