// The receiving half of LCM over UDP multicast, on a socket of its own. Packets stay in the kernel's buffer,
// stamped with their arrival time, until receive() reads them. Only a thread that polls fileno() is woken.
//
// It replaces liblcm's receiver, in which every packet of any channel wakes a reader thread that then wakes
// the waiting thread: two wake-ups per message in each direction, partly at the sender's cost. liblcm's time
// stamp is the time at which that thread read the packet, it stores every channel name ever received, and a
// crafted fragment ends the process. In return liblcm buffers more: here, packets that arrive while the
// kernel's buffer is full are lost, and counted.
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
#include "transport/message_limits.h"
#include "transport/udpm_url.h"

namespace buoyancy {

// Packets and fragments that arrived at the socket since it was opened and did not become messages.
struct DropCounts {
  std::int64_t packets = 0;    // of any channel, dropped by the kernel because its receive buffer was full
  std::int64_t fragments = 0;  // of incomplete or inconsistent messages on the subscribed channels
  std::int64_t partial_messages_evicted = 0;  // incomplete ones, to keep within the limits of LcmReassembler
  std::int64_t oversized_messages = 0;        // larger than kMaxMessageBytes, on the subscribed channels
};

class UdpmReceiver {
 public:
  struct Message {
    std::size_t channel;   // the number from subscribe()
    Bytes payload;         // valid until the next receive()
    std::int64_t arrived;  // [us since 1970]
  };

  // url: "" for the default, see LcmConnection::open. Joins the group on the interface that the routing table
  // selects for it. Receives what is sent to the group on that interface or by this machine, and nothing else
  // that arrives at the port. Requests a receive buffer of kMinReceiveBuffer unless the URL gives a size.
  // Sends nothing. Errors: not a udpm URL, no multicast route.
  static Expected<UdpmReceiver> open(const std::string& url);
  static Expected<UdpmReceiver> open(const UdpmUrl& url);

  // channel: an exact name of 1 to 63 characters. Returns its number: 0, 1, ... Errors: an invalid name, a
  // channel that is already subscribed to.
  Expected<std::size_t> subscribe(const std::string& channel);

  // Enlarges the receive buffer for messages of this size [bytes], unless the URL fixes its size. The kernel
  // may grant less: see receive_buffer().
  void reserve(std::size_t message_bytes);
  const ReceiveBuffer& receive_buffer() const { return receive_buffer_; }

  // Reads up to max_packets pending packets until one completes a message of a subscribed channel. nullopt:
  // none did.
  std::optional<Message> receive(int max_packets);

  // The source of a packet, in network byte order.
  struct Sender {
    std::uint32_t address = 0;
    std::uint16_t port = 0;
  };

  // Discards packets up to the first that ends with these bytes, and returns its sender. nullopt: none
  // arrived before the timeout.
  std::optional<Sender> find_sender(Bytes ending, std::chrono::milliseconds timeout);

  // Makes the kernel truncate the packets of this sender from now on, so that they become no messages. They
  // are not dropped, because the kernel counts packets that a filter drops as receive-buffer overflows.
  // Returns false if the kernel rejected the filter; nothing has changed then.
  bool truncate_packets_of(const Sender& sender);

  int fileno() const { return socket_.value(); }  // readable when a packet of any channel is pending
  DropCounts drop_counts() const {
    return {packets_dropped_, reassembler_.fragments_dropped(), reassembler_.partial_messages_evicted(),
            reassembler_.oversized_messages()};
  }

 private:
  struct Packet {
    Bytes bytes;  // valid until the next read_packet()
    Sender sender;
    std::int64_t arrived = 0;  // [us since 1970]
  };

  UdpmReceiver(UniqueFd socket, const ReceiveBuffer& receive_buffer);
  // nullopt: none is pending, or a signal interrupted the call (errno EINTR). Counts what the kernel dropped.
  std::optional<Packet> read_packet();

  UniqueFd socket_;
  ReceiveBuffer receive_buffer_;
  LcmReassembler reassembler_;
  std::vector<std::uint8_t> packet_;  // reused
  std::int64_t packets_dropped_ = 0;
  std::uint32_t kernel_drops_ = 0;  // last counter value from the kernel; it wraps around
};

}  // namespace buoyancy
