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

tl::unexpected<Error> write_error(const std::filesystem::path& path, int error) {
  std::string cause;
  std::string hint;
  if (error == ENOSPC || error == EDQUOT) {
    cause = "the disk is full";
    hint = "Free some space, or write to another disk";
  }
  if (error == ENOENT) {
    cause = "the directory does not exist";
    hint = "Create the directory first";
  }
  return make_error({path.string(), "could not be written (" + std::generic_category().message(error) + ")",
                     "a writable file", std::move(cause), std::move(hint)});
}

tl::unexpected<Error> stalled_reader(const std::filesystem::path& path) {
  return make_error({path.string(), "is full, and its reader has stalled since the termination signal",
                     "a reader that keeps reading", "",
                     "Write to a regular file, or keep the reader running"});
}

}  // namespace

Expected<RecordWriter> RecordWriter::create(const std::filesystem::path& path) {
  UniqueFd file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kPermissions));
  if (!file.valid()) return write_error(path, errno);
  struct stat status {};
  if (::fstat(file.value(), &status) != 0) return write_error(path, errno);
  // Pipes and terminals block in poll() instead of write(), so that a signal can end the wait. The flag
  // applies to this open file description only, not to other openings of the same pipe.
  if (!S_ISREG(status.st_mode) && ::fcntl(file.value(), F_SETFL, O_NONBLOCK) != 0) {
    return write_error(path, errno);
  }
  return RecordWriter(path, std::move(file), S_ISFIFO(status.st_mode));
}

Expected<RecordWriter> RecordWriter::create(const StagedFile& staged) {
  UniqueFd file = staged.duplicate();
  if (!file.valid() || ::ftruncate(file.value(), 0) != 0) return write_error(staged.temporary(), errno);
  return RecordWriter(staged.temporary(), std::move(file), false);
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

Expected<void> RecordWriter::append(std::string_view record) {
  return append(Bytes(reinterpret_cast<const std::uint8_t*>(record.data()), record.size()));
}

Expected<void> RecordWriter::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t wrote = ::write(file_.value(), buffer_.data() + done, end_of_write(done) - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) {
      const int error = errno;
      if (error == EAGAIN && wait_until_writable()) continue;
      const auto past = std::upper_bound(record_ends_.begin(), record_ends_.end(), done);
      const std::size_t whole = past == record_ends_.begin() ? 0 : *(past - 1);
      // Fails for devices and pipes, which cannot be truncated; the error below is reported instead.
      [[maybe_unused]] const int truncated =
          ::ftruncate(file_.value(), written_ + static_cast<std::int64_t>(whole));
      buffer_.clear();
      record_ends_.clear();
      return error == EAGAIN ? stalled_reader(path_) : write_error(path_, error);
    }
    done += static_cast<std::size_t>(wrote);
  }
  written_ += static_cast<std::int64_t>(done);
  buffer_.clear();
  record_ends_.clear();
  return {};
}

// A write of up to PIPE_BUF bytes to a pipe is atomic, so that as many complete records as fit into it are
// written at once. A larger record is written alone, as far as there is room for it.
std::size_t RecordWriter::end_of_write(std::size_t begin) const {
  if (!is_pipe_) return buffer_.size();
  const auto too_far = std::upper_bound(record_ends_.begin(), record_ends_.end(), begin + PIPE_BUF);
  const std::size_t whole = too_far == record_ends_.begin() ? 0 : *(too_far - 1);
  return whole > begin ? whole : *too_far;
}

// Returns false if the reader stalled.
bool RecordWriter::wait_until_writable() {
  while (true) {
    std::array<pollfd, 2> waiting{pollfd{file_.value(), POLLOUT, 0}, pollfd{signal_, POLLIN, 0}};
    int timeout_ms = -1;
    if (deadline_) {
      waiting[1].fd = -1;  // already observed; it would stay readable
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
