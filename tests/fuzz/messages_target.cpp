// Bytes as packets from the network: every decoder on every packet, and an exchange with a small scene that
// is asked all of them one after another, as questions and as bot_core's poses. What decodes must encode to
// the same bytes; what is a question must be answered in its form, a repeat with the same bytes, and as an
// exchange would that never saw the others.
//
//   each packet   1 byte: bits 0-2 a kind of message (0 question, 1 answer, 2 hydrostatics, 3 status, else
//                 none), bit 3 its fingerprint is written over the packet's head, bit 4 the number of bodies
//                 that fits the length is written to its place
//                 2 bytes: the packet's length, little-endian; then so many bytes, or all that are left
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

namespace buoyancy {
namespace {

using Packet = std::vector<std::uint8_t>;

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
)";

const Scene& small_scene() {
  static const Scene kPrepared = [] {
    const Expected<SceneDescription> description = parse_scene(kScene, "fuzz.toml", "/nowhere");
    if (!description) broken_law("the target's own scene is one", description.error().message());
    Expected<Scene> scene = Scene::prepare(*description);
    if (!scene) broken_law("the target's own scene is prepared", scene.error().message());
    return *std::move(scene);
  }();
  return kPrepared;
}

// A kind of message without bodies, as a template: its fingerprint is its first eight bytes, the number of
// its bodies its last four, and a body takes so many.
struct Kind {
  Packet empty;
  std::size_t body_size;
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

const std::array<Kind, 4>& kinds() {
  static const std::array<Kind, 4> kKinds = [] {
    Kind status{.empty = {}, .body_size = 0};
    encode(ServiceStatus{}, status.empty);
    return std::array<Kind, 4>{kind_of<Question>(), kind_of<Answer>(), kind_of<BodiesHydrostatics>(), status};
  }();
  return kKinds;
}

void write_fingerprint(const Kind& kind, Packet& packet) {
  const std::size_t size = std::min(packet.size(), sizeof(std::int64_t));
  std::copy_n(kind.empty.begin(), size, packet.begin());
}

// Leaves what is over after the last whole body.
void write_count(const Kind& kind, Packet& packet) {
  const std::size_t fixed = kind.empty.size();
  if (kind.body_size == 0 || packet.size() < fixed) return;
  const std::size_t bodies = (packet.size() - fixed) / kind.body_size;
  packet.resize(fixed + bodies * kind.body_size);
  for (std::size_t i = 0; i < 4; ++i) {
    packet[fixed - 1 - i] = static_cast<std::uint8_t>(bodies >> (8 * i));
  }
}

Packet next_packet(FuzzBytes& bytes) {
  const unsigned options = bytes.byte();
  const std::size_t length = bytes.word();
  const Bytes taken = bytes.take(length);
  Packet packet(taken.begin(), taken.end());
  const std::size_t number = options & 7U;
  if (number < kinds().size()) {
    const Kind& kind = kinds()[number];
    if ((options & 8U) != 0) write_fingerprint(kind, packet);
    if ((options & 16U) != 0) write_count(kind, packet);
  }
  return packet;
}

template <typename Message>
bool decodes(const Packet& packet) {
  Message message;
  if (decode(packet, message)) return false;
  Packet again;
  encode(message, again);
  law(again == packet, "what was decoded encodes to the same bytes");
  return true;
}

template <std::size_t kSize>
bool finite(const std::array<double, kSize>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

void check_wrench(const BodyWrench& wrench) {
  law(finite(wrench.force) && finite(wrench.torque) && finite(wrench.center_of_buoyancy) &&
          std::isfinite(wrench.submerged_volume),
      "a wrench holds numbers");
  if (wrench.status == BodyStatus::kOk) return;
  const std::array<double, 3> zero{};
  law(wrench.force == zero && wrench.torque == zero && wrench.center_of_buoyancy == zero &&
          wrench.submerged_volume == 0.0 && wrench.force_error_bound == 0.0 &&
          wrench.torque_error_bound == 0.0,
      "a body that is not answered carries zeros");
}

bool same(const QuestionKey& a, const QuestionKey& b) {
  return a.utime == b.utime && a.session_id == b.session_id && a.seq == b.seq;
}

void check_answer(const Question& question, Bytes bytes) {
  Answer answer;
  law(!decode(bytes, answer), "an answer is a message of ours");
  law(same(answer.key, question.key), "an answer carries its question's key");
  law(answer.bodies.size() == question.bodies.size(), "an answer has its question's bodies");
  for (std::size_t i = 0; i < answer.bodies.size(); ++i) {
    law(answer.bodies[i].body_id == question.bodies[i].body_id, "bodies keep their order");
    check_wrench(answer.bodies[i]);
  }
}

void check_hydrostatics(const Question& question, Bytes bytes) {
  const Scene& scene = small_scene();
  std::vector<std::int32_t> asking;
  for (const BodyState& state : question.bodies) {
    const Body* body = scene.find(state.body_id);
    if (body != nullptr && body->hydrostatics) asking.push_back(body->id);
  }
  law(bytes.empty() == asking.empty(), "hydrostatics are there where a body asks");
  if (bytes.empty()) return;
  BodiesHydrostatics hydrostatics;
  law(!decode(bytes, hydrostatics), "hydrostatics are a message of ours");
  law(same(hydrostatics.key, question.key), "hydrostatics carry their question's key");
  law(std::equal(asking.begin(), asking.end(), hydrostatics.bodies.begin(), hydrostatics.bodies.end(),
                 [](std::int32_t id, const BodyHydrostatics& body) { return id == body.body_id; }),
      "hydrostatics are of the bodies that ask");
}

Packet copy_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

// session: one that is asked all packets.
void ask(const Packet& packet, Exchange& session) {
  const auto key = peek_key(packet);
  Question question;
  const std::optional<Rejection> rejection = decode(packet, question);
  law(key.has_value() == !rejection, "peek_key() and decode() agree on what is a question");
  const Packet answer = copy_of(session.answer(packet));
  const Packet hydrostatics = copy_of(session.hydrostatics());
  if (rejection) {
    law(key.error() == *rejection, "peek_key() and decode() agree on what is wrong");
    law(answer.empty() && hydrostatics.empty(), "what is no question is not answered");
    return;
  }
  law(same(*key, question.key), "peek_key() finds the question's key");
  check_answer(question, answer);
  check_hydrostatics(question, hydrostatics);
  law(copy_of(session.answer(packet)) == answer && copy_of(session.hydrostatics()) == hydrostatics,
      "a repeat gets the same bytes");
  Exchange fresh(small_scene(), {.max_sessions = 1, .threads = 1});
  law(copy_of(fresh.answer(packet)) == answer && copy_of(fresh.hydrostatics()) == hydrostatics,
      "an answer does not depend on earlier questions");
}

// As a pose on a channel of its own.
void ask_pose(const Packet& packet, PoseQuestions& poses, Exchange& session) {
  const auto question = poses.question(0, packet);
  law(question.has_value() == decode_bot_pose(packet).has_value(), "a pose asks a question");
  if (!question) {
    session.count_rejected(question.error());
    return;
  }
  const Packet asked = copy_of(*question);
  law(decodes<Question>(asked), "what a pose asks is a question of ours");
  ask(asked, session);
  Answer answer;
  Packet force_torque;
  force_torque_of(session.answer(asked), answer, force_torque);
  law(force_torque.size() == 8 + 8 + 6 * sizeof(double), "an answer about one body is a force and a torque");
}

void check_counters(const Exchange& exchange) {
  ServiceStatus status;
  status.version = "0";
  status.counters = exchange.counters();
  const Counters& c = status.counters;
  law(c.questions == c.answered + c.repeated + c.rejected(), "every packet is counted once");
  Packet bytes;
  encode(status, bytes);
  law(decodes<ServiceStatus>(bytes), "the status of any exchange is a message of ours");
}

void check(FuzzBytes bytes) {
  Exchange exchange(small_scene(), {.max_sessions = 2, .threads = 1});
  PoseQuestions poses(
      {.channels = {{.channel = "POSE", .body_id = 1, .force_torque_channel = "FORCE_TORQUE"}},
       .velocity_frame = VelocityFrame::kBody,
       .lead_time = 0.01},
      7);
  while (!bytes.empty()) {
    const Packet packet = next_packet(bytes);
    const int read_as = int{decodes<Question>(packet)} + int{decodes<Answer>(packet)} +
                        int{decodes<BodiesHydrostatics>(packet)} + int{decodes<ServiceStatus>(packet)};
    law(read_as <= 1, "a packet is one kind of message");
    ask(packet, exchange);
    ask_pose(packet, poses, exchange);
  }
  check_counters(exchange);
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::FuzzBytes({data, size}));
  return 0;
}
