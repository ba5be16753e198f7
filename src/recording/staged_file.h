// A file that appears under its name only when it is complete: it is written as "<name>.tmp", flushed to the
// disk and renamed. A process that is killed leaves at most the temporary file, which the next attempt
// overwrites.
#pragma once

#include <filesystem>
#include <utility>

#include <fcntl.h>

#include "base/error.h"
#include "base/unique_fd.h"

namespace buoyancy {

class StagedFile {
 public:
  // Creates the temporary file, or takes over a regular one with no other name that no process writes: the
  // file is locked while it is written. On a file system without locks two processes may write the same file
  // at the same time; whoever reads it must then detect that. Errors: not writable, path is no regular file,
  // its temporary name is a symbolic or hard link, another process writes it.
  static Expected<StagedFile> create(const std::filesystem::path& path);
  StagedFile(StagedFile&&) noexcept = default;
  StagedFile& operator=(StagedFile&&) = delete;
  ~StagedFile();  // removes the temporary file unless it was committed

  static std::filesystem::path temporary_name(std::filesystem::path path) { return path += ".tmp"; }
  const std::filesystem::path& temporary() const { return temporary_; }
  // Returns another descriptor of the temporary file; not valid if this process has too many.
  UniqueFd duplicate() const { return UniqueFd(::fcntl(file_.value(), F_DUPFD_CLOEXEC, 0)); }

  // Gives the file its name. Errors: the disk failed.
  Expected<void> commit();

 private:
  StagedFile(std::filesystem::path path, std::filesystem::path temporary, UniqueFd file)
      : path_(std::move(path)), temporary_(std::move(temporary)), file_(std::move(file)) {}

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  UniqueFd file_;  // holds the lock; not valid once committed or moved from
};

}  // namespace buoyancy
