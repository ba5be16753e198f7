#include "view/live/request_stream.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace buoyancy::view {
namespace {

constexpr std::chrono::milliseconds kMaxPollTime{100};  // delay until stopping is noticed
constexpr std::chrono::milliseconds kLingerTime{200};

bool is_complete(const std::string& header, std::size_t from) {
  from -= std::min<std::size_t>(from, 3);
  return header.find("\r\n\r\n", from) != std::string::npos || header.find("\n\n", from) != std::string::npos;
}

bool would_block() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

}  // namespace

bool RequestStream::wait_for(short events, Clock::time_point deadline) const {
  while (!stopping_.load()) {
    const auto remaining = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (remaining.count() <= 0) return false;
    pollfd waiting{socket_, events, 0};
    if (::poll(&waiting, 1, static_cast<int>(std::min(remaining, kMaxPollTime).count())) > 0) return true;
  }
  return false;
}

RequestStream::HeaderResult RequestStream::read_header() {
  const auto deadline = deadline_after(limits_.header_timeout);
  std::array<char, 4096> part{};
  while (wait_for(POLLIN, deadline)) {
    const ssize_t size = ::recv(socket_, part.data(), part.size(), MSG_DONTWAIT);
    if (size < 0 && would_block()) continue;
    if (size <= 0) return header_.empty() ? HeaderResult::kEmpty : HeaderResult::kComplete;
    const std::size_t before = header_.size();
    header_.append(part.data(), static_cast<std::size_t>(size));
    if (is_complete(header_, before))
      return header_.size() <= limits_.max_header_bytes + part.size() ? HeaderResult::kComplete
                                                                      : HeaderResult::kTooLarge;
    if (header_.size() > limits_.max_header_bytes) return HeaderResult::kTooLarge;
  }
  return header_.empty() ? HeaderResult::kEmpty : HeaderResult::kTooSlow;
}

void RequestStream::finish() {
  // Closing a socket that holds unread bytes resets the connection, and the peer may lose the response.
  ::shutdown(socket_, SHUT_WR);
  const auto deadline = Clock::now() + kLingerTime;
  std::array<char, 4096> ignored{};
  while (wait_for(POLLIN, deadline)) {
    const ssize_t size = ::recv(socket_, ignored.data(), ignored.size(), MSG_DONTWAIT);
    if (size == 0 || (size < 0 && !would_block())) break;
  }
}

bool RequestStream::peer_is_reading() {
  int pending = 0;
  if (::ioctl(socket_, SIOCOUTQ, &pending) != 0) return false;
  const std::size_t acknowledged = written_ - std::min(written_, static_cast<std::size_t>(pending));
  const Clock::time_point now = Clock::now();
  if (acknowledged == written_ || acknowledged > acknowledged_) {
    acknowledged_ = acknowledged;
    acknowledged_at_ = now;
  }
  return now - acknowledged_at_ <= limits_.write_timeout;
}

bool RequestStream::write(std::string_view bytes) {
  if (!peer_is_reading()) return false;
  const auto deadline = deadline_after(limits_.write_timeout);
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
      written_ += static_cast<std::size_t>(sent);
    } else if (!would_block() || !wait_for(POLLOUT, deadline)) {
      return false;
    }
  }
  return true;
}

}  // namespace buoyancy::view
