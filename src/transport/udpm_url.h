// The URL of LCM's UDP multicast provider, read strictly: liblcm itself takes a misspelt address for 0.0.0.0
// and a misspelt option for none.
//
//   udpm://[address][:port][?ttl=N][&recv_buf_size=N]      address 239.255.76.67, port 7667 where left out
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/error.h"

namespace buoyancy {

struct UdpmUrl {
  std::string group = "239.255.76.67";        // an IPv4 multicast address: 224.0.0.0 to 239.255.255.255
  std::uint16_t port = 7667;                  // >= 1
  int ttl = 0;                                // 0: packets stay on this machine; limits sending only
  std::optional<std::int32_t> recv_buf_size;  // bytes
};

// Errors: not udpm, a group that is no multicast address, a port or an option out of range or unknown.
Expected<UdpmUrl> parse_udpm_url(const std::string& url);

// As liblcm has to be told, which takes port 0 where a URL names none.
std::string to_string(const UdpmUrl& url);

}  // namespace buoyancy
