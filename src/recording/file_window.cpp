#include "recording/file_window.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>

namespace buoyancy {
namespace {

tl::unexpected<Error> unreadable(const std::filesystem::path& path, int error) {
  return make_error({path.string(), std::generic_category().message(error), "a readable file", "", ""});
}

Error broken_off_at(const std::filesystem::path& path, std::int64_t offset, int error) {
  const std::string byte = std::to_string(offset);
  if (error == 0) {
    return {path.string(), "ends at byte " + byte, "the bytes that it had when it was opened",
            "it was truncated or replaced while it was read", "Read it again when it is complete"};
  }
  return {path.string(),
          "cannot be read from byte " + byte + " on: " + std::generic_category().message(error),
          "a readable file", "the disk or the network failed", ""};
}

}  // namespace

Expected<FileWindow> FileWindow::open(const std::filesystem::path& path) {
  UniqueFd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) return unreadable(path, errno);
  struct stat status {};
  if (::fstat(file.value(), &status) != 0) return unreadable(path, errno);
  if (!S_ISREG(status.st_mode)) {
    return make_error({path.string(), S_ISDIR(status.st_mode) ? "is a directory" : "is not a regular file",
                       "a regular file", "", ""});
  }
  return FileWindow(path, std::move(file), status.st_size, kReadAhead);
}

FileWindow::FileWindow(std::filesystem::path path, UniqueFd file, std::int64_t size, std::size_t read_ahead)
    : path_(std::move(path)), file_(std::move(file)), size_(size), read_ahead_(read_ahead) {}

Expected<FileWindow> FileWindow::duplicate(std::size_t read_ahead) const {
  UniqueFd file(::fcntl(file_.value(), F_DUPFD_CLOEXEC, 0));
  if (!file.valid()) return unreadable(path_, errno);
  return FileWindow(path_, std::move(file), size_, read_ahead);
}

Bytes FileWindow::read_at(std::int64_t offset, std::size_t count) {
  assert(offset >= 0);
  if (offset >= size_ || broken_off()) return {};
  const auto left = static_cast<std::uint64_t>(size_ - offset);
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
  const auto window_end = start_ + static_cast<std::int64_t>(window_.size());
  if (offset < start_ || offset + static_cast<std::int64_t>(count) > window_end) {
    stopped_ = stop_ && stop_();
    if (stopped_) return {};
    start_ = offset;
    window_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(std::max(count, read_ahead_), left)));
    std::size_t filled = 0;
    while (filled < window_.size()) {
      const ssize_t got = ::pread(file_.value(), window_.data() + filled, window_.size() - filled,
                                  offset + static_cast<std::int64_t>(filled));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {  // what was read ahead may suffice
        if (filled < count) {
          const auto from = offset + static_cast<std::int64_t>(filled);
          read_error_ = broken_off_at(path_, from, got < 0 ? errno : 0);
        }
        break;
      }
      filled += static_cast<std::size_t>(got);
    }
    window_.resize(filled);
  }
  return Bytes(window_).subspan(std::min(static_cast<std::size_t>(offset - start_), window_.size()));
}

Bytes FileWindow::buffered(std::int64_t offset) const {
  const auto end = start_ + static_cast<std::int64_t>(window_.size());
  if (offset < start_ || offset >= end) return {};
  return Bytes(window_).subspan(static_cast<std::size_t>(offset - start_));
}

}  // namespace buoyancy
