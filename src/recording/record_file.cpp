#include "recording/record_file.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>

namespace buoyancy {
namespace {

constexpr std::size_t kBufferBytes = 1'048'576;
constexpr unsigned kPermissions = 0666;  // before the umask

tl::unexpected<Error> not_written(const std::filesystem::path& path, int error) {
  std::string cause;
  if (error == ENOSPC || error == EDQUOT) cause = "the disk is full";
  if (error == ENOENT) cause = "the directory does not exist";
  return failure({path.string(), "could not be written (" + std::generic_category().message(error) + ")",
                  "a writable file", std::move(cause), ""});
}

}  // namespace

Expected<RecordFile> RecordFile::create(const std::filesystem::path& path) {
  FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kPermissions));
  if (!file.valid()) return not_written(path, errno);
  return RecordFile(path, std::move(file));
}

RecordFile::RecordFile(std::filesystem::path path, FileDescriptor file)
    : path_(std::move(path)), file_(std::move(file)) {}

Expected<void> RecordFile::append(Bytes record) {
  if (buffer_.size() + record.size() > kBufferBytes && !buffer_.empty()) {
    if (Expected<void> flushed = flush(); !flushed) return flushed;
  }
  buffer_.insert(buffer_.end(), record.begin(), record.end());
  record_ends_.push_back(buffer_.size());
  return {};
}

Expected<void> RecordFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t wrote = ::write(file_.value(), buffer_.data() + done, buffer_.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) {
      const int error = errno;
      const auto past = std::upper_bound(record_ends_.begin(), record_ends_.end(), done);
      const std::size_t whole = past == record_ends_.begin() ? 0 : *(past - 1);
      // Fails for devices and pipes, which cannot be cut back: the error below is what counts.
      [[maybe_unused]] const int cut =
          ::ftruncate(file_.value(), written_ + static_cast<std::int64_t>(whole));
      buffer_.clear();
      record_ends_.clear();
      return not_written(path_, error);
    }
    done += static_cast<std::size_t>(wrote);
  }
  written_ += static_cast<std::int64_t>(done);
  buffer_.clear();
  record_ends_.clear();
  return {};
}

}  // namespace buoyancy
