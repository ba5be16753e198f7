#include "recording/file_window.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>

namespace buoyancy {
namespace {

tl::unexpected<Error> unreadable(const std::filesystem::path& path, int error) {
  return make_error({path.string(), std::generic_category().message(error), "a readable file", "", ""});
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
  if (offset >= size_) return {};
  const auto left = static_cast<std::uint64_t>(size_ - offset);
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
  const auto window_end = start_ + static_cast<std::int64_t>(window_.size());
  if (offset < start_ || offset + static_cast<std::int64_t>(count) > window_end) {
    start_ = offset;
    window_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(std::max(count, read_ahead_), left)));
    std::size_t filled = 0;
    while (filled < window_.size()) {
      const ssize_t got = ::pread(file_.value(), window_.data() + filled, window_.size() - filled,
                                  offset + static_cast<std::int64_t>(filled));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        read_error_ = unreadable(path_, got < 0 ? errno : ESTALE).value();
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
