// Sends malformed packets to a running buoyancyd and checks its responses, counters and memory.
//
//   malformed_traffic [--packets N] [--seed S] [--channel-names N]
//
// Sends N packets in batches, each followed by a valid request that must get its response. A packet is a
// randomly corrupted request, one of the malformed messages of the test suite, a fragment of a message that
// is never completed, bytes with an invalid LCM header, or a message on an unsubscribed channel. Then the
// counters of the service are compared with the packets sent, by cause, and its memory before and after.
//
// With --channel-names, sends that many messages on channels of different names afterwards and checks that
// the service keeps none of the names.
//
// Run it in a network namespace with a multicast route (scripts/attack packets). Exit status: 0 if every
// request got its response, the counters match and memory did not grow; 1 if not; 2 on invalid arguments.
#include <algorithm>
#include <array>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/progress_bar.h"
#include "cli/tool_command_line.h"
#include "client/client.h"
#include "tests/engine/malformed_messages.h"
#include "tests/service/running_service.h"
#include "tests/support/process_memory.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kBatch = 64;         // packets between two requests; the queues hold far more
constexpr std::int64_t kWarmUp = 250'000;   // packets until every buffer has its final size
constexpr std::int64_t kMaxGrowth = 1'024;  // [kB]

struct Rejected {
  std::int64_t truncated = 0, fingerprint = 0, count = 0, length = 0;
};

// The packets sent, by their expected effect.
struct Sent {
  Rejected rejected;
  std::int64_t requests = 0;   // corrupted, but still valid: handled
  std::int64_t unrelated = 0;  // not delivered to the service: another channel or an incomplete message

  std::int64_t on_channel() const {
    return rejected.truncated + rejected.fingerprint + rejected.count + rejected.length + requests;
  }
};

// Counts the effect that docs/messages.md specifies, implemented independently of the service.
void count_expected(const RawBytes& message, Sent& sent) {
  constexpr std::size_t kFixed = 44;
  constexpr std::size_t kBody = 108;
  if (message.size() < kFixed) {
    ++sent.rejected.truncated;
    return;
  }
  static const RawBytes kValid = encoded(WrenchRequest{});
  RawReader reader(message);
  for (int i = 0; i < 10; ++i) reader.int32();
  const std::int64_t count = reader.int32();
  if (!std::equal(kValid.begin(), kValid.begin() + 8, message.begin())) {  // the fingerprint
    ++sent.rejected.fingerprint;
  } else if (count < 0) {
    ++sent.rejected.count;
  } else if (message.size() != kFixed + kBody * static_cast<std::size_t>(count)) {
    ++sent.rejected.length;
  } else {
    ++sent.requests;
  }
}

class Attacker {
 public:
  Attacker(RawLcmSocket& socket, std::uint64_t seed) : socket_(socket), random_(seed) {
    for (const MalformedMessage& message : malformed_messages()) malformed_.push_back(message.bytes);
  }

  void send() {
    switch (below(8)) {
      case 0:
        return send_on_request_channel(malformed_[below(malformed_.size())]);
      case 1:
        return send_fragment();
      case 2:
        return send_wrong_header();
      case 3: {
        ++sent_.unrelated;
        const std::string channel = "OTHER_" + std::to_string(below(100));
        return socket_.send(channel, garbage(below(200)));
      }
      default:
        return send_on_request_channel(corrupted(valid_request()));
    }
  }

  const Sent& sent() const { return sent_; }

 private:
  std::size_t below(std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_);
  }
  std::uint8_t byte() { return static_cast<std::uint8_t>(below(256)); }

  RawBytes garbage(std::size_t size) {
    RawBytes bytes(size);
    for (std::uint8_t& value : bytes) value = byte();
    return bytes;
  }

  RawBytes valid_request() {
    const auto session_id = static_cast<std::int64_t>(100 + below(200));
    const auto seq = static_cast<std::int64_t>(below(1000));
    WrenchRequest states = one_body(session_id, seq, 0.01 * static_cast<double>(below(100)));
    states.bodies.resize(below(5), states.bodies[0]);
    return encoded(states);
  }

  RawBytes corrupted(RawBytes bytes) {
    switch (below(7)) {
      case 0:  // random bits
        for (std::size_t i = 0; i <= below(8); ++i) {
          bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1U << below(8));
        }
        break;
      case 1:
        bytes.resize(below(bytes.size()));
        break;
      case 2: {
        const RawBytes more = garbage(1 + below(300));
        bytes.insert(bytes.end(), more.begin(), more.end());
        break;
      }
      case 3:  // the number of bodies
        for (std::size_t i = 40; i < 44; ++i) bytes[i] = byte();
        break;
      case 4:  // the fingerprint
        bytes[below(8)] = byte();
        break;
      case 5:  // everything after the fixed fields: NaN, infinities, any body
        for (std::size_t i = 44; i < bytes.size(); ++i) bytes[i] = byte();
        break;
      default:  // bytes removed from the middle
        const std::size_t start = below(bytes.size());
        const std::size_t end = start + below(bytes.size() - start + 1);
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(start),
                    bytes.begin() + static_cast<std::ptrdiff_t>(end));
        break;
    }
    return bytes;
  }

  void send_on_request_channel(const RawBytes& message) {
    count_expected(message, sent_);
    socket_.send("BUOYANCY_STATES", message);
  }

  // The message of the fragment is never completed.
  void send_fragment() {
    ++sent_.unrelated;
    const auto size = static_cast<std::int32_t>(below(2) == 0 ? below(1'000'000) : random_());
    const auto count = static_cast<std::int16_t>(below(20) == 0 ? random_() : 2 + below(30));
    const auto number = static_cast<std::int16_t>(below(2) == 0 ? 0 : below(40));
    // Offsets just below 2^32 crash liblcm.
    const auto offset = static_cast<std::int32_t>(below(2) == 0 ? below(2'000'000) : ~below(100));
    RawWriter packet;
    packet.int32(0x4c433033).int32(static_cast<std::int32_t>(random_())).int32(size).int32(offset);
    packet.int16(number).int16(count);
    for (const char c : std::string("BUOYANCY_STATES")) packet.bytes.push_back(static_cast<std::uint8_t>(c));
    packet.bytes.push_back(0);
    const RawBytes rest = garbage(below(400));
    packet.bytes.insert(packet.bytes.end(), rest.begin(), rest.end());
    socket_.send_packet(packet.bytes);
  }

  void send_wrong_header() {
    static constexpr std::array<std::uint8_t, 4> kMagic{'L', 'C', '0', '2'};
    RawBytes packet = garbage(below(64));
    switch (below(3)) {
      case 0:  // no LCM header, or part of one
        std::copy_n(kMagic.begin(), std::min(below(4), packet.size()), packet.begin());
        ++sent_.unrelated;
        break;
      case 1:  // a channel name that is too long
        packet.assign(kMagic.begin(), kMagic.end());
        packet.resize(8 + 64 + below(200), 'N');
        packet.push_back(0);
        ++sent_.unrelated;
        break;
      default:  // the request channel's name or part of it, unterminated and without data
        const std::string name = "BUOYANCY_STATES";
        packet.assign(kMagic.begin(), kMagic.end());
        packet.resize(8);
        packet.insert(packet.end(), name.begin(), name.end() - static_cast<std::ptrdiff_t>(below(3)));
        ++sent_.unrelated;
        break;
    }
    socket_.send_packet(packet);
  }

  RawLcmSocket& socket_;
  std::mt19937_64 random_;
  std::vector<RawBytes> malformed_;
  Sent sent_;
};

// A lock-step client with retries. Throws if a request gets no response or a wrong one.
class CheckedClient {
 public:
  void send_request() {
    const double height = 0.001 * static_cast<double>(++requests_ % 1000);
    BodyState state{.body_id = 1,
                    .position = {1.0, 2.0, height},
                    .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0},
                    .linear_velocity = {},
                    .angular_velocity = {}};
    const auto response = client_.request(requests_, {&state, 1});
    if (!response) throw std::runtime_error(response.error().message());
    const double force = kDensity * kGravity * 6.0 * (2.0 - height);
    if (std::abs((*response)->bodies[0].force[2] - force) > 1e-9 * force) {
      throw std::runtime_error("request " + std::to_string(requests_) + " got a wrong response");
    }
  }

  std::int64_t sent() const { return requests_ + retries(); }
  std::int64_t requests() const { return requests_; }
  std::int64_t retries() const { return client_.statistics().retries; }

 private:
  static Client open() {
    Expected<Client> client = Client::open();
    if (!client) throw std::runtime_error(client.error().message());
    return std::move(*client);
  }

  Client client_ = open();
  std::int64_t requests_ = 0;
};

bool print_row(const char* what, std::int64_t sent, std::int64_t counted) {
  const bool holds = counted == sent;
  std::printf("%-28s %12" PRId64 " %12" PRId64 "  %s\n", what, sent, counted, holds ? "" : "DIFFERS");
  return holds;
}

bool counters_add_up(const ServiceCounters& counters, const Sent& sent, const CheckedClient& client) {
  std::printf("%-28s %12s %12s\n", "", "sent", "counted");
  bool holds = print_row("rejected_truncated", sent.rejected.truncated, counters.rejected_truncated);
  holds &= print_row("rejected_fingerprint", sent.rejected.fingerprint, counters.rejected_fingerprint);
  holds &= print_row("rejected_count", sent.rejected.count, counters.rejected_count);
  holds &= print_row("rejected_length", sent.rejected.length, counters.rejected_length);
  holds &=
      print_row("computed and retries", sent.requests + client.sent(), counters.computed + counters.retries);
  holds &= print_row("requests", sent.on_channel() + client.sent(), counters.requests);
  holds &= print_row("requests, sum of the above", counters.rejected() + counters.computed + counters.retries,
                     counters.requests);
  std::printf("%-28s %12" PRId64 "\n%-28s %12s %12" PRId64 "\n", "not delivered to the service",
              sent.unrelated, "sessions evicted", "", counters.sessions_evicted);
  return holds;
}

// Does the memory of the service stay the same while channel names change?
bool keeps_no_names(RawLcmSocket& socket, CheckedClient& client, RunningService& service,
                    std::int64_t names) {
  const std::int64_t before = resident_kb(service.child().pid());
  const auto start = std::chrono::steady_clock::now();
  {
    ProgressBar progress("names");
    for (std::int64_t name = 0; name < names; ++name) {
      socket.send("SOMEBODY_ELSES_CHANNEL_" + std::to_string(name), {});
      if (name % kBatch == 0) {
        client.send_request();
        progress.update(name, names, name);
      }
    }
  }
  client.send_request();
  const double duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::int64_t after = resident_kb(service.child().pid());
  const bool flat = after - before <= kMaxGrowth;
  std::printf("\n%" PRId64 " channel names in %.1f s: memory %" PRId64 " kB before, %" PRId64 " kB after%s\n",
              names, duration, before, after, flat ? "" : ": GROWS");
  return flat;
}

bool run(std::int64_t packets, std::uint64_t seed, std::int64_t names) {
  RunningService service;
  RawLcmSocket socket;
  Attacker attacker(socket, seed);
  CheckedClient client;
  std::int64_t warm = 0;
  const auto start = std::chrono::steady_clock::now();
  {
    ProgressBar progress("packets");
    for (std::int64_t packet = 1; packet <= packets; ++packet) {
      attacker.send();
      if (packet % kBatch != 0 && packet != packets) continue;
      client.send_request();
      progress.update(packet, packets, packet);
      if (warm == 0 && packet >= std::min(kWarmUp, packets / 2)) warm = resident_kb(service.child().pid());
    }
  }
  const double duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::int64_t after = resident_kb(service.child().pid());
  std::printf("%" PRId64 " packets, seed %" PRIu64 ", in %.1f s; %" PRId64
              " requests between them, all with a response, %" PRId64 " retries\n",
              packets, seed, duration, client.requests(), client.retries());
  const std::int64_t min_requests = attacker.sent().on_channel() + client.sent();
  RawLcmSocket status_socket;  // the buffer of the other socket is full of its own packets
  const auto status = wait_for_status(status_socket, [min_requests](const ServiceStatus& now) {
    return now.counters.requests >= min_requests;
  });
  if (!status)
    throw std::runtime_error("the counters of the service stay below the packets sent: packets were lost");
  bool holds = counters_add_up(status->counters, attacker.sent(), client);
  const bool flat = after - warm <= kMaxGrowth;
  std::printf("memory (VmRSS): %" PRId64 " kB after the first %" PRId64 " packets, %" PRId64
              " kB at the end%s\n",
              warm, std::min(kWarmUp, packets / 2), after, flat ? "" : ": GROWS");
  holds &= flat;
  if (names > 0) holds &= keeps_no_names(socket, client, service, names);
  service.child().send_signal(SIGTERM);
  if (service.child().wait(kWaitTimeout) != 0)
    throw std::runtime_error("buoyancyd did not exit with 0: " + service.log());
  return holds;
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  buoyancy::ToolCommandLine command_line("Send malformed packets to a running buoyancyd",
                                         "malformed_traffic");
  std::int64_t packets = 3'000'000;
  std::uint64_t seed = 1;
  std::int64_t names = 1'000'000;
  command_line.add_number("--packets", packets, std::int64_t{1}, std::int64_t{1} << 40U, "Number of packets");
  command_line.add_option("--seed", seed, "Seed of the random numbers");
  command_line.add_number("--channel-names", names, std::int64_t{0}, std::int64_t{1} << 40U,
                          "Number of different channel names sent afterwards");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  try {
    return buoyancy::run(packets, seed, names) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "malformed_traffic: %s\n", error.what());
    return 1;
  }
}
