// Baseline for the cost of LCM itself: publishes, for each request, a prepared response of the size that the
// service would send, and copies only the request id into it.
//
//   lcm_echo URL BODIES
//
// BODIES: number of bodies of a response, with the ids 1 to BODIES. Prints "ready" on standard error, then
// runs until it is killed.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <lcm/lcm.h>

#include "messages/wire.h"
#include "transport/message_limits.h"

namespace {

// utime, session_id and seq follow the fingerprint in both requests and responses.
constexpr std::size_t kIdOffset = 8;
constexpr std::size_t kIdSize = 24;

std::vector<std::uint8_t> make_response(std::int32_t bodies) {
  buoyancy::WrenchResponse response;
  for (std::int32_t id = 1; id <= bodies; ++id) response.bodies.push_back({.body_id = id});
  std::vector<std::uint8_t> bytes;
  encode(response, bytes);
  return bytes;
}

// Gives liblcm's sockets the receive buffer that buoyancyd has. liblcm asks for at most net.core.rmem_max and
// does not disclose its sockets; other descriptors reject the option.
void enlarge_receive_buffers(std::size_t message_bytes) {
  constexpr int kDescriptors = 64;
  for (int fd = 3; fd < kDescriptors; ++fd) {
    buoyancy::set_receive_buffer(fd, buoyancy::receive_buffer_for(message_bytes));
  }
}

extern "C" void echo_request(const lcm_recv_buf_t* request, const char* /*channel*/, void* response) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(response);
  if (request->data_size < kIdOffset + kIdSize) return;
  std::memcpy(bytes.data() + kIdOffset, static_cast<const std::uint8_t*>(request->data) + kIdOffset, kIdSize);
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
  std::vector<std::uint8_t> response = make_response(bodies);
  lcm_t* lcm = lcm_create(argv[1]);
  if (lcm == nullptr || lcm_get_fileno(lcm) < 0) return 1;
  enlarge_receive_buffers(buoyancy::request_size(static_cast<std::size_t>(bodies)));
  lcm_subscribe(lcm, std::string(buoyancy::kStatesChannel).c_str(), echo_request, &response);
  std::fprintf(stderr, "ready\n");
  while (lcm_handle(lcm) == 0) {
  }
  return 1;
}
