#include "recording/record_writer.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>

namespace buoyancy {
namespace {

constexpr std::size_t kBufferBytes = 1'048'576;
constexpr unsigned kPermissions = 0666;  // before the umask

tl::unexpected<Error> not_written(const std::filesystem::path& path, int error) {
  std::string cause;
  if (error == ENOSPC || error == EDQUOT) cause = "the disk is full";
  if (error == ENOENT) cause = "the directory does not exist";
  return make_error({path.string(), "could not be written (" + std::generic_category().message(error) + ")",
                     "a writable file", std::move(cause), ""});
}

tl::unexpected<Error> given_up(const std::filesystem::path& path) {
  return make_error({path.string(), "is full, and nobody has read from it since the signal to end",
                     "a reader that makes room", "", ""});
}

}  // namespace

Expected<RecordWriter> RecordWriter::create(const std::filesystem::path& path) {
  UniqueFd file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kPermissions));
  if (!file.valid()) return not_written(path, errno);
  struct stat status {};
  if (::fstat(file.value(), &status) != 0) return not_written(path, errno);
  // What may wait for a reader waits in poll() instead of write(), where a signal can end it. The flag is of
  // this opening alone, not of others of the same pipe.
  if (!S_ISREG(status.st_mode) && ::fcntl(file.value(), F_SETFL, O_NONBLOCK) != 0) {
    return not_written(path, errno);
  }
  return RecordWriter(path, std::move(file), S_ISFIFO(status.st_mode));
}

RecordWriter::RecordWriter(std::filesystem::path path, UniqueFd file, bool is_pipe)
    : path_(std::move(path)), file_(std::move(file)), is_pipe_(is_pipe) {}

Expected<void> RecordWriter::append(Bytes record) {
  if (buffer_.size() + record.size() > kBufferBytes && !buffer_.empty()) {
    if (Expected<void> flushed = flush(); !flushed) return flushed;
  }
  buffer_.insert(buffer_.end(), record.begin(), record.end());
  record_ends_.push_back(buffer_.size());
  return {};
}

Expected<void> RecordWriter::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t wrote = ::write(file_.value(), buffer_.data() + done, end_of_write(done) - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) {
      const int error = errno;
      if (error == EAGAIN && wait_for_room()) continue;
      const auto past = std::upper_bound(record_ends_.begin(), record_ends_.end(), done);
      const std::size_t whole = past == record_ends_.begin() ? 0 : *(past - 1);
      // Fails for devices and pipes, which cannot be cut back: the error below is what counts.
      [[maybe_unused]] const int cut =
          ::ftruncate(file_.value(), written_ + static_cast<std::int64_t>(whole));
      buffer_.clear();
      record_ends_.clear();
      return error == EAGAIN ? given_up(path_) : not_written(path_, error);
    }
    done += static_cast<std::size_t>(wrote);
  }
  written_ += static_cast<std::int64_t>(done);
  buffer_.clear();
  record_ends_.clear();
  return {};
}

// A pipe takes up to PIPE_BUF bytes whole or not at all: so many whole records are written at once, and of a
// larger one as much as there is room for.
std::size_t RecordWriter::end_of_write(std::size_t begin) const {
  if (!is_pipe_) return buffer_.size();
  const auto too_far = std::upper_bound(record_ends_.begin(), record_ends_.end(), begin + PIPE_BUF);
  const std::size_t whole = too_far == record_ends_.begin() ? 0 : *(too_far - 1);
  return whole > begin ? whole : *too_far;
}

// False: given up.
bool RecordWriter::wait_for_room() {
  while (true) {
    std::array<pollfd, 2> waiting{pollfd{file_.value(), POLLOUT, 0}, pollfd{signal_, POLLIN, 0}};
    int timeout_ms = -1;
    if (deadline_) {
      waiting[1].fd = -1;  // seen: it stays readable
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(*deadline_ - Clock::now());
      timeout_ms = static_cast<int>(std::max<std::int64_t>(left.count(), 0));
    }
    const int ready = ::poll(waiting.data(), waiting.size(), timeout_ms);
    if (ready < 0 && errno == EINTR) continue;
    if (waiting[0].revents != 0) return true;
    if (ready <= 0) return false;
    deadline_ = Clock::now() + kGrace;
  }
}

}  // namespace buoyancy
