// Tests that a client that waits for loads returns those of its response, whatever is lost on the network.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "client/client.h"
#include "tests/client/fake_service.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

const ChannelOptions kWithLoads = [] {
  ChannelOptions options;
  options.wait_for_loads = true;
  return options;
}();

void expect_pair(const WrenchResponse& response, const BodiesLoads& loads, std::int64_t seq) {
  EXPECT_EQ(response.id.seq, seq);
  EXPECT_EQ(response.bodies.at(1).force[2], static_cast<double>(seq));
  EXPECT_EQ(loads.id.seq, seq);
  ASSERT_EQ(loads.bodies.size(), 1U);
  EXPECT_EQ(loads.bodies[0].drag_force[2], -static_cast<double>(seq));
  EXPECT_EQ(find_loads(loads, 5), nullptr);
  EXPECT_EQ(find_loads(loads, 6), loads.bodies.data());
}

Responses pair_of(const WrenchRequest& request) {
  const auto value = static_cast<double>(request.id.seq);
  return {encoded(response_to(request, value)), encoded(loads_for(request, -value))};
}

TEST(ClientLoads, BelongToTheResponseInEitherOrder) {
  const FakeService service([](const WrenchRequest& request) {
    Responses responses = pair_of(request);
    if (request.id.seq % 2 == 0) std::swap(responses[0], responses[1]);
    // Those of an earlier request, of one that was not sent yet and of another session are nobody's.
    for (const auto& [session, seq] : {std::pair{0, -1}, {0, 1}, {1, 0}}) {
      WrenchRequest other = request;
      other.id.session_id += session;
      other.id.seq += seq;
      responses.insert(responses.begin(), encoded(loads_for(other, 7.0)));
      // A second response to the earlier request that differs would be an error.
      const double force = seq < 0 ? static_cast<double>(other.id.seq) : 7.0;
      responses.insert(responses.begin(), encoded(response_to(other, force)));
    }
    return responses;
  });
  LockstepClient client(open_channel(kWithLoads), kTestRetryPolicy);
  for (std::int64_t seq = 0; seq < 20; ++seq) {
    const Expected<const WrenchResponse*> response = client.request(make_request(seq));
    ASSERT_TRUE(response) << response.error().message();
    expect_pair(**response, client.loads(), seq);
  }
  EXPECT_EQ(client.statistics().round_trip.count(), 20);
}

TEST(ClientLoads, AreRequestedAgainWhenLost) {
  int requests = 0;
  const FakeService service([&](const WrenchRequest& request) {
    Responses responses = pair_of(request);
    // Every other message is lost, the loads and the response in turn.
    if (++requests % 4 == 1) responses.pop_back();
    if (requests % 4 == 3) responses.erase(responses.begin());
    return responses;
  });
  LockstepClient client(open_channel(kWithLoads), {0.05, 1000});
  for (std::int64_t seq = 0; seq < 6; ++seq) {
    const Expected<const WrenchResponse*> response = client.request(make_request(seq));
    ASSERT_TRUE(response) << response.error().message();
    expect_pair(**response, client.loads(), seq);
  }
  EXPECT_GE(client.statistics().retries, 6);
  EXPECT_EQ(client.statistics().unanswered, 0);
}

TEST(ClientLoads, BelongToTheNewestCompleteResponseIfFreeRunning) {
  // Of every three pairs one is complete; of the second the response is lost, of the third the loads.
  const FakeService service([](const WrenchRequest& request) {
    Responses responses = pair_of(request);
    if (request.id.seq % 3 == 1) responses.erase(responses.begin());
    if (request.id.seq % 3 == 2) responses.pop_back();
    return responses;
  });
  ClientOptions options;
  options.channel = kWithLoads;
  options.retry_policy = kTestRetryPolicy;
  options.interval = 0.05;
  options.session_id = 77;
  Client client = value_or_die(Client::open(options));
  const WrenchRequest request = make_request(0);
  for (std::int64_t step = 0; step < 10; ++step) {
    const Expected<const WrenchResponse*> response = client.request(step, request.bodies);
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_EQ((*response)->id.seq % 3, 0);
    EXPECT_LE((*response)->id.seq, step);
    expect_pair(**response, client.loads(), (*response)->id.seq);
  }
  EXPECT_GE(client.statistics().late, 6);
}

TEST(ClientLoads, NamesTheMissingOutputIfOnlyResponsesArrive) {
  const FakeService service(
      [](const WrenchRequest& request) { return Responses{encoded(response_to(request, 1.0))}; });
  LockstepClient client(open_channel(kWithLoads), {0.05, 3});
  const Expected<const WrenchResponse*> response = client.request(make_request(0));
  ASSERT_FALSE(response);
  for (const char* text : {"no loads for", "BUOYANCY_LOADS", "outputs = [\"wrench\", \"loads\"]"}) {
    EXPECT_TRUE(contains(response.error().message(), text));
  }
}

TEST(ClientLoads, RejectsLoadsOfOtherBodies) {
  const FakeService service([](const WrenchRequest& request) {
    BodiesLoads loads = loads_for(request, 1.0);
    loads.bodies[0].body_id = 9;
    return Responses{encoded(response_to(request, 1.0)), encoded(loads)};
  });
  LockstepClient client(open_channel(kWithLoads), kTestRetryPolicy);
  const Expected<const WrenchResponse*> response = client.request(make_request(0));
  ASSERT_FALSE(response);
  EXPECT_TRUE(contains(response.error().message(), "loads of body 9"));
}

TEST(ClientLoads, AreNotReceivedUnlessWaitedFor) {
  const FakeService service([](const WrenchRequest& request) { return pair_of(request); });
  LockstepClient client(open_channel(), kTestRetryPolicy);
  for (std::int64_t seq = 0; seq < 3; ++seq) {
    ASSERT_TRUE(client.request(make_request(seq)));
    EXPECT_TRUE(client.loads().bodies.empty());
  }
}

}  // namespace
}  // namespace buoyancy
