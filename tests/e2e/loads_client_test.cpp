// A simulator of another project that moves a body with its added mass: it receives wrenches and loads from
// buoyancyd through buoyancy::client, also over a network that loses packets.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "client/client.h"
#include "client/coupled_load.h"
#include "tests/e2e/closed_loop.h"
#include "tests/e2e/lossy_relay.h"
#include "tests/support/running_program.h"

namespace buoyancy {
namespace {

constexpr double kGravity = 9.80665;  // [m/s^2]
constexpr double kMass = 200.0;       // [kg]
constexpr double kAddedMass = 20.0 * kMass;
constexpr double kStep = 0.01;       // [s]
constexpr double kAmplitude = 0.01;  // [m]
constexpr int kSteps = 200;

constexpr const char* kScene = R"(
[water]
density = 1000
[[body]]
id = 3
shape = { type = "box", size = [1, 1, 0.4] }
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.4] }
outputs = ["wrench", "loads"]
[body.added_mass]
matrix = [0, 0, 4000, 0, 0, 0]
immersion = "none"
)";

// The heights of the box over its equilibrium, by semi-implicit Euler. Another body without the output takes
// part.
std::vector<double> heave(const std::string& url, ClientStats& statistics) {
  ClientOptions options;
  options.channel.lcm_url = url;
  options.channel.wait_for_loads = true;
  options.retry_policy = {0.02, 5000};
  Expected<Client> client = Client::open(options);
  std::vector<double> heights;
  double velocity = 0.0;
  double height = kAmplitude;
  for (int step = 0; client && step < kSteps; ++step) {
    std::vector<BodyState> states(2);
    states[0] = {.body_id = 3, .position = {9, 0, 0}, .quaternion_wxyz = {1, 0, 0, 0}};
    states[1] = {.body_id = 1,
                 .position = {0, 0, height},
                 .quaternion_wxyz = {1, 0, 0, 0},
                 .linear_velocity = {0, 0, velocity}};
    const Expected<const WrenchResponse*> response = client->request(step, states);
    if (!response) {
      ADD_FAILURE() << response.error().message();
      break;
    }
    EXPECT_EQ(find_loads(client->loads(), 3), nullptr);
    const BodyLoads* loads = find_loads(client->loads(), 1);
    if (loads == nullptr) {
      ADD_FAILURE() << "no loads of body 1";
      break;
    }
    EXPECT_EQ(client->loads().id.seq, (*response)->id.seq);
    const CoupledBody box =
        coupled_body({kMass, Vec3::Zero(), 20.0 * Mat3::Identity()}, Vec3::Zero(), states[1], *loads);
    const Vec6 total = wrench_of((*response)->bodies.at(1)) + weight_W(box, {0, 0, -kGravity});
    velocity += kStep * coupled_acceleration(box, total, kStep)[2];
    height += kStep * velocity;
    heights.push_back(height);
  }
  EXPECT_TRUE(client);
  if (client) statistics = client->statistics();
  return heights;
}

TEST(LoadsClient, HeavesWithItsAddedMassDespiteLossOnTheNetwork) {
  const TempDir directory;
  const RunningProgram service(service_command(directory.write("box.toml", kScene), {"-l", kServiceUrl}));
  ClientStats statistics;
  const std::vector<double> heights = heave(kServiceUrl, statistics);
  ASSERT_EQ(heights.size(), std::size_t{kSteps});
  const double frequency = std::sqrt(1000.0 * kGravity / (kMass + kAddedMass));
  for (int step = 0; step < kSteps; ++step) {
    const double expected = kAmplitude * std::cos(frequency * kStep * (step + 1));
    EXPECT_NEAR(heights.at(static_cast<std::size_t>(step)), expected, 0.01 * kAmplitude) << step;
  }

  const LossyRelay relay({kClientUrl, kServiceUrl, 0.1, 0.0, 1, 0.05, 0.1});
  EXPECT_EQ(heave(kClientUrl, statistics), heights);
  EXPECT_GT(statistics.retries, 0);
  EXPECT_EQ(statistics.unanswered, 0);
}

}  // namespace
}  // namespace buoyancy
