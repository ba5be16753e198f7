// What is no question must not keep the service from answering those that are.
#include <map>

#include <gtest/gtest.h>

#include "tests/exchange/malformed_messages.h"
#include "tests/service/raw_lcm.h"
#include "tests/service/running_service.h"

namespace buoyancy {
namespace {

std::map<Rejection, std::int64_t> rejected(const Counters& counters) {
  return {{Rejection::kTruncated, counters.rejected_truncated},
          {Rejection::kFingerprint, counters.rejected_fingerprint},
          {Rejection::kCount, counters.rejected_count},
          {Rejection::kLength, counters.rejected_length}};
}

void expect_an_answer(RawLcmSocket& socket, std::int64_t seq, const std::string& after) {
  ask(socket, one_body(1, seq, 0.0));
  EXPECT_EQ(hear(socket).seq, seq) << "after " << after;
}

class HostilePackets : public testing::TestWithParam<std::string> {};

TEST_P(HostilePackets, EveryMalformedMessageIsCountedByItsCauseAndTheNextQuestionAnswered) {
  const std::vector<MalformedMessage> messages = malformed_messages();
  ASSERT_GE(messages.size(), 40U);
  RunningService service({"--mode", GetParam()});
  RawLcmSocket socket;
  std::map<Rejection, std::int64_t> expected = rejected({});
  std::int64_t seq = 0;
  for (const MalformedMessage& message : messages) {
    socket.send("BUOYANCY_STATES", message.bytes);
    ++expected[message.cause];
    expect_an_answer(socket, ++seq, message.name);
  }
  const auto asked = static_cast<std::int64_t>(2 * messages.size());
  const auto status =
      hear_status(socket, [asked](const ServiceStatus& s) { return s.counters.questions == asked; });
  ASSERT_TRUE(status);
  EXPECT_EQ(rejected(status->counters), expected);
  EXPECT_EQ(status->counters.answered, seq);
  EXPECT_TRUE(service.child().wait_for_text("messages rejected", kPatience)) << service.log();
}

INSTANTIATE_TEST_SUITE_P(Modes, HostilePackets, testing::Values("lockstep", "latest"),
                         [](const auto& mode) { return mode.param; });

TEST(HostilePackets, BytesThatAreNoLcmPacketLeaveTheServiceAnswering) {
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
    expect_an_answer(socket, ++seq, "packet " + std::to_string(i));
  }
}

TEST(HostilePackets, APacketThatEndsBeforeItsChannelsNameDoesIsAMessageWithoutBytes) {
  RunningService service;
  RawLcmSocket socket;
  // The name's end is what liblcm finds behind the packet: what the packet before left there, which it threw
  // away and received the next one over.
  socket.send_packet(RawBytes(60'000, 0));
  RawBytes packet{'L', 'C', '0', '2', 0, 0, 0, 0};
  for (const char c : std::string("BUOYANCY_STATES")) packet.push_back(static_cast<std::uint8_t>(c));
  socket.send_packet(packet);
  expect_an_answer(socket, 1, "the packet");
  const auto status = hear_status(socket, [](const ServiceStatus& s) { return s.counters.questions == 2; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->counters.rejected_truncated, 1) << "and not read for gigabytes behind the packet";
}

TEST(HostilePackets, AFloodOfMalformedMessagesBecomesAFewLinesOfLog) {
  RunningService service;
  RawLcmSocket socket;
  constexpr int kMessages = 5'000;
  for (int i = 0; i < kMessages; ++i) {
    socket.send("BUOYANCY_STATES", {1, 2, 3});
    if (i % 100 == 99) expect_an_answer(socket, i, "a flood");
  }
  service.child().send_signal(SIGTERM);
  EXPECT_EQ(service.child().wait(kPatience), 0);
  const std::string log = service.log();
  EXPECT_NE(log.find("messages rejected"), std::string::npos);
  EXPECT_LT(std::count(log.begin(), log.end(), '\n'), 100) << "one line a second at most";
}

}  // namespace
}  // namespace buoyancy
