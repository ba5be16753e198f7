#include "transport/message_limits.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include <sys/socket.h>

#include "base/format.h"
#include "base/unique_fd.h"

namespace buoyancy {
namespace {

// liblcm's limits for the channel name, its NUL and the payload.
constexpr std::size_t kMaxUnfragmented = 65'499;
constexpr std::size_t kMaxFragment = 65'487;

// "in 3 requests or more, one client (session) for each part"
std::string in_parts(std::size_t message_bytes, std::size_t max_bytes) {
  const std::size_t parts = (message_bytes + max_bytes - 1) / std::max<std::size_t>(max_bytes, 1);
  return "in " + std::to_string(parts) + " requests or more, one client (session) for each part";
}

}  // namespace

std::size_t packet_count(std::size_t message_bytes, std::string_view channel) {
  const std::size_t payload = channel.size() + 1 + message_bytes;
  return payload <= kMaxUnfragmented ? 1 : (payload + kMaxFragment - 1) / kMaxFragment;
}

Expected<void> check_message_size(const std::string& subject, std::size_t message_bytes) {
  if (message_bytes <= kMaxMessageBytes) return {};
  return make_error({subject, "a message of " + std::to_string(message_bytes) + " bytes",
                     "at most " + std::to_string(kMaxMessageBytes) +
                         " bytes; service, client and view drop larger messages",
                     "too many bodies for one message",
                     "Send the bodies " + in_parts(message_bytes, kMaxMessageBytes) +
                         ", or distribute them over several services"});
}

BufferLimit buffer_limit(const ReceiveBuffer& buffer, std::size_t message_bytes) {
  const std::size_t wanted = receive_buffer_for(message_bytes);
  const std::string size = std::to_string(wanted);
  if (buffer.fixed_by_url && buffer.requested <= buffer.max_message) {
    return {"recv_buf_size in the LCM URL limits the buffer",
            "leave recv_buf_size out of the LCM URL, or set it to " + size};
  }
  if (buffer.max_message >= wanted) {
    return {"the buffer is large enough for one message, but more arrived before it was read",
            "set recv_buf_size in the LCM URL to more than " + size};
  }
  return {"net.core.rmem_max limits the buffer",
          "run 'sysctl -w net.core.rmem_max=" + size + "' and restart"};
}

std::optional<Warning> receive_buffer_warning(const std::string& subject, std::size_t message_bytes,
                                              std::string_view channel, const ReceiveBuffer& buffer) {
  if (message_bytes <= buffer.max_message) return std::nullopt;
  const auto packets = static_cast<std::int64_t>(packet_count(message_bytes, channel));
  BufferLimit limit = buffer_limit(buffer, message_bytes);
  return Warning{subject,
                 "a message of " + std::to_string(message_bytes) + " bytes in " +
                     pluralize(packets, "packet", "packets") + ", some of which may be lost",
                 "at most " + std::to_string(buffer.max_message) +
                     " bytes, which the kernel's receive buffer holds until they are read",
                 std::move(limit.cause),
                 "To send all bodies at once, " + limit.remedy + "; otherwise send them " +
                     in_parts(message_bytes, buffer.max_message)};
}

std::size_t receive_buffer_for(std::size_t message_bytes) {
  constexpr std::size_t kMegabyte = std::size_t{1} << 20U;
  return std::max(kMinReceiveBuffer, (message_bytes + kMegabyte - 1) / kMegabyte * kMegabyte);
}

std::size_t set_receive_buffer(int socket, std::size_t bytes) {
  // The kernel doubles the number.
  const auto wanted =
      static_cast<std::int32_t>(std::min<std::size_t>(bytes, std::numeric_limits<std::int32_t>::max() / 2));
  if (::setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &wanted, sizeof wanted) != 0 &&
      ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted) != 0) {
    return 0;
  }
  std::int32_t granted = 0;
  socklen_t size = sizeof granted;
  if (::getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &granted, &size) != 0) return 0;
  return static_cast<std::size_t>(granted) / 2;
}

std::size_t grantable_receive_buffer(std::size_t bytes) {
  const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return set_receive_buffer(socket.value(), bytes);
}

}  // namespace buoyancy
