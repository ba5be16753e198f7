// Reads a file of any size through a window of bounded size, at any offset.
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

  // The bytes from offset on: at least `count`, or all that are left of the file. Valid until the next call.
  // Memory: the largest count asked for, or 1 MB.
  Bytes at(std::int64_t offset, std::size_t count);

  std::int64_t size() const {
    return size_;
  }  // of the file when it was opened; what was added since is not read
  const std::optional<Error>& read_error() const { return read_error_; }  // at() then returned too little

 private:
  FileWindow(std::filesystem::path path, UniqueFd file, std::int64_t size);

  std::filesystem::path path_;
  UniqueFd file_;
  std::int64_t size_;
  std::int64_t start_ = 0;  // the window's offset in the file
  std::vector<std::uint8_t> window_;
  std::optional<Error> read_error_;
};

}  // namespace buoyancy
