// Fuzz target: messages of the type body_condition_t from the network, and requests between them. A decoded
// message must encode to the same bytes. A message is used, or gives an error on one line. A body whose
// condition is unknown has zeros, and every other body a wrench; a response does not depend on earlier
// requests.
//
//   each message   1 byte: bit 0 the fingerprint overwrites the packet's first bytes, bits 1 and 2 its body
//   is
//                  one of the scene's, bit 3 its kind and index are small, bit 4 its numbers are within 0 and
//                  1, bit 5 its utime is small; then 44 bytes, the packet, or fewer at the end
//   each request   1 byte, its utime
#include <cmath>
#include <vector>

#include "engine/request_handler.h"
#include "tests/fuzz/fuzz_bytes.h"
#include "tests/fuzz/fuzz_check.h"
#include "tests/fuzz/fuzz_packets.h"
#include "tests/support/byte_vector.h"
#include "tests/support/damaged_boxes.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr std::size_t kPacketSize = 44;
constexpr std::size_t kMaxMessages = 64;

const Scene& boxes() {
  static const Scene kScene = scene_of(damaged_boxes());
  return kScene;
}

ByteVector next_packet(FuzzBytes& bytes) {
  const unsigned options = bytes.byte();
  ByteVector packet = copy_of(bytes.take(kPacketSize));
  if ((options & 1U) != 0) write_fingerprint(encoded(ConditionChange{}), packet);
  ConditionChange change;
  if (decode(packet, change)) {
    require(change == ConditionChange{}, "a message that does not decode changes nothing");
    return packet;
  }
  require(encoded(change) == packet, "a decoded message encodes to the same bytes");
  if ((options & 6U) != 0) change.body_id = static_cast<std::int32_t>((options >> 1U) & 3U);
  if ((options & 8U) != 0) {
    change.kind = static_cast<ConditionKind>(static_cast<std::int32_t>(change.kind) & 1);
    change.index &= 1;
  }
  if ((options & 16U) != 0) {
    change.flooded = folded(change.flooded, 0.0, 1.0);
    change.liquid_volume = folded(change.liquid_volume, 0.0, 1.0);
  }
  if ((options & 32U) != 0) change.utime &= 0xff;
  return encoded(change);
}

void receive(const ByteVector& packet, RequestHandler& handler) {
  const Expected<void> received = handler.receive_condition(packet);
  if (received) return;
  const Error& error = received.error();
  require(!error.actual.empty() && !error.expected.empty(), "an error states actual and expected");
  require(error.message().find('\n') == std::string::npos, "an error is one line");
}

struct Outputs {
  ByteVector wrenches, hydrostatics, loads;

  bool operator==(const Outputs&) const = default;
};

Outputs respond(RequestHandler& handler, std::int64_t utime) {
  static std::int64_t seq = 0;
  WrenchRequest request{
      .id = {.utime = utime, .session_id = 1, .seq = ++seq}, .lead_time = 0.0, .bodies = {}};
  for (const std::int32_t id : {1, 2, 3}) {
    BodyState& state = request.bodies.emplace_back();
    state.body_id = id;
    state.position = {0.0, 0.0, 0.25};
    state.quaternion_wxyz = {0.96, 0.0, 0.28, 0.0};
  }
  Outputs outputs{copy_of(handler.handle(encoded(request))), copy_of(handler.last_hydrostatics()),
                  copy_of(handler.last_loads())};
  // The responses of two handlers are the same but for this number.
  for (ByteVector* message : {&outputs.wrenches, &outputs.hydrostatics, &outputs.loads}) {
    require(message->size() > kResponseHeaderSize, "every output is there");
    set_response_seq(0, *message);
  }
  return outputs;
}

void check_wrenches(const Outputs& outputs) {
  WrenchResponse response;
  require(!decode(outputs.wrenches, response) && response.bodies.size() == 3, "a response decodes");
  for (const BodyWrench& wrench : response.bodies) {
    const bool is_ok = wrench.status == BodyStatus::kOk;
    require(is_ok || (wrench.status == BodyStatus::kBadCondition && wrench.body_id != 2),
            "a body has a wrench or an unknown condition");
    require(is_ok == (wrench.force[2] != 0.0), "a body without a wrench has zeros");
    require(std::isfinite(wrench.force[2]) && std::isfinite(wrench.torque[1]), "a wrench is finite");
  }
}

void check(FuzzBytes bytes) {
  RequestHandler handler(boxes(), {.max_sessions = 1, .threads = 1});
  std::vector<ByteVector> packets;
  while (!bytes.empty() && packets.size() < kMaxMessages) {
    packets.push_back(next_packet(bytes));
    receive(packets.back(), handler);
    check_wrenches(respond(handler, bytes.byte()));
  }
  RequestHandler fresh(boxes(), {.max_sessions = 1, .threads = 1});
  for (const ByteVector& packet : packets) receive(packet, fresh);
  for (const std::int64_t utime : {0, 100, 255}) {
    require(respond(handler, utime) == respond(fresh, utime),
            "a response does not depend on earlier requests");
  }
  const ServiceCounters& counters = handler.counters();
  require(counters.conditions_received + counters.conditions_rejected ==
              static_cast<std::int64_t>(packets.size()),
          "every message is counted once");
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::FuzzBytes({data, size}));
  return 0;
}
