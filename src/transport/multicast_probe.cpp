#include "transport/multicast_probe.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <system_error>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace buoyancy {
namespace {

constexpr int kResendMilliseconds = 100;

// LCM's documentation advises this for a machine without a network; these are the iproute2 commands.
constexpr const char* kHint =
    "To keep LCM on this machine, run as root: "
    "ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo";

class Socket {
 public:
  Socket() : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int descriptor() const { return descriptor_; }
  template <typename T>
  bool set(int level, int option, const T& value) const {
    return ::setsockopt(descriptor_, level, option, &value, sizeof value) == 0;
  }

 private:
  int descriptor_;
};

std::string reason(int error) {
  return std::generic_category().message(error);
}

std::string subject(const UdpmUrl& url) {
  return "UDP multicast to " + url.group + ":" + std::to_string(url.port);
}

tl::unexpected<Error> socket_failed(const UdpmUrl& url, const std::string& what, int error) {
  return make_error(
      {subject(url), what + " failed (" + reason(error) + ")", "a UDP socket on that port",
       "another program uses the port exclusively, or this one may not open sockets",
       "Give the LCM URL of every program another port, or end the program that uses this one"});
}

// Returns an LCM message that no other probe sends: "LC02", a sequence number, the channel, the payload.
std::string self_test_packet() {
  using namespace std::string_literals;
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  return "LC02\0\0\0\0LCM_SELF_TEST\0buoyancy "s + std::to_string(::getpid()) + " " + std::to_string(now);
}

bool is_looped_back(const Socket& sender, const Socket& receiver, const sockaddr_in& group) {
  const std::string packet = self_test_packet();
  std::array<char, 256> received{};
  const auto start = std::chrono::steady_clock::now();
  const auto limit = start + std::chrono::milliseconds(kMulticastProbeMilliseconds);
  auto resend = start;
  for (auto now = start; now < limit; now = std::chrono::steady_clock::now()) {
    if (now >= resend) {
      ::sendto(sender.descriptor(), packet.data(), packet.size(), 0,
               reinterpret_cast<const sockaddr*>(&group), sizeof group);
      resend = now + std::chrono::milliseconds(kResendMilliseconds);
    }
    pollfd waiting{receiver.descriptor(), POLLIN, 0};
    if (::poll(&waiting, 1, kResendMilliseconds) <= 0) continue;
    const ssize_t length = ::recv(receiver.descriptor(), received.data(), received.size(), MSG_DONTWAIT);
    if (length == static_cast<ssize_t>(packet.size()) &&
        std::equal(packet.begin(), packet.end(), received.begin())) {
      return true;
    }
  }
  return false;
}

}  // namespace

tl::unexpected<Error> no_multicast_route(const UdpmUrl& url, int error) {
  return make_error({subject(url), "no multicast route (" + reason(error) + ")",
                     "a network interface that LCM's UDP multicast can use",
                     "this machine has no network, or none with a route for multicast", kHint});
}

Expected<void> probe_multicast(const UdpmUrl& url) {
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(url.port);
  if (inet_pton(AF_INET, url.group.c_str(), &group.sin_addr) != 1) return no_multicast_route(url, EINVAL);

  const Socket sender;
  const Socket receiver;
  if (sender.descriptor() < 0 || receiver.descriptor() < 0) return socket_failed(url, "socket", errno);
  if (::connect(sender.descriptor(), reinterpret_cast<const sockaddr*>(&group), sizeof group) != 0) {
    return no_multicast_route(url, errno);
  }

  sockaddr_in any = group;
  any.sin_addr.s_addr = htonl(INADDR_ANY);
  if (!receiver.set(SOL_SOCKET, SO_REUSEADDR, 1)) return socket_failed(url, "SO_REUSEADDR", errno);
  if (::bind(receiver.descriptor(), reinterpret_cast<const sockaddr*>(&any), sizeof any) != 0) {
    return socket_failed(url, "bind", errno);
  }
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  if (!receiver.set(IPPROTO_IP, IP_ADD_MEMBERSHIP, membership)) return no_multicast_route(url, errno);
  if (!sender.set(IPPROTO_IP, IP_MULTICAST_TTL, static_cast<unsigned char>(0))) {
    return socket_failed(url, "IP_MULTICAST_TTL", errno);
  }

  if (!is_looped_back(sender, receiver, group)) {
    return make_error(
        {subject(url),
         "packets are not looped back within " + std::to_string(kMulticastProbeMilliseconds) + " ms",
         "multicast packets that are looped back on this machine",
         "a firewall, or a multicast route through an interface without multicast", kHint});
  }
  return {};
}

}  // namespace buoyancy
