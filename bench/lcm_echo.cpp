// What LCM itself costs: a process that does nothing but answer. It subscribes to the channel of the
// questions and publishes for each as many bytes as the service would, made beforehand but for the key.
//
//   lcm_echo URL BODIES
//
// BODIES: how many bodies an answer has, with the ids 1 to BODIES. Says "ready" on standard error, then
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

// utime, session_id and seq stand behind the fingerprint in questions and answers alike.
constexpr std::size_t kKeyStart = 8;
constexpr std::size_t kKeySize = 24;

std::vector<std::uint8_t> answer_of(std::int32_t bodies) {
  buoyancy::Answer answer;
  for (std::int32_t id = 1; id <= bodies; ++id) answer.bodies.push_back({.body_id = id});
  std::vector<std::uint8_t> bytes;
  encode(answer, bytes);
  return bytes;
}

extern "C" void echo_question(const lcm_recv_buf_t* question, const char* /*channel*/, void* answer) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(answer);
  if (question->data_size < kKeyStart + kKeySize) return;
  std::memcpy(bytes.data() + kKeyStart, static_cast<const std::uint8_t*>(question->data) + kKeyStart,
              kKeySize);
  lcm_publish(question->lcm, std::string(buoyancy::kWrenchesChannel).c_str(), bytes.data(),
              static_cast<unsigned>(bytes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  std::int32_t bodies = 0;
  if (argc != 3 || std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), bodies).ec != std::errc{}) {
    std::fprintf(stderr, "usage: lcm_echo URL BODIES\n");
    return 2;
  }
  std::vector<std::uint8_t> answer = answer_of(bodies);
  lcm_t* lcm = lcm_create(argv[1]);
  if (lcm == nullptr || lcm_get_fileno(lcm) < 0) return 1;
  lcm_subscribe(lcm, std::string(buoyancy::kStatesChannel).c_str(), echo_question, &answer);
  std::fprintf(stderr, "ready\n");
  while (lcm_handle(lcm) == 0) {
  }
  return 1;
}
