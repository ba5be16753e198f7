// Tests the library that simulators link, against a fake service.
#include "client/client.h"

#include <array>
#include <atomic>
#include <vector>

#include <gtest/gtest.h>

#include "tests/client/fake_service.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

Client open_client(ClientOptions options = {}) {
  options.retry_policy = kTestRetryPolicy;
  return value_or_die(Client::open(options));
}

std::array<BodyState, 2> two_states() {
  std::array<BodyState, 2> states;
  states[0] = {.body_id = 5,
               .position = {1, 2, 3},
               .quaternion_wxyz = {1, 0, 0, 0},
               .linear_velocity = {4, 5, 6},
               .angular_velocity = {7, 8, 9}};
  states[1] = {.body_id = 6,
               .position = {-1, -2, -3},
               .quaternion_wxyz = {0, 1, 0, 0},
               .linear_velocity = {},
               .angular_velocity = {}};
  return states;
}

TEST(Client, SendsStatesUnchangedAndNumbersRequests) {
  std::vector<WrenchRequest> received;
  {
    const FakeService service([&](const WrenchRequest& request) {
      received.push_back(request);
      return Responses{encoded(response_to(request, static_cast<double>(request.id.seq)))};
    });
    ClientOptions options;
    options.session_id = 42;
    Client client = open_client(options);
    for (std::int64_t step = 0; step < 3; ++step) {
      const Expected<const WrenchResponse*> response = client.request(1000 * step, two_states(), 0.25);
      ASSERT_TRUE(response) << response.error().message();
      EXPECT_EQ((*response)->id.utime, 1000 * step);
      EXPECT_EQ((*response)->bodies.at(1).body_id, 6);
      EXPECT_EQ((*response)->bodies.at(1).force[2], static_cast<double>(step));
    }
    EXPECT_EQ(client.statistics().requests, 3);
  }
  std::int64_t expected_seq = 0;
  for (const WrenchRequest& request : received) {
    if (request.id.seq < expected_seq) continue;  // a retry on a busy machine
    EXPECT_EQ(request.id.session_id, 42);
    EXPECT_EQ(request.id.seq, expected_seq++);
    EXPECT_EQ(request.lead_time, 0.25);
    ASSERT_EQ(request.bodies.size(), 2U);
    EXPECT_EQ(request.bodies[0].position, two_states()[0].position);
    EXPECT_EQ(request.bodies[0].linear_velocity, two_states()[0].linear_velocity);
    EXPECT_EQ(request.bodies[0].angular_velocity, two_states()[0].angular_velocity);
    EXPECT_EQ(request.bodies[1].quaternion_wxyz, two_states()[1].quaternion_wxyz);
  }
  EXPECT_EQ(expected_seq, 3);
}

TEST(Client, DrawsDistinctSessionsForTwoClients) {
  std::atomic<std::int64_t> newest_session{-1};
  const FakeService service([&](const WrenchRequest& request) {
    newest_session = request.id.session_id;
    return Responses{encoded(response_to(request, request.bodies[0].position[0]))};
  });
  std::array<Client, 2> clients{open_client(), open_client()};
  std::array<std::int64_t, 2> sessions{};
  for (std::size_t n = 0; n < clients.size(); ++n) {
    std::array<BodyState, 2> states = two_states();
    states[0].position[0] = static_cast<double>(n);
    const Expected<const WrenchResponse*> response = clients.at(n).request(0, states);
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_EQ((*response)->bodies.at(0).force[2], static_cast<double>(n));
    sessions.at(n) = newest_session;
    EXPECT_GE(newest_session, 0);
  }
  EXPECT_NE(sessions[0], sessions[1]);
}

TEST(Client, ReturnsNewestResponseInFreeRunningMode) {
  // Responds to the first request only.
  const FakeService service([](const WrenchRequest& request) {
    return request.id.seq == 0 ? Responses{encoded(response_to(request, 7.0))} : Responses{};
  });
  ClientOptions options;
  options.interval = 0.02;
  Client client = open_client(options);
  for (std::int64_t step = 0; step < 5; ++step) {
    const Expected<const WrenchResponse*> response = client.request(step, two_states());
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_EQ((*response)->id.utime, 0);
  }
  EXPECT_EQ(client.statistics().late, 4);
}

TEST(Client, RefusesMoreBodiesThanOneMessageCarriesAtOnce) {
  Client client = value_or_die(Client::open());
  const std::vector<BodyState> states(160'000);
  EXPECT_FALSE(client.reserve(states.size()));
  const Expected<const WrenchResponse*> response = client.request(0, states);
  ASSERT_FALSE(response);
  const std::string message = response.error().message();
  EXPECT_TRUE(
      message.starts_with("request for 160000 bodies: a message of 17280044 bytes; expected at most "))
      << message;
  EXPECT_EQ(client.statistics().requests, 0);
  EXPECT_EQ(client.statistics().retries, 0);
}

TEST(Client, WarnsBeforeResponsesThatDoNotFitItsReceiveBuffer) {
  ClientOptions options;
  options.channel.lcm_url = "udpm://239.255.76.67:7667?recv_buf_size=100000";
  options.retry_policy = {.timeout = 0.05, .max_retries = 3};
  Client client = value_or_die(Client::open(options));
  EXPECT_FALSE(value_or_die(client.reserve(900)));
  const std::optional<Warning> warning = value_or_die(client.reserve(10'000));
  ASSERT_TRUE(warning);
  EXPECT_TRUE(
      warning->message().starts_with("response for 10000 bodies: a message of 1040036 bytes in 16 "
                                     "packets, some of which may be lost"))
      << warning->message();

  // The client reads nothing while this arrives. The kernel reports what it dropped with the next packet,
  // which is a retry.
  LcmConnection bus = value_or_die(LcmConnection::open(""));
  const WrenchResponse lost{.id = {}, .bodies = std::vector<BodyWrench>(10'000)};
  ASSERT_TRUE(bus.publish(std::string(kWrenchesChannel), encoded(lost)));
  const Expected<const WrenchResponse*> response = client.request(0, std::vector<BodyState>(10'000));
  ASSERT_FALSE(response);
  const std::string message = response.error().message();
  EXPECT_TRUE(contains(message,
                       "this program's receive buffer was full; it is too small for the response for 10000 "
                       "bodies"));
  EXPECT_TRUE(contains(message, "leave recv_buf_size out of the LCM URL"));
}

TEST(Client, FindsFirstFailedBody) {
  WrenchResponse response;
  response.bodies.resize(3);
  EXPECT_EQ(find_failed_body(response), nullptr);
  response.bodies[1].status = BodyStatus::kUnknownBody;
  response.bodies[2].status = BodyStatus::kBadQuaternion;
  EXPECT_EQ(find_failed_body(response), &response.bodies[1]);
}

TEST(Client, ReportsInvalidUrl) {
  ClientOptions options;
  options.channel.lcm_url = "tcpq://localhost";
  const Expected<Client> client = Client::open(options);
  ASSERT_FALSE(client);
  EXPECT_TRUE(contains(client.error().message(), "tcpq://localhost"));
}

}  // namespace
}  // namespace buoyancy
