#include "testing/private_network.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <arpa/inet.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/unique_fd.h"
#include "transport/lcm_connection.h"

namespace buoyancy::testing {
namespace {

Error system_error(const char* what) {
  return {"a private network for tests", what + (": " + std::generic_category().message(errno)),
          "a kernel that permits network namespaces",
          "a container without the capability SYS_ADMIN, or kernel.unprivileged_userns_clone = 0",
          "Give the machine a multicast route instead, as root: ip link set lo up && ip route add "
          "224.0.0.0/4 dev lo"};
}

// The user and the group in the new user namespace are root, and those outside are the caller's.
bool map_to_root(uid_t user, gid_t group) {
  const auto write = [](const char* path, const std::string& text) {
    std::ofstream file(path);
    file << text << std::flush;
    return file.good();
  };
  return write("/proc/self/setgroups", "deny") &&
         write("/proc/self/uid_map", "0 " + std::to_string(user) + " 1") &&
         write("/proc/self/gid_map", "0 " + std::to_string(group) + " 1");
}

sockaddr address(const char* text) {
  sockaddr_in internet{};
  internet.sin_family = AF_INET;
  inet_pton(AF_INET, text, &internet.sin_addr);
  sockaddr generic{};
  std::memcpy(&generic, &internet, sizeof generic);
  return generic;
}

// Does `ip link set lo up && ip route add 224.0.0.0/4 dev lo` without the package iproute2.
bool set_up_loopback() {
  const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq interface {};
  std::string name = "lo";
  std::memcpy(interface.ifr_name, name.c_str(), name.size() + 1);
  if (!socket.valid() || ioctl(socket.value(), SIOCGIFFLAGS, &interface) != 0) return false;
  interface.ifr_flags = static_cast<short>(interface.ifr_flags | IFF_UP);
  if (ioctl(socket.value(), SIOCSIFFLAGS, &interface) != 0) return false;
  rtentry route{};
  route.rt_dst = address("224.0.0.0");
  route.rt_genmask = address("240.0.0.0");
  route.rt_flags = RTF_UP;
  route.rt_dev = name.data();
  return ioctl(socket.value(), SIOCADDRT, &route) == 0;
}

}  // namespace

bool has_multicast() {
  return LcmConnection::open("udpm://239.255.76.67:7667?ttl=0").has_value();
}

Expected<void> enter_private_network() {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  const bool is_root = user == 0;
  if (unshare(is_root ? CLONE_NEWNET : CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    if (errno == EINVAL) {
      return make_error({"a private network for tests", "this process has several threads", "one thread",
                         "it is entered after a library has started threads",
                         "Call buoyancy::testing::enter_private_network() at the start of main()"});
    }
    return make_error(system_error("unshare"));
  }
  if (!is_root && !map_to_root(user, group)) return make_error(system_error("the user namespace's maps"));
  if (!set_up_loopback()) return make_error(system_error("the loopback interface"));
  return {};
}

Expected<void> ensure_multicast() {
  if (has_multicast()) return {};
  return enter_private_network();
}

}  // namespace buoyancy::testing
