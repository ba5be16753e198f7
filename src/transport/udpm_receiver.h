// The receiving half of LCM over UDP multicast, on a socket of its own: packets wait in the kernel, stamped
// with the time of their arrival, until somebody comes to take them. Nobody is woken who does not wait.
//
// liblcm has a thread that each packet wakes, of whatever channel, and that wakes the one who waits for the
// message: two wake-ups each way, paid for partly by the process that sends. Its stamp is the time at which
// that thread read the packet; it remembers every channel's name that was ever seen; and a fragment made for
// it ends the process. What it has in return is room: packets that come while nobody reads wait in the
// kernel's buffer here, and are lost, and counted, where that is full.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/unique_fd.h"
#include "messages/wire.h"
#include "transport/lcm_reassembler.h"
#include "transport/udpm_url.h"

namespace buoyancy {

// Packets and fragments that came for this socket and did not become messages, since it was opened.
struct DropCounts {
  std::int64_t packets = 0;    // dropped by the kernel: they came faster than they were taken. Of any channel
  std::int64_t fragments = 0;  // of messages of our channels that lost others of theirs, or made no sense
};

class UdpmReceiver {
 public:
  struct Message {
    std::size_t channel;   // as subscribe() numbered it
    Bytes payload;         // valid until the next receive()
    std::int64_t arrived;  // us since 1970
  };

  // url: "" for the default; as LcmConnection::open has it. Joins the group on the interface that the routing
  // table names for it; hears what is sent to the group there or by this machine, and nothing else that comes
  // to the port. Asks the kernel for a buffer of 4 MB where the URL does
  // not say. Sends nothing. Errors: not a udpm URL, no multicast route.
  static Expected<UdpmReceiver> open(const std::string& url);
  static Expected<UdpmReceiver> open(const UdpmUrl& url);

  // channel: this very name, of 1 to 63 characters. Its number: 0, 1, ... Errors: not such a name, or one
  // that is subscribed to.
  Expected<std::size_t> subscribe(const std::string& channel);

  // The next message of our channels among at most `max_packets` that wait. nullopt: there is none.
  std::optional<Message> receive(int max_packets);

  // Whose packets: both numbers in network byte order.
  struct Sender {
    std::uint32_t address = 0;
    std::uint16_t port = 0;
  };

  // Takes what waits, whatever it is, up to the first packet that ends with these bytes: who sent it.
  // nullopt: none came in time.
  std::optional<Sender> find_sender(Bytes ending, std::chrono::milliseconds timeout);

  // From now on the packets of this sender wait without their contents and become no messages. They are not
  // dropped, because the kernel counts what a filter drops among the packets that it had no room for. False:
  // the kernel takes no filter, and all is as before.
  bool empty_packets_of(const Sender& sender);

  int fileno() const { return socket_.value(); }  // readable when a packet waits, of any channel
  DropCounts drop_counts() const { return {packets_dropped_, reassembler_.fragments_dropped()}; }

 private:
  struct Packet {
    Bytes bytes;  // valid until the next read_packet()
    Sender sender;
    std::int64_t arrived = 0;  // us since 1970
  };

  explicit UdpmReceiver(UniqueFd socket);
  // nullopt: none waits, or a signal came in between (errno EINTR). Counts what the kernel dropped.
  std::optional<Packet> read_packet();

  UniqueFd socket_;
  LcmReassembler reassembler_;
  std::vector<std::uint8_t> packet_;  // reused
  std::int64_t packets_dropped_ = 0;
  std::uint32_t kernel_drops_ = 0;  // as the kernel said last; it wraps around
};

}  // namespace buoyancy
