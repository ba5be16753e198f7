// One request and its response on a socket, with bounds that httplib's own stream does not have: a request's
// head is read whole, within limits, before httplib sees it, and what follows it is never read. A chunk that
// is written is taken within its time or the connection is given up, also where the kernel has room for many
// chunks that nobody reads.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>

#include <httplib.h>

namespace buoyancy {

class RequestStream : public httplib::Stream {
 public:
  struct Limits {
    std::size_t max_header_bytes;
    std::chrono::duration<double> head, chunk;
  };
  enum class Head { kRead, kNothing, kTooLarge, kTooSlow };

  // socket: stays the caller's. ending: set when nobody is to be waited for any more; must live as long.
  RequestStream(socket_t socket, const Limits& limits, const std::atomic<bool>& ending)
      : socket_(socket), limits_(limits), ending_(ending) {}

  // kRead also where the peer ended before its head did: httplib finds out what is missing.
  Head read_head();
  // Ends the response, and lets the peer read what was written before the socket is closed.
  void finish();

  bool is_readable() const override { return read_ < head_.size(); }
  bool is_writable() const override;
  ssize_t read(char* to, std::size_t size) override;           // 0 after the head
  ssize_t write(const char* from, std::size_t size) override;  // all of it, or -1
  using Stream::write;
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  // Has the peer taken something within its time, or nothing to take?
  bool is_taking();
  // Waits for events of poll(); false: not before the deadline, or all is ending.
  bool wait_for(short events, Clock::time_point deadline) const;
  static Clock::time_point in(std::chrono::duration<double> patience) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(patience);
  }

  socket_t socket_;
  Limits limits_;
  const std::atomic<bool>& ending_;
  std::string head_;
  std::size_t read_ = 0;
  std::size_t written_ = 0;
  std::size_t taken_ = 0;  // of what was written, when the peer last took something
  Clock::time_point taken_at_;
};

}  // namespace buoyancy
