// Tests which messages the client accepts as a response, against a fake service.
#include "client/lockstep_client.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/client/fake_service.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

TEST(LockstepClient, AcceptsOnlyResponseToItsRequest) {
  const FakeService service([](const WrenchRequest& request) {
    WrenchResponse other_session = response_to(request, 1.0);
    other_session.id.session_id += 1;
    WrenchResponse earlier = response_to(request, 9.0);  // as it was answered
    earlier.id.seq -= 1;
    WrenchResponse later = response_to(request, 3.0);
    later.id.seq += 1;
    std::vector<std::uint8_t> cut = encoded(response_to(request, 4.0));
    cut.pop_back();
    std::vector<std::uint8_t> foreign = encoded(response_to(request, 5.0));
    foreign[0] ^= 0xFFU;
    return Responses{encoded(other_session),
                     encoded(earlier),
                     encoded(later),
                     cut,
                     foreign,
                     encoded(response_to(request, 9.0))};
  });
  LockstepClient client(open_channel(), kTestRetryPolicy);
  for (std::int64_t seq = 0; seq < 20; ++seq) {
    const Expected<const WrenchResponse*> response = client.request(make_request(seq));
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_EQ((*response)->id.seq, seq);
    EXPECT_EQ((*response)->bodies[1].force[2], 9.0);
  }
  EXPECT_EQ(client.statistics().requests, 20);
  EXPECT_EQ(client.statistics().round_trip.count(), 20);
  EXPECT_GE(client.statistics().malformed, 40);  // more if the machine is so slow that it retries
}

TEST(LockstepClient, FailsWhereTwoResponsesToARequestContradict) {
  for (const double second : {9.0, 9.5}) {
    const FakeService service([second](const WrenchRequest& request) {
      return Responses{encoded(response_to(request, 9.0)), encoded(response_to(request, second))};
    });
    LockstepClient client(open_channel(), kTestRetryPolicy);
    ASSERT_TRUE(client.request(make_request(0)));
    const Expected<const WrenchResponse*> response = client.request(make_request(1));
    ASSERT_EQ(response.has_value(), second == 9.0);
    if (response) continue;
    EXPECT_TRUE(contains(response.error().message(), "two responses to request 0: body 5 has OK, force"));
  }
}

TEST(LockstepClient, ResendsRequestUntilResponseArrives) {
  std::vector<std::int64_t> received_seqs;
  const FakeService service([&](const WrenchRequest& request) {
    received_seqs.push_back(request.id.seq);
    if (received_seqs.size() < 4) return Responses{};
    return Responses{encoded(response_to(request, 9.0))};
  });
  LockstepClient client(open_channel(), {0.1, 1000});
  ASSERT_TRUE(client.request(make_request(3)));
  EXPECT_GE(client.statistics().retries, 3);
  EXPECT_GE(service.requests(), 4);
  EXPECT_EQ(client.statistics().unanswered, 0);
}

TEST(LockstepClient, AsksAgainUntilTheServiceHasASea) {
  const auto without_sea = [](const WrenchRequest& request) {
    WrenchResponse response = response_to(request, 0.0);
    for (BodyWrench& body : response.bodies) body.status = BodyStatus::kNoSea;
    return response;
  };
  int received = 0;
  const FakeService service([&](const WrenchRequest& request) {
    if (++received <= 3) return Responses{encoded(without_sea(request))};
    return Responses{encoded(response_to(request, 9.0)), encoded(without_sea(request))};  // a late one
  });
  LockstepClient client(open_channel(), {0.05, 1000});
  for (std::int64_t seq = 0; seq < 2; ++seq) {
    const Expected<const WrenchResponse*> response = client.request(make_request(seq));
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_EQ((*response)->bodies[1].status, BodyStatus::kOk);
    EXPECT_EQ((*response)->bodies[1].force[2], 9.0);
  }
  EXPECT_GE(client.statistics().retries, 3);
}

TEST(LockstepClient, ReturnsWhatHasNoSeaOnceItsRetriesAreUsedUp) {
  const FakeService service([](const WrenchRequest& request) {
    WrenchResponse response = response_to(request, 0.0);
    response.bodies[0].status = BodyStatus::kNoSea;
    return Responses{encoded(response)};
  });
  LockstepClient client(open_channel(), {0.3, 2});
  const Expected<const WrenchResponse*> response = client.request(make_request(0));
  ASSERT_TRUE(response) << response.error().message();
  EXPECT_EQ((*response)->bodies[0].status, BodyStatus::kNoSea);
  EXPECT_EQ(client.statistics().retries, 2);
}

TEST(LockstepClient, StopsWaitingWhenInterrupted) {
  const FakeService service([](const WrenchRequest&) { return Responses{}; });
  ChannelOptions options;
  int calls = 0;
  options.is_interrupted = [&calls] { return ++calls > 2; };
  // Without the interruption this would take a day.
  LockstepClient client(open_channel(options), {0.1, 1'000'000});
  const Expected<const WrenchResponse*> response = client.request(make_request(0));
  ASSERT_FALSE(response);
  EXPECT_TRUE(contains(response.error().message(), "cancelled"));
  EXPECT_EQ(client.statistics().unanswered, 0);
}

TEST(LockstepClient, FailsAfterMaxRetries) {
  const FakeService service([](const WrenchRequest&) { return Responses{}; });
  LockstepClient client(open_channel(), {0.05, 3});
  const Expected<const WrenchResponse*> response = client.request(make_request(0));
  ASSERT_FALSE(response);
  EXPECT_TRUE(contains(response.error().message(), std::string(kStatesChannel)));
  EXPECT_EQ(client.statistics().retries, 3);
  EXPECT_EQ(client.statistics().unanswered, 1);
}

TEST(LockstepClient, RejectsResponseWithOtherBodies) {
  for (const bool fewer : {true, false}) {
    const FakeService service([fewer](const WrenchRequest& request) {
      WrenchResponse response = response_to(request, 9.0);
      if (fewer) {
        response.bodies.pop_back();
      } else {
        response.bodies[1].body_id = 7;
      }
      return Responses{encoded(response)};
    });
    LockstepClient client(open_channel(), kTestRetryPolicy);
    const Expected<const WrenchResponse*> response = client.request(make_request(0));
    ASSERT_FALSE(response);
    EXPECT_TRUE(contains(response.error().message(), "other bodies"));
  }
}

}  // namespace
}  // namespace buoyancy
