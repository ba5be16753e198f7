// Mistakes of simulators, made on purpose: the service's log, its status, buoyancy-ping and a client notice
// them.
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/client.h"
#include "scene/scene_fingerprint.h"
#include "tests/service/running_service.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A box that rolls about the world's x axis and drifts along y, with a heading of a quarter turn.
BodyState rolling_box(int step) {
  const double t = 0.01 * step, roll = 0.5 * std::sin(t), heading = M_PI / 2;
  const double c = std::cos(roll / 2), s = std::sin(roll / 2);
  const double ch = std::cos(heading / 2), sh = std::sin(heading / 2);
  return {.body_id = 1,
          .position = {0.0, 2.0 * t, 0.0},
          .quaternion_wxyz = {c * ch, s * ch, -s * sh, c * sh},
          .linear_velocity = {0.0, 2.0, 0.0},
          .angular_velocity = {0.5 * std::cos(t), 0.0, 0.0}};
}

struct Mistake {
  const char* name;
  std::function<void(BodyState&)> make;
  const char* cause;  // in the log
};

const std::array kMistakes{
    Mistake{"velocity_in_body_frame",
            [](BodyState& state) {
              state.linear_velocity = {2.0, 0.0, 0.0};
            },
            "the velocity is in the body's frame"},
    Mistake{"degrees", [](BodyState& state) { state.angular_velocity[0] *= 180.0 / M_PI; },
            "degrees per second"},
    Mistake{"xyzw",
            [](BodyState& state) {
              const auto [w, x, y, z] = state.quaternion_wxyz;
              state.quaternion_wxyz = {x, y, z, w};
            },
            "the order x, y, z, w"},
    Mistake{"milliseconds",
            [](BodyState& state) {
              for (double& v : state.linear_velocity) v *= 1e-3;
            },
            "another unit of the velocity"}};

void send_steps(int steps, const std::function<void(BodyState&)>& change) {
  Expected<Client> client = Client::open();
  ASSERT_TRUE(client) << client.error().message();
  for (int step = 0; step < steps; ++step) {
    std::vector<BodyState> states{rolling_box(step)};
    change(states[0]);
    const auto response = client->request(10'000 * step, states);
    ASSERT_TRUE(response) << response.error().message();
  }
}

FinishedProcess ping(const RunningService& service) {
  return run_program("buoyancy-ping", {"--scene", service.path("scene.toml"), "--count", "3"});
}

class BeginnersMistake : public testing::TestWithParam<Mistake> {};

TEST_P(BeginnersMistake, IsNamedByLogStatusAndPing) {
  RunningService service;
  RawLcmSocket bus;
  send_steps(60, GetParam().make);
  ASSERT_TRUE(service.child().wait_for_text(GetParam().cause, kWaitTimeout)) << service.log();
  const auto status =
      wait_for_status(bus, [](const ServiceStatus& now) { return now.counters.motions_contradicting > 0; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->counters.motions_contradicting, 1);
  const FinishedProcess pinged = ping(service);
  EXPECT_EQ(pinged.exit_code, 0) << pinged.standard_error;
  EXPECT_THAT(pinged.standard_error, HasSubstr("1 velocity that contradicts the motion of its body"));
}

INSTANTIATE_TEST_SUITE_P(Mistakes, BeginnersMistake, testing::ValuesIn(kMistakes),
                         [](const auto& mistake) { return mistake.param.name; });

TEST(BeginnersMistakes, AreNotSeenWhereThereAreNone) {
  RunningService service;
  RawLcmSocket bus;
  send_steps(300, [](BodyState&) {});
  int step = 0;  // two jumps, which a reset makes
  send_steps(300, [&step](BodyState& state) { state.position[0] += ++step / 100 * 7.0; });
  const FinishedProcess pinged = ping(service);
  EXPECT_EQ(pinged.exit_code, 0);
  EXPECT_EQ(pinged.standard_error, "");
  const auto status =
      wait_for_status(bus, [](const ServiceStatus& now) { return now.counters.requests >= 603; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->counters.motions_contradicting, 0);
  EXPECT_EQ(status->counters.quaternions_xyzw, 0);
  EXPECT_EQ(status->other_services, 0);
  EXPECT_THAT(service.log(), Not(HasSubstr("warning")));
}

TEST(BeginnersMistakes, IncludeTheStartPoseInAnotherOrder) {
  RunningService service({}, kBoxScene + "[body.client]\nmass = 1000\nposition = [5, 6, 0.5]\n");
  Expected<Client> client = Client::open();
  ASSERT_TRUE(client);
  const std::vector<BodyState> states{
      {.body_id = 2, .position = {5.0, 6.0, 0.5}, .quaternion_wxyz = {0.0, 0.0, 0.0, 1.0}}};
  ASSERT_TRUE(client->request(0, states));
  EXPECT_TRUE(service.child().wait_for_text("starts where the scene file says, but turned", kWaitTimeout))
      << service.log();
  EXPECT_THAT(ping(service).standard_error,
              HasSubstr("1 session with quaternions that look like x, y, z, w"));
}

TEST(BeginnersMistakes, IncludeAServiceWithAnotherScene) {
  RunningService service;
  const Scene other = scene_of(kOneBoxScene);
  ClientOptions options;
  options.channel.scene_fingerprint = scene_fingerprint(other);
  Expected<Client> client = Client::open(options);
  ASSERT_TRUE(client);
  const std::vector<BodyState> states{rolling_box(0)};
  const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (client->scene_warning() == nullptr && std::chrono::steady_clock::now() < limit) {
    ASSERT_TRUE(client->request(0, states));
  }
  ASSERT_NE(client->scene_warning(), nullptr);
  EXPECT_THAT(client->scene_warning()->message(), HasSubstr("another scene, from its file"));

  options.channel.scene_fingerprint = scene_fingerprint(scene_of(kBoxScene));
  Expected<Client> same = Client::open(options);
  ASSERT_TRUE(same);
  ASSERT_TRUE(same->status(kWaitTimeout));
  EXPECT_EQ(same->scene_warning(), nullptr);
}

TEST(BeginnersMistakes, IncludeASecondServiceWhoseResponsesContradict) {
  RunningService first;
  RunningService second({}, kTestWater + "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1] }\n");
  Expected<Client> client = Client::open();
  ASSERT_TRUE(client);
  Expected<const WrenchResponse*> response = nullptr;
  const std::vector<BodyState> states{rolling_box(0)};
  for (int step = 0; step < 1000 && response; ++step) response = client->request(1000 * step, states);
  ASSERT_FALSE(response);
  EXPECT_THAT(response.error().message(), HasSubstr("two responses to request"));
  EXPECT_THAT(response.error().message(), HasSubstr("two services with different scenes"));
  EXPECT_TRUE(first.child().wait_for_text("another scene) publishes on", kWaitTimeout)) << first.log();
  EXPECT_THAT(ping(first).standard_error, HasSubstr("1 other service on the channel of its status"));
}

}  // namespace
}  // namespace buoyancy
