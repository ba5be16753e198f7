// The URL of LCM's UDP multicast provider, parsed strictly: liblcm itself interprets a misspelt address as
// 0.0.0.0 and ignores a misspelt option.
//
//   udpm://[address][:port][?ttl=N][&recv_buf_size=N]      defaults: address 239.255.76.67, port 7667
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
  std::optional<std::int32_t> recv_buf_size;  // [bytes]
};

// Errors: another scheme, a group that is not an IPv4 multicast address, a port or option out of range, an
// unknown option.
Expected<UdpmUrl> parse_udpm_url(const std::string& url);

// Returns the URL with every part written out, since liblcm uses port 0 if a URL has none.
std::string to_string(const UdpmUrl& url);

}  // namespace buoyancy
