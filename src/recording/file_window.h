// Reads a file of any size at any offset, through a window of bounded size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/unique_fd.h"
#include "messages/wire.h"

namespace buoyancy {

class FileWindow {
 public:
  // Errors: no such file, not a regular file, not readable.
  static Expected<FileWindow> open(const std::filesystem::path& path);

  // Returns another window on the same open file, which reads at least `read_ahead` bytes at a time. Errors:
  // the process has too many open files.
  Expected<FileWindow> duplicate(std::size_t read_ahead = kReadAhead) const;

  // Ends reading once stop() returns true. It is called before each read from the disk.
  void stop_when(std::function<bool()> stop) { stop_ = std::move(stop); }

  // Returns the bytes from offset on, valid until the next call: at least `count`, or all that are left of
  // the file; fewer or none if they cannot be read, and none from then on. The window takes as much memory as
  // the largest count requested, and at least the read-ahead (1 MB unless duplicate() sets it).
  Bytes read_at(std::int64_t offset, std::size_t count);
  // Returns the bytes from offset on that the last read_at() left in memory, perhaps none.
  Bytes buffered(std::int64_t offset) const;

  // The file's size when it was opened; bytes appended later are not read.
  std::int64_t size() const { return size_; }
  const std::filesystem::path& path() const { return path_; }
  // Set once read_at() returned fewer bytes than it should have: the disk failed, or the file was truncated.
  const std::optional<Error>& read_error() const { return read_error_; }
  bool stopped() const { return stopped_; }  // by stop_when()
  bool broken_off() const { return read_error_ || stopped_; }

 private:
  static constexpr std::size_t kReadAhead = 1'048'576;  // [bytes]

  FileWindow(std::filesystem::path path, UniqueFd file, std::int64_t size, std::size_t read_ahead);

  std::filesystem::path path_;
  UniqueFd file_;
  std::int64_t size_;
  std::size_t read_ahead_;  // [bytes]
  std::int64_t start_ = 0;  // offset of the window in the file
  std::vector<std::uint8_t> window_;
  std::optional<Error> read_error_;
  std::function<bool()> stop_;
  bool stopped_ = false;
};

}  // namespace buoyancy
