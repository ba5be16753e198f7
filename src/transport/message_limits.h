// The limits that a large message meets on its way over LCM's UDP multicast, and what to do about them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"

namespace buoyancy {

// [bytes]. Receivers of this project drop larger messages, which bounds their memory: 155,000 bodies.
inline constexpr std::size_t kMaxMessageBytes = std::size_t{16} << 20U;

// Number of UDP packets in which LCM sends a message.
std::size_t packet_count(std::size_t message_bytes, std::string_view channel);

// Errors: the message is larger than kMaxMessageBytes. subject: "request for 200000 bodies".
Expected<void> check_message_size(const std::string& subject, std::size_t message_bytes);

// The kernel's receive buffer of a UDP socket.
struct ReceiveBuffer {
  // [bytes], the largest message that fits while nobody reads. The kernel counts up to twice the size for
  // what a network card delivers in small pieces, and doubles the size that is asked for.
  std::size_t max_message = 0;
  std::size_t requested = 0;  // [bytes]; the kernel granted less if this is above max_message
  bool fixed_by_url = false;  // recv_buf_size
};

// Returns a warning if a message may lose packets because the receive buffer is too small for it, else
// nullopt. subject: "request for 100000 bodies".
std::optional<Warning> receive_buffer_warning(const std::string& subject, std::size_t message_bytes,
                                              std::string_view channel, const ReceiveBuffer& buffer);

// What limits the receive buffer, and how to get one that holds a message of this size [bytes].
struct BufferLimit {
  std::string cause, remedy;  // "net.core.rmem_max limits the buffer", "run 'sysctl -w ...' and restart"
};
BufferLimit buffer_limit(const ReceiveBuffer& buffer, std::size_t message_bytes);

// Size [bytes] of the receive buffer to ask for: at least kMinReceiveBuffer, which holds 5,000 small
// messages.
inline constexpr std::size_t kMinReceiveBuffer = std::size_t{4} << 20U;
std::size_t receive_buffer_for(std::size_t message_bytes);

// Asks the kernel for a receive buffer of this size for a UDP socket. Root gets it, others at most
// net.core.rmem_max. Returns the size that was granted; 0: the descriptor is no socket (errno says why).
std::size_t set_receive_buffer(int socket, std::size_t bytes);

// Returns what set_receive_buffer() would grant in this process, tested with a new socket; 0: unknown.
std::size_t grantable_receive_buffer(std::size_t bytes);

}  // namespace buoyancy
