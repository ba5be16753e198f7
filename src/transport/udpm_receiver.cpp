#include "transport/udpm_receiver.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

#include <arpa/inet.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include "transport/lcm_connection.h"
#include "transport/multicast_probe.h"
#include "transport/udpm_url.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxPacket = 65'536;

template <typename T>
bool set(const UniqueFd& socket, int level, int option, const T& value) {
  return ::setsockopt(socket.value(), level, option, &value, sizeof value) == 0;
}

template <typename T>
T data_of(cmsghdr* message) {
  T value;
  std::memcpy(&value, CMSG_DATA(message), sizeof value);
  return value;
}

}  // namespace

UdpmReceiver::UdpmReceiver(UniqueFd socket, const ReceiveBuffer& receive_buffer)
    : socket_(std::move(socket)), receive_buffer_(receive_buffer), packet_(kMaxPacket) {}

Expected<UdpmReceiver> UdpmReceiver::open(const std::string& url) {
  const Expected<UdpmUrl> parsed = parse_udpm_url(resolve_lcm_url(url));
  if (!parsed) return tl::unexpected(parsed.error());
  return open(*parsed);
}

Expected<UdpmReceiver> UdpmReceiver::open(const UdpmUrl& url) {
  UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(url.port);
  ::inet_pton(AF_INET, url.group.c_str(), &group.sin_addr);
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  ReceiveBuffer buffer{.requested = static_cast<std::size_t>(url.recv_buf_size.value_or(kMinReceiveBuffer)),
                       .fixed_by_url = url.recv_buf_size.has_value()};
  if (socket.valid()) buffer.max_message = set_receive_buffer(socket.value(), buffer.requested);
  // The socket is bound to the group's address to exclude packets that were sent to the port at another
  // address; IP_MULTICAST_ALL = 0 excludes those from interfaces on which only another program has joined the
  // group.
  const bool ready = buffer.max_message > 0 && set(socket, SOL_SOCKET, SO_REUSEADDR, 1) &&
                     set(socket, SOL_SOCKET, SO_TIMESTAMPNS, 1) && set(socket, SOL_SOCKET, SO_RXQ_OVFL, 1) &&
                     ::bind(socket.value(), reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0 &&
                     set(socket, IPPROTO_IP, IP_MULTICAST_ALL, 0);
  if (!ready) {
    return make_error(
        {to_string(url), std::generic_category().message(errno), "a UDP socket bound to the group",
         "another program uses the port exclusively, or this one may not open sockets",
         "Give the LCM URL of every program another port, or end the program that uses this one"});
  }
  if (!set(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership)) return no_multicast_route(url, errno);
  return UdpmReceiver(std::move(socket), buffer);
}

Expected<std::size_t> UdpmReceiver::subscribe(const std::string& channel) {
  if (Expected<void> checked = check_channel(channel); !checked) return tl::unexpected(checked.error());
  const std::optional<std::size_t> number = reassembler_.add_channel(channel);
  if (!number) {
    return make_error({"LCM channel '" + channel + "'", "is already subscribed to",
                       "one subscription per channel", "", ""});
  }
  return *number;
}

void UdpmReceiver::reserve(std::size_t message_bytes) {
  if (receive_buffer_.fixed_by_url || message_bytes <= receive_buffer_.max_message) return;
  receive_buffer_.requested = receive_buffer_for(message_bytes);
  receive_buffer_.max_message = set_receive_buffer(socket_.value(), receive_buffer_.requested);
}

std::optional<UdpmReceiver::Packet> UdpmReceiver::read_packet() {
  sockaddr_in sender{};
  iovec data{packet_.data(), packet_.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))>
      control{};
  msghdr packet{};
  packet.msg_name = &sender;
  packet.msg_namelen = sizeof sender;
  packet.msg_iov = &data;
  packet.msg_iovlen = 1;
  packet.msg_control = control.data();
  packet.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket_.value(), &packet, MSG_DONTWAIT);
  if (size < 0) return std::nullopt;
  timespec arrived{};
  for (cmsghdr* header = CMSG_FIRSTHDR(&packet); header != nullptr; header = CMSG_NXTHDR(&packet, header)) {
    if (header->cmsg_level != SOL_SOCKET) continue;
    if (header->cmsg_type == SCM_TIMESTAMPNS) arrived = data_of<timespec>(header);
    if (header->cmsg_type == SO_RXQ_OVFL) {
      const auto drops = data_of<std::uint32_t>(header);
      packets_dropped_ += drops - std::exchange(kernel_drops_, drops);
    }
  }
  return Packet{{packet_.data(), static_cast<std::size_t>(size)},
                {sender.sin_addr.s_addr, sender.sin_port},
                std::int64_t{arrived.tv_sec} * 1'000'000 + arrived.tv_nsec / 1'000};
}

std::optional<UdpmReceiver::Message> UdpmReceiver::receive(int max_packets) {
  for (int i = 0; i < max_packets; ++i) {
    const std::optional<Packet> packet = read_packet();
    if (!packet) {
      if (errno == EINTR) continue;
      return std::nullopt;
    }
    const std::uint64_t from = std::uint64_t{packet->sender.address} << 16U | packet->sender.port;
    if (const auto message = reassembler_.push(packet->bytes, from)) {
      return Message{message->channel, message->payload, packet->arrived};
    }
  }
  return std::nullopt;
}

std::optional<UdpmReceiver::Sender> UdpmReceiver::find_sender(Bytes ending,
                                                              std::chrono::milliseconds timeout) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + timeout;
  for (Clock::time_point now = Clock::now(); now < deadline; now = Clock::now()) {
    const std::optional<Packet> packet = read_packet();
    if (packet && packet->bytes.size() >= ending.size() &&
        std::ranges::equal(packet->bytes.last(ending.size()), ending)) {
      return packet->sender;
    }
    if (packet) continue;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - now);
    pollfd readable{socket_.value(), POLLIN, 0};
    ::poll(&readable, 1, static_cast<int>(left.count()));
  }
  return std::nullopt;
}

bool UdpmReceiver::truncate_packets_of(const Sender& sender) {
  // Classic BPF addresses a datagram from its UDP header on, and the IP header at kIpHeader. It returns the
  // number of bytes to keep; the kernel keeps at least the 8 bytes of the UDP header.
  constexpr std::uint32_t kIpHeader = static_cast<std::uint32_t>(SKF_NET_OFF);
  constexpr std::uint32_t kSourceAddress = kIpHeader + 12;
  constexpr std::uint32_t kSourcePort = 0;
  constexpr std::uint32_t kHeaderOnly = 1;
  constexpr std::uint32_t kWholePacket = 0xffffffff;
  std::array<sock_filter, 6> program{{BPF_STMT(BPF_LD | BPF_H | BPF_ABS, kSourcePort),
                                      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ntohs(sender.port), 0, 3),
                                      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kSourceAddress),
                                      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ntohl(sender.address), 0, 1),
                                      BPF_STMT(BPF_RET | BPF_K, kHeaderOnly),
                                      BPF_STMT(BPF_RET | BPF_K, kWholePacket)}};
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return set(socket_, SOL_SOCKET, SO_ATTACH_FILTER, filter);
}

}  // namespace buoyancy
