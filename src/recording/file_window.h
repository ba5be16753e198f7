// Reads a file of any size at any offset, through a window of bounded size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/unique_fd.h"
#include "messages/wire.h"

namespace buoyancy {

class FileWindow {
 public:
  // Errors: no such file, not a regular file, not readable.
  static Expected<FileWindow> open(const std::filesystem::path& path);

  // Returns the bytes from offset on: at least `count`, or all that are left of the file. Valid until the
  // next call. Memory: the largest count requested, or 1 MB.
  Bytes read_at(std::int64_t offset, std::size_t count);

  // The file's size when it was opened; bytes appended later are not read.
  std::int64_t size() const { return size_; }
  // Set once read_at() returned fewer bytes than it should have.
  const std::optional<Error>& read_error() const { return read_error_; }

 private:
  FileWindow(std::filesystem::path path, UniqueFd file, std::int64_t size);

  std::filesystem::path path_;
  UniqueFd file_;
  std::int64_t size_;
  std::int64_t start_ = 0;  // offset of the window in the file
  std::vector<std::uint8_t> window_;
  std::optional<Error> read_error_;
};

}  // namespace buoyancy
