// The service keeps handling valid requests among malformed messages and packets.
#include <map>

#include <gtest/gtest.h>

#include "tests/engine/malformed_messages.h"
#include "tests/service/raw_lcm.h"
#include "tests/service/running_service.h"
#include "tests/support/contains.h"
#include "tests/support/process_memory.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

std::map<DecodeError, std::int64_t> rejected(const ServiceCounters& counters) {
  return {{DecodeError::kTruncated, counters.rejected_truncated},
          {DecodeError::kFingerprint, counters.rejected_fingerprint},
          {DecodeError::kCount, counters.rejected_count},
          {DecodeError::kLength, counters.rejected_length}};
}

void expect_response(RawLcmSocket& socket, std::int64_t seq, const std::string& after) {
  send_request(socket, one_body(1, seq, 0.0));
  EXPECT_EQ(receive(socket).id.seq, seq) << "after " << after;
}

class MalformedPackets : public testing::TestWithParam<std::string> {};

TEST_P(MalformedPackets, CountsThemByCauseAndHandlesNextRequest) {
  const std::vector<MalformedMessage> messages = malformed_messages();
  ASSERT_GE(messages.size(), 40U);
  RunningService service({"--mode", GetParam()});
  RawLcmSocket socket;
  std::map<DecodeError, std::int64_t> expected = rejected({});
  std::int64_t seq = 0;
  for (const MalformedMessage& message : messages) {
    socket.send("BUOYANCY_STATES", message.bytes);
    ++expected[message.error];
    expect_response(socket, ++seq, message.name);
  }
  const auto requests = static_cast<std::int64_t>(2 * messages.size());
  const auto status =
      wait_for_status(socket, [requests](const ServiceStatus& s) { return s.counters.requests == requests; });
  ASSERT_TRUE(status);
  EXPECT_EQ(rejected(status->counters), expected);
  EXPECT_EQ(status->counters.computed, seq);
  EXPECT_TRUE(service.child().wait_for_text("messages rejected", kWaitTimeout)) << service.log();
}

INSTANTIATE_TEST_SUITE_P(Modes, MalformedPackets, testing::Values("lockstep", "latest"),
                         [](const auto& mode) { return mode.param; });

TEST(MalformedPackets, IgnoresBytesThatAreNoLcmPacket) {
  RunningService service;
  RawLcmSocket socket;
  const std::vector<RawBytes> packets{
      {},
      {0},
      {'L', 'C', '0', '2'},
      {'L', 'C', '0', '2', 0, 0, 0, 0},
      {'L', 'C', '0', '2', 0, 0, 0, 0, 'B', 'U', 'O', 'Y'},
      {'L', 'C', '0', '2', 0, 0, 0, 0, 0},
      {'L', 'C', '0', '3', 0, 0, 0, 0},
      {'L', 'C', '0', '9', 0, 0, 0, 0, 'A', 0},
      RawBytes(60'000, 0xFF),
      RawBytes(60'000, 0),
  };
  std::int64_t seq = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    socket.send_packet(packets[i]);
    expect_response(socket, ++seq, "packet " + std::to_string(i));
  }
}

TEST(MalformedPackets, IgnoresPacketWithUnterminatedChannelName) {
  RunningService service;
  RawLcmSocket socket;
  // If the receiver reads past the end of a packet, it finds the end of the name in this one.
  socket.send_packet(RawBytes(60'000, 0));
  RawBytes packet{'L', 'C', '0', '2', 0, 0, 0, 0};
  for (const char c : std::string("BUOYANCY_STATES")) packet.push_back(static_cast<std::uint8_t>(c));
  socket.send_packet(packet);
  expect_response(socket, 1, "the packet");
  const auto status = wait_for_status(socket, [](const ServiceStatus& s) { return s.counters.requests > 0; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->counters.requests, 1);
}

TEST(MalformedPackets, DropsAndCountsFragmentsThatCrashLiblcm) {
  RunningService service;
  RawLcmSocket socket;
  constexpr std::int32_t kJustBelow4GB = -8;
  for (const std::int16_t number : {0, 1}) {
    RawWriter packet;
    packet.int32(0x4c433033).int32(77).int32(1'000).int32(kJustBelow4GB).int16(number).int16(2);
    const std::string channel("BUOYANCY_STATES\0", 16);
    packet.bytes.insert(packet.bytes.end(), channel.begin(), channel.end());
    packet.bytes.resize(packet.bytes.size() + 200, 0xAB);
    socket.send_packet(packet.bytes);
    expect_response(socket, 1 + number, "fragment " + std::to_string(number));
  }
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& s) { return s.fragments_dropped == 1; }))
      << "the second belongs to no message";
  EXPECT_TRUE(service.child().wait_for_text("fragments of incomplete", kWaitTimeout)) << service.log();
}

TEST(MalformedPackets, KeepsNoUnsubscribedChannelNameInMemory) {
  RunningService service;
  RawLcmSocket socket;
  constexpr int kNames = 50'000;
  constexpr std::int64_t kMaxGrowth = 1'024;  // [kB]; liblcm would take 126 bytes per name
  std::int64_t before = 0;
  for (int name = 0; name < 2 * kNames; ++name) {
    socket.send("SOMEBODY_ELSES_CHANNEL_" + std::to_string(name), {});
    if (name % 100 == 0) expect_response(socket, name, "names");
    if (name == kNames) before = resident_kb(service.child().pid());
  }
  EXPECT_LE(resident_kb(service.child().pid()) - before, kMaxGrowth);
}

TEST(MalformedPackets, LogsFloodOfMalformedMessagesInFewLines) {
  RunningService service;
  RawLcmSocket socket;
  constexpr int kMessages = 5'000;
  for (int i = 0; i < kMessages; ++i) {
    socket.send("BUOYANCY_STATES", {1, 2, 3});
    if (i % 100 == 99) expect_response(socket, i, "a flood");
  }
  service.child().send_signal(SIGTERM);
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0);
  const std::string log = service.log();
  EXPECT_TRUE(contains(log, "messages rejected"));
  EXPECT_LT(std::count(log.begin(), log.end(), '\n'), 100) << "at most one line per second";
}

}  // namespace
}  // namespace buoyancy
