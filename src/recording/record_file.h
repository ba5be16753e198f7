// An output file that ends at the end of a record, whatever happens: records are written whole and, where the
// disk is full in the middle of one, the file is cut back to the last whole record.
#pragma once

#include <filesystem>
#include <vector>

#include "geometry/error.h"
#include "geometry/file_descriptor.h"
#include "messages/wire.h"

namespace buoyancy {

class RecordFile {
 public:
  // Creates or empties the file. Errors: it cannot be written.
  static Expected<RecordFile> create(const std::filesystem::path& path);

  // Buffered: an error may be of an earlier record. After an error the file takes nothing more.
  // Errors: disk full, the file went away.
  Expected<void> append(Bytes record);

  // Writes what is buffered. Errors: as of append.
  Expected<void> flush();

 private:
  RecordFile(std::filesystem::path path, FileDescriptor file);

  std::filesystem::path path_;
  FileDescriptor file_;
  std::int64_t written_ = 0;              // bytes in the file; a record's end
  std::vector<std::uint8_t> buffer_;      // what follows
  std::vector<std::size_t> record_ends_;  // in buffer_
};

}  // namespace buoyancy
