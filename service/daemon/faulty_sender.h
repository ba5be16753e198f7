// Sends the replies of a service with the faults that --inject asks for, and counts them.
//
// Delayed replies wait in a queue; nothing here sleeps. The caller waits for its messages for at most wait()
// and calls send_due(). The order of the replies is that of the times at which they are due, so that jitter
// alone may swap them too.
//
// - A reply that is reordered is held back until after the next reply that is sent, of any session, and is
//   not held back itself; after kMaxHold without one it is sent all the same.
// - During a stall nothing is sent, and the caller reads no requests: they wait in the receive buffer, as
//   they would for a process that hangs, and are answered after it.
// - At most kMaxWaiting replies with kMaxWaitingBytes wait. What exceeds that is sent before its time, the
//   earliest first: only what the options say is ever lost.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "messages/status.h"
#include "service/daemon/fault_injection.h"

namespace buoyancy::service {

// What the service sends for one request.
struct Reply {
  struct Message {
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Message> messages;  // the response first
  double arrival = 0.0;           // of the request [s], by the clock of FaultySender's `now`
};

class FaultySender {
 public:
  using Send = std::function<void(const Reply& reply)>;

  static constexpr double kMaxHold = 0.05;  // [s], half of the client library's default timeout
  static constexpr std::size_t kMaxWaiting = 4096;
  static constexpr std::size_t kMaxWaitingBytes = std::size_t{64} << 20U;

  // start: when the first period with a stall begins [s], by the same monotonic clock as all `now`.
  FaultySender(const FaultOptions& options, double start, Send send);

  // Draws the reply's fate, and sends it or keeps it for later.
  void push(Reply reply, double now);
  // Sends the replies that are due; none during a stall.
  void send_due(double now);
  // Sends all that wait, in the order in which they are due, also during a stall: for the end of the service.
  void send_all();

  bool is_stalled(double now) const { return service::is_stalled(options_, now - start_); }
  // How long the caller may wait until there is something to do: a reply is due or a stall ends [s];
  // infinity: nothing until the next push().
  double wait(double now) const;

  FaultCounters counters(double now) const;
  const FaultOptions& options() const { return options_; }

 private:
  struct Waiting {
    Reply reply;
    std::uint64_t ordinal = 0;
    std::size_t bytes = 0;
    bool duplicated = false;
    bool held = false;
  };
  using Queue = std::multimap<double, Waiting>;  // by the time at which they are due [s]

  void send(Queue::iterator position);  // and those that were held back until after it
  void send_one(Queue::iterator position);

  FaultOptions options_;
  double start_;
  Send send_;
  std::uint64_t next_ordinal_ = 0;
  Queue waiting_;
  std::size_t waiting_bytes_ = 0;
  std::size_t held_ = 0;  // of waiting_
  FaultCounters counters_;
};

}  // namespace buoyancy::service
