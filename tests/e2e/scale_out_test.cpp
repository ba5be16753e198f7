// Several services on one LCM network, each with a share of the bodies, its own pair of channels and its own
// client in the simulator. Together they give the same wrenches, bit for bit, as one service with all bodies.
#include <array>
#include <cmath>
#include <future>

#include <gtest/gtest.h>

#include "client/client.h"
#include "tests/e2e/closed_loop.h"
#include "tests/support/byte_vector.h"
#include "tests/support/contains.h"
#include "tests/support/running_program.h"

namespace buoyancy {
namespace {

constexpr int kSteps = 100;

std::string body_of_scene(int id) {
  constexpr std::array kShapes{R"({ type = "rock", frequency = 6 })", R"({ type = "torus_knot" })",
                               R"({ type = "box", size = [1, 2, 0.5] })"};
  return "[[body]]\nid = " + std::to_string(id) + "\nshape = " + kShapes[static_cast<std::size_t>(id) % 3] +
         "\nreference_point = [0.1, 0, 0.2]\n";
}

std::string scene_of(std::initializer_list<int> ids) {
  std::string scene;
  for (const int id : ids) scene += body_of_scene(id);
  return scene;
}

BodyState state_of(int id, int step) {
  const double phase = id + 0.03 * step;
  const double norm = std::sqrt(1.0 + 0.3 * 0.3);
  BodyState state;
  state.body_id = id;
  state.position = {2.0 * id, std::cos(phase), 0.4 * std::sin(3.0 * phase)};
  state.quaternion_wxyz = {std::cos(phase) / norm, std::sin(phase) / norm, 0.0, 0.3 / norm};
  return state;
}

std::vector<BodyState> states_of(std::initializer_list<int> ids, int step) {
  std::vector<BodyState> states;
  for (const int id : ids) states.push_back(state_of(id, step));
  return states;
}

// A service and its client on channels of their own.
class Share {
 public:
  Share(const TempDir& directory, const std::string& name, std::initializer_list<int> ids)
      : service_(
            service_command(directory.write(name + ".toml", scene_of(ids)),
                            {"--states-channel", name + "_STATES", "--wrenches-channel", name + "_WRENCHES",
                             "--hydrostatics-channel", name + "_HYDROSTATICS", "--loads-channel",
                             name + "_LOADS", "--status-channel", name + "_STATUS"})) {
    options_.channel.states_channel = name + "_STATES";
    options_.channel.wrenches_channel = name + "_WRENCHES";
    options_.retry_policy.max_retries = 10'000;  // effectively unlimited
    client_.emplace(connect());
  }

  // A client of this service with a session of its own.
  Client connect() const {
    Expected<Client> client = Client::open(options_);
    if (!client) throw std::runtime_error(client.error().message());
    return std::move(*client);
  }

  std::vector<BodyWrench> request(int step, const std::vector<BodyState>& states) {
    const auto response = client_->request(step, states);
    if (!response) throw std::runtime_error(response.error().message());
    return (*response)->bodies;
  }

  std::string log() const { return service_.standard_error(); }

 private:
  RunningProgram service_;
  ClientOptions options_;
  std::optional<Client> client_;
};

std::vector<std::uint8_t> bytes_of(const std::vector<BodyWrench>& wrenches) {
  return encoded(WrenchResponse{.id = {}, .bodies = wrenches});
}

TEST(ScaleOut, MatchesOneServiceBitForBit) {
  const TempDir directory;
  Share all(directory, "ALL", {1, 2, 3, 4, 5, 6});
  Share odd(directory, "ODD", {1, 3, 5});
  Share even(directory, "EVEN", {2, 4, 6});
  for (int step = 0; step < kSteps; ++step) {
    // Both requests run concurrently: the step takes as long as the slower one.
    auto of_odd = std::async(std::launch::async, [&] {
      return odd.request(step, states_of({1, 3, 5}, step));
    });
    std::vector<BodyWrench> parts = even.request(step, states_of({2, 4, 6}, step));
    const std::vector<BodyWrench> others = of_odd.get();
    parts.insert(parts.end(), others.begin(), others.end());
    const std::vector<BodyWrench> whole = all.request(step, states_of({2, 4, 6, 1, 3, 5}, step));
    ASSERT_EQ(bytes_of(parts), bytes_of(whole)) << step;
    for (const BodyWrench& wrench : whole) {
      EXPECT_EQ(wrench.status, BodyStatus::kOk);
      EXPECT_GT(wrench.force[2], 0.0) << "the body is in the water";
    }
  }
  for (const Share* share : {&all, &odd, &even}) {
    EXPECT_FALSE(contains(share->log(), "another buoyancyd"));
  }
}

TEST(ScaleOut, MatchesWholeRequestInSeveralSessionsOfOneService) {
  const TempDir directory;
  Share all(directory, "ALL", {1, 2, 3, 4, 5, 6});
  std::vector<Client> sessions;
  for (int i = 0; i < 3; ++i) sessions.push_back(all.connect());
  for (int step = 0; step < kSteps; ++step) {
    std::vector<BodyWrench> parts;
    for (const int first : {1, 3, 5}) {
      const auto part =
          sessions[static_cast<std::size_t>(first / 2)].request(step, states_of({first, first + 1}, step));
      ASSERT_TRUE(part) << part.error().message();
      parts.insert(parts.end(), (*part)->bodies.begin(), (*part)->bodies.end());
    }
    ASSERT_EQ(bytes_of(parts), bytes_of(all.request(step, states_of({1, 2, 3, 4, 5, 6}, step)))) << step;
  }
}

TEST(ScaleOut, ReportsUnknownBodyOfOtherService) {
  const TempDir directory;
  Share odd(directory, "ODD", {1, 3, 5});
  Share even(directory, "EVEN", {2, 4, 6});
  const std::vector<BodyWrench> wrenches = odd.request(0, states_of({1, 2}, 0));
  EXPECT_EQ(wrenches[0].status, BodyStatus::kOk);
  EXPECT_EQ(wrenches[1].status, BodyStatus::kUnknownBody);
}

}  // namespace
}  // namespace buoyancy
