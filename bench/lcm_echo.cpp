// What LCM itself costs: a process that does nothing but answer. It subscribes to the channel of the
// requests and publishes for each as many bytes as the service would, made beforehand but for the key.
//
//   lcm_echo URL BODIES
//
// BODIES: how many bodies a response has, with the ids 1 to BODIES. Says "ready" on standard error, then
// echoes until it is killed.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <lcm/lcm.h>

#include "messages/wire.h"

namespace {

// utime, session_id and seq stand behind the fingerprint in requests and answers alike.
constexpr std::size_t kKeyStart = 8;
constexpr std::size_t kKeySize = 24;

std::vector<std::uint8_t> response_of(std::int32_t bodies) {
  buoyancy::WrenchResponse response;
  for (std::int32_t id = 1; id <= bodies; ++id) response.bodies.push_back({.body_id = id});
  std::vector<std::uint8_t> bytes;
  encode(response, bytes);
  return bytes;
}

extern "C" void echo_request(const lcm_recv_buf_t* request, const char* /*channel*/, void* response) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(response);
  if (request->data_size < kKeyStart + kKeySize) return;
  std::memcpy(bytes.data() + kKeyStart, static_cast<const std::uint8_t*>(request->data) + kKeyStart,
              kKeySize);
  lcm_publish(request->lcm, std::string(buoyancy::kWrenchesChannel).c_str(), bytes.data(),
              static_cast<unsigned>(bytes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  std::int32_t bodies = 0;
  if (argc != 3 || std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), bodies).ec != std::errc{}) {
    std::fprintf(stderr, "usage: lcm_echo URL BODIES\n");
    return 2;
  }
  std::vector<std::uint8_t> response = response_of(bodies);
  lcm_t* lcm = lcm_create(argv[1]);
  if (lcm == nullptr || lcm_get_fileno(lcm) < 0) return 1;
  lcm_subscribe(lcm, std::string(buoyancy::kStatesChannel).c_str(), echo_request, &response);
  std::fprintf(stderr, "ready\n");
  while (lcm_handle(lcm) == 0) {
  }
  return 1;
}
