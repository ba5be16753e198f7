#include "view/live/request_stream.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace buoyancy {
namespace {

constexpr std::chrono::milliseconds kLongestSleep{100};  // an end is seen after so long
constexpr std::chrono::milliseconds kLinger{200};

bool is_whole(const std::string& head, std::size_t from) {
  from -= std::min<std::size_t>(from, 3);
  return head.find("\r\n\r\n", from) != std::string::npos || head.find("\n\n", from) != std::string::npos;
}

bool would_block() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

}  // namespace

bool RequestStream::wait_for(short events, Clock::time_point deadline) const {
  while (!ending_.load()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    pollfd waiting{socket_, events, 0};
    if (::poll(&waiting, 1, static_cast<int>(std::min(left, kLongestSleep).count())) > 0) return true;
  }
  return false;
}

RequestStream::Head RequestStream::read_head() {
  const auto deadline = in(limits_.head);
  std::array<char, 4096> part{};
  while (wait_for(POLLIN, deadline)) {
    const ssize_t size = ::recv(socket_, part.data(), part.size(), MSG_DONTWAIT);
    if (size < 0 && would_block()) continue;
    if (size <= 0) return head_.empty() ? Head::kNothing : Head::kRead;
    const std::size_t before = head_.size();
    head_.append(part.data(), static_cast<std::size_t>(size));
    if (is_whole(head_, before))
      return head_.size() <= limits_.max_header_bytes + part.size() ? Head::kRead : Head::kTooLarge;
    if (head_.size() > limits_.max_header_bytes) return Head::kTooLarge;
  }
  return head_.empty() ? Head::kNothing : Head::kTooSlow;
}

void RequestStream::finish() {
  // A socket closed while it holds unread bytes resets the connection, and the peer may lose the response.
  ::shutdown(socket_, SHUT_WR);
  const auto deadline = Clock::now() + kLinger;
  std::array<char, 4096> ignored{};
  while (wait_for(POLLIN, deadline)) {
    const ssize_t size = ::recv(socket_, ignored.data(), ignored.size(), MSG_DONTWAIT);
    if (size == 0 || (size < 0 && !would_block())) break;
  }
}

bool RequestStream::is_writable() const {
  return wait_for(POLLOUT, in(limits_.chunk));
}

ssize_t RequestStream::read(char* to, std::size_t size) {
  const std::size_t given = head_.copy(to, size, read_);
  read_ += given;
  return static_cast<ssize_t>(given);
}

bool RequestStream::is_taking() {
  int waiting = 0;
  if (::ioctl(socket_, SIOCOUTQ, &waiting) != 0) return false;
  const std::size_t taken = written_ - std::min(written_, static_cast<std::size_t>(waiting));
  const Clock::time_point now = Clock::now();
  if (taken == written_ || taken > taken_) {
    taken_ = taken;
    taken_at_ = now;
  }
  return now - taken_at_ <= limits_.chunk;
}

ssize_t RequestStream::write(const char* from, std::size_t size) {
  if (!is_taking()) return -1;
  const auto deadline = in(limits_.chunk);
  std::size_t sent = 0;
  while (sent < size) {
    const ssize_t part = ::send(socket_, from + sent, size - sent, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (part > 0) {
      sent += static_cast<std::size_t>(part);
      written_ += static_cast<std::size_t>(part);
    } else if (!would_block() || !wait_for(POLLOUT, deadline)) {
      return -1;
    }
  }
  return static_cast<ssize_t>(size);
}

}  // namespace buoyancy
