// One HTTP request and its response on a socket. The header of a request is read completely, within limits,
// before it is parsed; what follows it is never read. The connection is dropped if the peer does not read
// what was written in time, even while the kernel still has room to buffer it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace buoyancy::view {

class RequestStream {
 public:
  struct Limits {
    std::size_t max_header_bytes;
    std::chrono::duration<double> header_timeout;
    std::chrono::duration<double> write_timeout;  // per chunk
  };
  enum class HeaderResult { kComplete, kEmpty, kTooLarge, kTooSlow };

  // The caller keeps the socket. stopping: if set, no wait continues; must outlive the stream.
  RequestStream(int socket, const Limits& limits, const std::atomic<bool>& stopping)
      : socket_(socket), limits_(limits), stopping_(stopping) {}

  // Also returns kComplete if the peer closes in the middle of the header.
  HeaderResult read_header();
  const std::string& header() const { return header_; }  // with what the peer has sent after it so far
  // False: the peer has gone or does not read; the response cannot be continued.
  bool write(std::string_view bytes);
  bool has_written() const { return written_ > 0; }
  // Ends the response and lets the peer read the rest of it before the caller closes the socket.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  // True if the peer has read everything, or something within write_timeout.
  bool peer_is_reading();
  // Waits for events of poll(). False: the deadline has passed, or stopping is set.
  bool wait_for(short events, Clock::time_point deadline) const;
  static Clock::time_point deadline_after(std::chrono::duration<double> timeout) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
  }

  int socket_;
  Limits limits_;
  const std::atomic<bool>& stopping_;
  std::string header_;
  std::size_t written_ = 0;
  std::size_t acknowledged_ = 0;  // bytes of written_, when the peer last acknowledged some
  Clock::time_point acknowledged_at_;
};

}  // namespace buoyancy::view
