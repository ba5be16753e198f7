// Hashes a range of a file whose end becomes known while it is read.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "base/error.h"
#include "recording/file_window.h"
#include "service/replay/content_hash.h"

namespace buoyancy::service {

class RangeHash {
 public:
  RangeHash(FileWindow file, std::int64_t begin) : file_(std::move(file)), end_(begin) {}

  // Extends the range up to `end`, which must not be smaller than before. Errors: the file is not readable
  // or has become shorter.
  Expected<void> extend_to(std::int64_t end);
  // The same, but takes what it can from the memory of a reader of this file.
  Expected<void> extend_to(std::int64_t end, const FileWindow& reader);

  std::int64_t end() const { return end_; }
  std::string hash() const { return hash_.text(); }

 private:
  FileWindow file_;
  std::int64_t end_;
  ContentHash hash_;
};

}  // namespace buoyancy::service
