// Scenes whose messages meet the limits of LCM over UDP: what buoyancyd says before anything is lost, and
// what it says when something was.
#include <csignal>
#include <string>

#include <gtest/gtest.h>

#include "tests/service/running_service.h"
#include "tests/support/contains.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

const std::string kSmallBuffer = "udpm://239.255.76.67:7667?recv_buf_size=100000";

std::string boxes(int bodies) {
  std::string text;
  for (int id = 1; id <= bodies; ++id) {
    text += "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = [1, 1, 1] }\n";
  }
  return text;
}

WrenchRequest all_bodies(int bodies, std::int64_t seq) {
  WrenchRequest states = one_body(5, seq, 0.0);
  states.bodies.resize(static_cast<std::size_t>(bodies), states.bodies[0]);
  for (int i = 0; i < bodies; ++i) states.bodies[static_cast<std::size_t>(i)].body_id = i + 1;
  return states;
}

FinishedProcess check(const std::string& scene, const std::string& url) {
  const TempDir directory;
  return run_program("buoyancyd", {"--scene", directory.write("scene.toml", scene), "--check", "-l", url});
}

// The line of the report or of the log that contains `text`, or "".
std::string line_with(const std::string& text, const std::string& lines) {
  const std::size_t at = lines.find(text);
  if (at == std::string::npos) return "";
  const std::size_t begin = lines.rfind('\n', at) + 1;
  return lines.substr(begin, lines.find('\n', at) - begin);
}

TEST(LargeScene, WarnsBeforeRequestsThatReceiveBufferDoesNotHold) {
  const std::string scene = boxes(100'000);
  const std::string url = "udpm://239.255.76.67:7667?recv_buf_size=200000";
  const FinishedProcess checked = check(scene, url);
  EXPECT_EQ(checked.exit_code, 0) << "smaller requests work";
  const std::string warning = line_with("warning: ", checked.standard_output);
  for (const char* part : {"request for all 100000 bodies: a message of 10800044 bytes in 165 packets",
                           "at most 200000 bytes", "set it to 11534336", "in 55 requests or more"}) {
    EXPECT_TRUE(contains(warning, part));
  }
  const RunningService service({"-l", url}, scene);
  const std::string log = service.log();
  EXPECT_TRUE(contains(log, warning.substr(warning.find("request for"))));
  EXPECT_LT(log.find("request for all"), log.find("ready:")) << log;
}

TEST(LargeScene, WarnsBeforeRequestsThatNoMessageCarries) {
  const FinishedProcess checked = check(boxes(160'000), "");
  EXPECT_EQ(checked.exit_code, 0);
  const std::string warning = line_with("warning: ", checked.standard_output);
  EXPECT_TRUE(contains(
      warning, "request for all 160000 bodies: a message of 17280044 bytes; expected at most 16777216"));
}

TEST(LargeScene, EvaluatesRequestThatArrivedWholeBeforeItWasRead) {
  constexpr int kBodies = 45'000;  // 4.9 MB, more than the receive buffer of a small scene
  RunningService service({}, boxes(kBodies));
  if (service.log().find("may be lost") != std::string::npos) {
    GTEST_SKIP() << "the kernel grants this user no receive buffer of 5 MB: run as root, or raise "
                    "net.core.rmem_max";
  }
  RawLcmSocket socket;
  service.stop();
  send_request(socket, all_bodies(kBodies, 1));
  service.child().send_signal(SIGCONT);
  const auto status = wait_for_status(
      socket, [](const ServiceStatus& now) { return now.counters.computed + now.packets_dropped > 0; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->packets_dropped, 0);
  EXPECT_EQ(status->counters.bodies_crossing + status->counters.bodies_dry + status->counters.bodies_wet,
            kBodies);
}

TEST(LargeScene, CountsAndLogsPacketsThatReceiveBufferDidNotHold) {
  constexpr int kBodies = 3'000;  // 5 packets, of which the buffer holds 3 or 4
  RunningService service({"-l", kSmallBuffer}, boxes(kBodies));
  RawLcmSocket socket;
  service.stop();
  send_request(socket, all_bodies(kBodies, 1));
  service.child().send_signal(SIGCONT);
  // The kernel reports what it dropped with the next packet.
  WrenchRequest fewer = all_bodies(kBodies, 2);
  fewer.bodies.resize(500);
  std::optional<RawBytes> response;
  for (double waited = 0.0; !response && waited < kWaitTimeout; waited += 0.2) {
    send_request(socket, fewer);  // the buffer is full until the service reads it
    response = receive_bytes(socket, 0.2);
  }
  ASSERT_TRUE(response);
  EXPECT_EQ(decoded<WrenchResponse>(*response).id.seq, 2)
      << "the large request is lost, the small one gets its response";
  const auto status =
      wait_for_status(socket, [](const ServiceStatus& now) { return now.packets_dropped > 0; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->counters.computed, 1);
  ASSERT_TRUE(service.child().wait_for_text("packets dropped by the kernel", kWaitTimeout)) << service.log();
  const std::string line = line_with("packets dropped by the kernel", service.log());
  EXPECT_TRUE(contains(line, "leave recv_buf_size out of the LCM URL"));
}

TEST(LargeScene, WarnsWhenReloadMakesSceneTooLarge) {
  RunningService service({"-l", kSmallBuffer}, boxes(900));
  EXPECT_FALSE(contains(service.log(), "request for all"));
  for (const auto& [bodies, bytes] : {std::pair{1'000, "108044"}, {1'100, "118844"}}) {  // and once more
    service.write("scene.toml", boxes(bodies));
    service.child().send_signal(SIGHUP);
    EXPECT_TRUE(service.child().wait_for_text(
        "request for all " + std::to_string(bodies) + " bodies: a message of " + bytes, kWaitTimeout))
        << service.log();
  }
}

}  // namespace
}  // namespace buoyancy
