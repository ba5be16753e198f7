// What requests may cost the service, over UDP.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/service/running_service.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

const std::string kWavyScene = kTestWater + R"([water.waves]
type = "jonswap"
significant_wave_height = 1.0
peak_period = 5.0
[[body]]
id = 1
shape = { type = "box" }
[[body]]
id = 2
shape = { type = "rock", frequency = 20 }
tolerance = 1e-6
)";

WrenchRequest many_bodies(std::int32_t body, std::size_t bodies, std::int64_t session_id) {
  WrenchRequest states = one_body(session_id, 1, 0.0);
  states.bodies[0].body_id = body;
  states.bodies.resize(bodies, states.bodies[0]);
  for (std::size_t i = 0; i < bodies; ++i) states.bodies[i].position[2] = 1e-5 * static_cast<double>(i);
  return states;
}

TEST(Budgets, AnswersOtherSessionsDuringALongRequest) {
  RunningService service({"--threads", "1"}, kWavyScene);
  RawLcmSocket socket;
  send_request(socket, many_bodies(2, 10'000, 1));  // many seconds
  ASSERT_TRUE(wait_for_status(
      socket, [](const ServiceStatus& status) { return status.counters.requests_sliced == 1; }));
  for (std::int64_t seq = 1; seq <= 20; ++seq) {
    send_request(socket, one_body(2, seq, 0.0));
    EXPECT_EQ(receive(socket).id.session_id, 2);
  }
  service.child().send_signal(SIGTERM);
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0) << service.log();
  EXPECT_TRUE(contains(service.log(), "not answered, because they take several slices of time: 1 request"));
}

TEST(Budgets, AnswersEveryRequestOfASessionInOrder) {
  const RunningService service({"--threads", "1"}, kWavyScene);
  RawLcmSocket socket;
  WrenchRequest states = many_bodies(2, 300, 1);
  for (; states.id.seq <= 3; ++states.id.seq) send_request(socket, states);
  for (std::int64_t seq = 1; seq <= 3; ++seq) EXPECT_EQ(receive(socket).id.seq, seq);
}

TEST(Budgets, AnswersTheNewestRequestOfALongOneInModeLatest) {
  const RunningService service({"--threads", "1", "--mode", "latest"}, kWavyScene);
  RawLcmSocket socket;
  WrenchRequest states = many_bodies(2, 300, 1);
  for (; states.id.seq <= 3; ++states.id.seq) send_request(socket, states);
  std::int64_t newest = 0;
  while (newest != 3) newest = receive(socket).id.seq;
}

TEST(Budgets, RejectsARequestThatRepeatsABodyTooOften) {
  const RunningService service({}, kWavyScene);
  RawLcmSocket socket;
  send_request(socket, many_bodies(1, 10'003, 1));
  ASSERT_TRUE(wait_for_status(
      socket, [](const ServiceStatus& status) { return status.counters.rejected_bodies == 1; }));
  send_request(socket, many_bodies(1, 10'002, 1));
  EXPECT_EQ(receive(socket).bodies.size(), 10'002U);
}

TEST(Budgets, LogsManySessionsInFewLines) {
  constexpr std::int64_t kSessions = 500;
  RunningService service({"--log-level", "debug"}, kWavyScene);
  RawLcmSocket socket;
  for (std::int64_t session = 1; session <= kSessions; ++session) {
    send_request(socket, one_body(session, 1, 0.0));
    EXPECT_EQ(receive(socket).id.session_id, session);
  }
  ASSERT_TRUE(service.child().wait_for_text("sessions started", kWaitTimeout)) << service.log();
  service.child().send_signal(SIGTERM);
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0) << service.log();
  const std::string log = service.log();
  EXPECT_LT(std::ranges::count(log, '\n'), kSessions / 5) << log;
}

TEST(Budgets, OutOfMemoryCostsTheRequest) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer needs more address space than any limit";
#endif
  RunningService service({"--threads", "1"}, kWavyScene);
  RawLcmSocket socket;
  send_request(socket, one_body(1, 1, 0.0));
  receive(socket);
  // No more address space than it has: what the heap holds is enough for a request of one body.
  const rlimit none{.rlim_cur = 1'000'000, .rlim_max = RLIM_INFINITY};
  ASSERT_EQ(::prlimit(service.child().pid(), RLIMIT_AS, &none, nullptr), 0);
  for (std::int64_t session = 2; session < 12; ++session)
    send_request(socket, many_bodies(1, 9'000, session));
  ASSERT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    return status.counters.rejected_memory + status.fragments_dropped > 0;
  })) << service.log();
  send_request(socket, one_body(1, 2, 0.0));
  while (receive(socket).id.seq != 2) {
  }
  service.child().send_signal(SIGTERM);
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0) << service.log();
}

}  // namespace
}  // namespace buoyancy
