#include "recording/staged_file.h"

#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

namespace buoyancy {
namespace {

constexpr unsigned kPermissions = 0666;  // before the umask

tl::unexpected<Error> file_error(const std::filesystem::path& path, const char* what, int error) {
  return make_error({path.string(), std::string(what) + " (" + std::generic_category().message(error) + ")",
                     "a writable file in a writable directory", "", ""});
}

bool is_own_regular_file(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink <= 1;
}

// Returns whether the name still belongs to this open file: another process may have renamed it meanwhile.
bool is_name_of(const std::filesystem::path& path, int file) {
  struct stat named {};
  struct stat opened {};
  return ::lstat(path.c_str(), &named) == 0 && ::fstat(file, &opened) == 0 && named.st_dev == opened.st_dev &&
         named.st_ino == opened.st_ino;
}

}  // namespace

Expected<StagedFile> StagedFile::create(const std::filesystem::path& path) {
  std::error_code no_such_file;
  if (std::filesystem::exists(path, no_such_file) && !std::filesystem::is_regular_file(path, no_such_file)) {
    return make_error({path.string(), "is not a regular file", "the name of a regular file",
                       "the output is renamed when it is complete, which a pipe or device cannot be", ""});
  }
  std::filesystem::path temporary = temporary_name(path);
  while (true) {
    constexpr int kFlags = O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;  // a pipe is then opened at once
    UniqueFd file(::open(temporary.c_str(), kFlags | O_CREAT | O_EXCL, kPermissions));
    if (!file.valid() && errno == EEXIST) {
      file = UniqueFd(::open(temporary.c_str(), kFlags));
      if (!file.valid() && errno == ENOENT) continue;  // renamed or removed meanwhile
      if (!file.valid() ? errno == ELOOP || errno == ENXIO : !is_own_regular_file(file.value())) {
        return make_error({temporary.string(), "is a link, or not a regular file", "a name that is free",
                           "writing it would overwrite another file", "Remove it, or choose another output"});
      }
    }
    if (!file.valid()) return file_error(temporary, "could not be created", errno);
    if (::flock(file.value(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      return make_error({temporary.string(), "is being written by another process",
                         "one process per output at a time", "the same part was started twice",
                         "Wait for the other process, or end it"});
    }
    if (is_name_of(temporary, file.value())) return StagedFile(path, std::move(temporary), std::move(file));
  }
}

StagedFile::~StagedFile() {
  if (file_.valid()) ::unlink(temporary_.c_str());
}

Expected<void> StagedFile::commit() {
  if (::fsync(file_.value()) != 0) return file_error(temporary_, "could not be written", errno);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    return file_error(path_, "could not be renamed from its temporary name", errno);
  }
  file_.close();
  return {};
}

}  // namespace buoyancy
