// One HTTP request and its response on a socket, with limits that httplib's own stream does not have. The
// header of a request is read completely, within limits, before httplib parses it; what follows it is never
// read. The connection is dropped if the peer does not read what was written in time, even while the kernel
// still has room to buffer it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>

#include <httplib.h>

namespace buoyancy::view {

class RequestStream : public httplib::Stream {
 public:
  struct Limits {
    std::size_t max_header_bytes;
    std::chrono::duration<double> header_timeout;
    std::chrono::duration<double> write_timeout;  // per chunk
  };
  enum class HeaderResult { kComplete, kEmpty, kTooLarge, kTooSlow };

  // The caller keeps the socket. stopping: if set, no wait continues; must outlive the stream.
  RequestStream(socket_t socket, const Limits& limits, const std::atomic<bool>& stopping)
      : socket_(socket), limits_(limits), stopping_(stopping) {}

  // Also returns kComplete if the peer closes in the middle of the header; httplib then rejects it.
  HeaderResult read_header();
  // Ends the response and lets the peer read the rest of it before the caller closes the socket.
  void finish();

  bool is_readable() const override { return read_ < header_.size(); }
  bool is_writable() const override;
  ssize_t read(char* to, std::size_t size) override;           // 0 after the header
  ssize_t write(const char* from, std::size_t size) override;  // size, or -1
  using Stream::write;
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  // True if the peer has read everything, or something within write_timeout.
  bool peer_is_reading();
  // Waits for events of poll(). False: the deadline has passed, or stopping is set.
  bool wait_for(short events, Clock::time_point deadline) const;
  static Clock::time_point deadline_after(std::chrono::duration<double> timeout) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
  }

  socket_t socket_;
  Limits limits_;
  const std::atomic<bool>& stopping_;
  std::string header_;
  std::size_t read_ = 0;
  std::size_t written_ = 0;
  std::size_t acknowledged_ = 0;  // bytes of written_, when the peer last acknowledged some
  Clock::time_point acknowledged_at_;
};

}  // namespace buoyancy::view
