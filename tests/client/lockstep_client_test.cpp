// What the clients take for a response and what not, against a peer that the test plays itself, over UDP
// multicast in a network namespace of each test's own.
#include "client/lockstep_client.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/client/fake_service.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

WrenchRequest request_number(std::int64_t seq) {
  WrenchRequest request;
  request.key = {1000 * seq, 77, seq};
  request.bodies.resize(2);
  request.bodies[0].body_id = 5;
  request.bodies[1].body_id = 6;
  return request;
}

LcmRequestChannel open_link() {
  return value_or_die(LcmRequestChannel::open({}));
}

const RetryPolicy kPatient{0.5, std::llround(2.0 * kWaitTimeout)};

TEST(LockstepClient, TakesOnlyTheAnswerToItsOwnQuestion) {
  const Peer peer([](const WrenchRequest& request) {
    WrenchResponse other_session = response_to(request, 1.0);
    other_session.key.session_id += 1;
    WrenchResponse earlier = response_to(request, 2.0);
    earlier.key.seq -= 1;
    WrenchResponse later = response_to(request, 3.0);
    later.key.seq += 1;
    std::vector<std::uint8_t> cut = bytes_of(response_to(request, 4.0));
    cut.pop_back();
    return Replies{bytes_of(other_session), bytes_of(earlier), bytes_of(later), cut,
                   bytes_of(response_to(request, 9.0))};
  });
  LockstepClient client(open_link(), kPatient);
  for (std::int64_t seq = 0; seq < 20; ++seq) {
    const Expected<const WrenchResponse*> response = client.request(request_number(seq));
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_EQ((*response)->key.seq, seq);
    EXPECT_EQ((*response)->bodies[1].force[2], 9.0);
  }
  EXPECT_EQ(client.statistics().requests, 20);
  EXPECT_EQ(client.statistics().round_trip.count(), 20);
}

TEST(LockstepClient, AsksAgainWithTheSameBytesUntilAnswered) {
  std::vector<std::int64_t> asked;
  const Peer peer([&](const WrenchRequest& request) {
    asked.push_back(request.key.seq);
    if (asked.size() < 4) return Replies{};
    return Replies{bytes_of(response_to(request, 9.0))};
  });
  LockstepClient client(open_link(), {0.1, 1000});
  ASSERT_TRUE(client.request(request_number(3)));
  EXPECT_GE(client.statistics().retries, 3);
  EXPECT_GE(peer.requests(), 4);
  EXPECT_EQ(client.statistics().unanswered, 0);
}

TEST(LockstepClient, SendsOnceAndRetriesTimesThenGivesUp) {
  const Peer peer([](const WrenchRequest&) { return Replies{}; });
  LockstepClient client(open_link(), {0.05, 3});
  const Expected<const WrenchResponse*> response = client.request(request_number(0));
  ASSERT_FALSE(response);
  EXPECT_NE(response.error().message().find(std::string(kStatesChannel)), std::string::npos);
  EXPECT_EQ(client.statistics().retries, 3);
  EXPECT_EQ(client.statistics().unanswered, 1);
}

TEST(LockstepClient, RefusesAnAnswerAboutOtherBodies) {
  for (const bool fewer : {true, false}) {
    const Peer peer([fewer](const WrenchRequest& request) {
      WrenchResponse response = response_to(request, 9.0);
      if (fewer) {
        response.bodies.pop_back();
      } else {
        response.bodies[1].body_id = 7;
      }
      return Replies{bytes_of(response)};
    });
    LockstepClient client(open_link(), kPatient);
    const Expected<const WrenchResponse*> response = client.request(request_number(0));
    ASSERT_FALSE(response);
    EXPECT_NE(response.error().message().find("other bodies"), std::string::npos)
        << response.error().message();
  }
}

TEST(FreeRunningClient, TakesTheNewestAnswerAndSaysByHowMuchItWasLate) {
  // Answers request 0 and then, to every request, the one three before: too late by three.
  const Peer peer([](const WrenchRequest& request) {
    WrenchRequest earlier = request;
    if (request.key.seq != 0) earlier.key.seq -= 3;
    return Replies{bytes_of(response_to(earlier, static_cast<double>(earlier.key.seq)))};
  });
  FreeRunningClient client(open_link(), kPatient, 0.05);
  for (std::int64_t seq = 0; seq <= 10; ++seq) {
    const Expected<const WrenchResponse*> response = client.request(request_number(seq));
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_LE((*response)->key.seq, std::max<std::int64_t>(0, seq - 3));
  }
  const ClientStats statistics = client.statistics();
  EXPECT_EQ(statistics.requests, 11);
  EXPECT_EQ(statistics.late, 10);
  EXPECT_GE(statistics.max_lag, 3);
  EXPECT_GE(statistics.unanswered, 3);
}

}  // namespace
}  // namespace buoyancy
