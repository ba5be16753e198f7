// Fuzz target: bytes as packets from the network. Every decoder runs on every packet, and a handler with a
// small scene handles all of them one after another, as requests and as bot_core poses. A decoded message
// must encode to the same bytes; the response to a request must have the request's form, be repeated bit for
// bit for a retry, and be the same as that of a fresh handler.
//
//   each packet   1 byte: bits 0-2 a kind of message (0 request, 1 response, 2 hydrostatics, 3 status, 4
//                 loads, else none), bit 3 its fingerprint overwrites the packet's first bytes, bit 4 the
//                 number of bodies that matches the length is written to the packet 2 bytes: the packet's
//                 length, little-endian; then that many bytes, or all that remain
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "engine/pose_request_adapter.h"
#include "engine/request_handler.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "scene/scene.h"
#include "tests/fuzz/fuzz_bytes.h"
#include "tests/fuzz/fuzz_check.h"
#include "tests/fuzz/fuzz_packets.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using Packet = ByteVector;

constexpr std::string_view kScene = R"(
[[body]]
id = 1
shape = { type = "box", segments = [2, 1, 1] }
outputs = ["wrench", "hydrostatics"]
reference_point = [0.5, 0.5, -0.5]
[[body]]
id = 2
shape = { type = "sphere", segments = 4 }
method = "exact"
[[body]]
id = 3
shape = { type = "cone", segments = 5 }
method = "fast_surface"
[[body]]
id = 4
shape = { type = "rock", frequency = 2 }
tolerance = 0.01
[[body]]
id = 5
shape = { type = "box" }
method = "improved"
outputs = ["wrench", "hydrostatics"]
[[body]]
id = 6
shape = { type = "box" }
outputs = ["wrench", "loads"]
reference_point = [0.5, 0.5, -0.5]
[body.drag]
linear = [20, 60, 60, 5, 5, 8]
quadratic = [18, 22, 37, 1.5, 1.5, 1.5]
[body.added_mass]
matrix = [5, 126, 126, 0.1, 33, 33]
[[body]]
id = 7
shape = { type = "box" }
outputs = ["wrench", "hydrostatics", "loads"]
)";

const Scene& small_scene() {
  static const Scene kPrepared = scene_of(kScene);
  return kPrepared;
}

// A kind of message. `empty` is an encoded message without bodies or points: its first eight bytes are the
// fingerprint, its last four the number of bodies or points.
struct Kind {
  Packet empty;
  std::size_t body_size;  // [bytes]
};

template <typename Message>
Kind kind_of() {
  Message message;
  Kind kind;
  encode(message, kind.empty);
  message.bodies.resize(1);
  Packet one;
  encode(message, one);
  kind.body_size = one.size() - kind.empty.size();
  return kind;
}

const std::array<Kind, 6>& kinds() {
  static const std::array<Kind, 6> kKinds = [] {
    Kind status{.empty = {}, .body_size = 0};
    encode(ServiceStatus{}, status.empty);
    Kind points{.empty = {}, .body_size = water_points_size(1) - water_points_size(0)};
    encode(WaterPoints{}, points.empty);
    return std::array<Kind, 6>{kind_of<WrenchRequest>(),      kind_of<WrenchResponse>(),
                               kind_of<BodiesHydrostatics>(), status,
                               kind_of<BodiesLoads>(),        points};
  }();
  return kKinds;
}

Packet next_packet(FuzzBytes& bytes) {
  const unsigned options = bytes.byte();
  const std::size_t length = bytes.word();
  Packet packet = copy_of(bytes.take(length));
  const std::size_t number = options & 7U;
  if (number < kinds().size()) {
    const Kind& kind = kinds()[number];
    if ((options & 8U) != 0) write_fingerprint(kind.empty, packet);
    if ((options & 16U) != 0 && kind.body_size != 0) write_count(kind.empty.size(), kind.body_size, packet);
  }
  return packet;
}

template <typename Message>
bool decodes(const Packet& packet) {
  Message message;
  if (decode(packet, message)) return false;
  Packet again;
  encode(message, again);
  require(again == packet, "a decoded message encodes to the same bytes");
  return true;
}

template <std::size_t kSize>
bool finite(const std::array<double, kSize>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

void check_wrench(const BodyWrench& wrench) {
  require(finite(wrench.force) && finite(wrench.torque) && finite(wrench.center_of_buoyancy) &&
              std::isfinite(wrench.submerged_volume),
          "a wrench holds finite numbers");
  if (wrench.status == BodyStatus::kOk) return;
  const std::array<double, 3> zero{};
  require(wrench.force == zero && wrench.torque == zero && wrench.center_of_buoyancy == zero &&
              wrench.submerged_volume == 0.0 && wrench.force_error_bound == 0.0 &&
              wrench.torque_error_bound == 0.0,
          "a body whose status is not OK carries zeros");
}

bool same(const RequestId& a, const RequestId& b) {
  return a.utime == b.utime && a.session_id == b.session_id && a.seq == b.seq;
}

void check_response(const WrenchRequest& request, Bytes bytes) {
  WrenchResponse response;
  require(!decode(bytes, response), "a response decodes");
  require(same(response.id, request.id), "a response carries its request's id");
  require(response.bodies.size() == request.bodies.size(), "a response has its request's bodies");
  for (std::size_t i = 0; i < response.bodies.size(); ++i) {
    require(response.bodies[i].body_id == request.bodies[i].body_id, "bodies keep their order");
    check_wrench(response.bodies[i]);
  }
}

void check_hydrostatics(const WrenchRequest& request, Bytes bytes) {
  const Scene& scene = small_scene();
  std::vector<std::int32_t> expected_ids;
  for (const BodyState& state : request.bodies) {
    const Body* body = scene.find(state.body_id);
    if (body != nullptr && body->hydrostatics) expected_ids.push_back(body->id);
  }
  require(bytes.empty() == expected_ids.empty(), "hydrostatics exist if a body requests them");
  if (bytes.empty()) return;
  BodiesHydrostatics hydrostatics;
  require(!decode(bytes, hydrostatics), "hydrostatics decode");
  require(same(hydrostatics.id, request.id), "hydrostatics carry their request's id");
  require(std::equal(expected_ids.begin(), expected_ids.end(), hydrostatics.bodies.begin(),
                     hydrostatics.bodies.end(),
                     [](std::int32_t id, const BodyHydrostatics& body) { return id == body.body_id; }),
          "hydrostatics cover the bodies that request them");
}

void check_loads_of_body(const BodyLoads& loads) {
  const std::array vectors{loads.buoyancy_force, loads.buoyancy_torque,  loads.drag_force,
                           loads.drag_torque,    loads.added_mass_force, loads.added_mass_torque,
                           loads.water_velocity};
  require(std::ranges::all_of(vectors, [](const auto& vector) { return finite(vector); }) &&
              std::ranges::all_of(loads.added_mass, [](const auto& row) { return finite(row); }) &&
              std::ranges::all_of(loads.damping, [](const auto& row) { return finite(row); }),
          "loads are finite numbers");
  require(loads.immersion >= 0.0 && loads.immersion <= 1.0, "an immersion is from 0 to 1");
  if (loads.status == BodyStatus::kOk) return;
  Packet zeros;
  Packet bytes;
  encode(BodiesLoads{.id = {}, .bodies = {{.body_id = loads.body_id, .status = loads.status}}}, zeros);
  encode(BodiesLoads{.id = {}, .bodies = {loads}}, bytes);
  require(bytes == zeros, "loads of a body whose status is not OK are zeros");
}

void check_loads(const WrenchRequest& request, Bytes bytes) {
  std::vector<std::int32_t> expected_ids;
  for (const BodyState& state : request.bodies) {
    const Body* body = small_scene().find(state.body_id);
    if (body != nullptr && body->loads) expected_ids.push_back(body->id);
  }
  require(bytes.empty() == expected_ids.empty(), "loads exist if a body requests them");
  if (bytes.empty()) return;
  BodiesLoads loads;
  require(!decode(bytes, loads), "loads decode");
  require(same(loads.id, request.id), "loads carry their request's id");
  require(std::equal(expected_ids.begin(), expected_ids.end(), loads.bodies.begin(), loads.bodies.end(),
                     [](std::int32_t id, const BodyLoads& body) { return id == body.body_id; }),
          "loads cover the bodies that request them");
  for (const BodyLoads& body : loads.bodies) check_loads_of_body(body);
}

// What a handler publishes for its last request besides the response.
struct Outputs {
  Packet hydrostatics, loads;

  bool operator==(const Outputs&) const = default;
};
Outputs outputs_of(const RequestHandler& handler) {
  return {copy_of(handler.last_hydrostatics()), copy_of(handler.last_loads())};
}

void check_samples(const WaterPoints& request, Bytes bytes) {
  WaterSamples samples;
  require(!decode(bytes, samples), "samples of the water decode");
  require(same(samples.id, request.id), "samples carry their request's id");
  require(samples.samples.size() == request.points.size(), "there is a sample for each point");
  const bool is_zero = samples.status != BodyStatus::kOk;
  for (const WaterSample& sample : samples.samples) {
    const std::array numbers{sample.elevation,   sample.pressure,    sample.velocity[0],
                             sample.velocity[1], sample.velocity[2], sample.density};
    require(finite(numbers), "samples are finite numbers");
    require(!is_zero || std::ranges::count(numbers, 0.0) == 6, "samples that are not OK are zeros");
  }
}

// A request for the water at points is answered like one about bodies.
void send_points(const Packet& packet, const WaterPoints& request, RequestHandler& handler) {
  const Packet response = copy_of(handler.handle(packet));
  check_samples(request, response);
  require(copy_of(handler.handle(packet)) == response, "a retry gets the same bytes");
  RequestHandler fresh(small_scene(), {.max_sessions = 1, .threads = 1});
  require(copy_of(fresh.handle(packet)) == response, "samples do not depend on earlier requests");
}

// handler: the one that receives all packets.
void send_request(const Packet& packet, RequestHandler& handler) {
  if (WaterPoints points; !decode(packet, points)) {
    return send_points(packet, points, handler);
  }
  const auto id = peek_request_id(packet);
  WrenchRequest request;
  const std::optional<DecodeError> error = decode(packet, request);
  require(id.has_value() == !error, "peek_request_id() and decode() accept the same packets");
  const Packet response = copy_of(handler.handle(packet));
  const Outputs outputs = outputs_of(handler);
  if (error) {
    require(id.error() == *error, "peek_request_id() and decode() return the same error");
    require(response.empty() && outputs == Outputs{}, "an invalid packet gets no response");
    return;
  }
  require(same(*id, request.id), "peek_request_id() finds the request's id");
  check_response(request, response);
  check_hydrostatics(request, outputs.hydrostatics);
  check_loads(request, outputs.loads);
  require(copy_of(handler.handle(packet)) == response && outputs_of(handler) == outputs,
          "a retry gets the same bytes");
  RequestHandler fresh(small_scene(), {.max_sessions = 1, .threads = 1});
  require(copy_of(fresh.handle(packet)) == response && outputs_of(fresh) == outputs,
          "a response does not depend on earlier requests");
}

// Handles the packet as a pose on a channel of its own.
void send_pose(const Packet& packet, PoseRequestAdapter& poses, RequestHandler& handler) {
  const auto request = poses.make_request(0, packet);
  require(request.has_value() == decode_bot_pose(packet).has_value(), "every valid pose gives a request");
  if (!request) {
    handler.record_rejected(request.error());
    return;
  }
  const Packet request_packet = copy_of(*request);
  require(decodes<WrenchRequest>(request_packet), "the request for a pose decodes");
  send_request(request_packet, handler);
  WrenchResponse response;
  Packet force_torque;
  encode_force_torque(handler.handle(request_packet), response, force_torque);
  require(force_torque.size() == 8 + 8 + 6 * sizeof(double),
          "a response for one body converts to a force and a torque");
}

void check_counters(const RequestHandler& handler) {
  ServiceStatus status;
  status.version = "0";
  status.counters = handler.counters();
  const ServiceCounters& c = status.counters;
  require(c.requests == c.computed + c.retries + c.rejected(), "every packet is counted once");
  Packet bytes;
  encode(status, bytes);
  require(decodes<ServiceStatus>(bytes), "the status of any handler decodes");
}

void check(FuzzBytes bytes) {
  RequestHandler handler(small_scene(), {.max_sessions = 2, .threads = 1});
  PoseRequestAdapter poses(
      {.channels = {{.channel = "POSE", .body_id = 1, .force_torque_channel = "FORCE_TORQUE"}},
       .velocity_frame = VelocityFrame::kBody,
       .lead_time = 0.01},
      7);
  while (!bytes.empty()) {
    const Packet packet = next_packet(bytes);
    const int read_as = int{decodes<WrenchRequest>(packet)} + int{decodes<WrenchResponse>(packet)} +
                        int{decodes<BodiesHydrostatics>(packet)} + int{decodes<BodiesLoads>(packet)} +
                        int{decodes<ServiceStatus>(packet)} + int{decodes<WaterPoints>(packet)};
    require(read_as <= 1, "a packet decodes as at most one kind of message");
    send_request(packet, handler);
    send_pose(packet, poses, handler);
  }
  check_counters(handler);
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::FuzzBytes({data, size}));
  return 0;
}
