// Clients of a service that misbehaves on purpose (buoyancyd --inject): in lock-step they finish, and with
// the same trajectory as with a service that behaves.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>

#include "messages/wire.h"
#include "tests/e2e/closed_loop.h"
#include "tests/support/build_paths.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"
#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

constexpr const char* kCrateStep = "0.02";  // [s], of 20 s
const std::string kScenes = (source_dir() / "scenes").string();

class ClientOfFaultyService : public testing::TestWithParam<const char*> {};

TEST_P(ClientOfFaultyService, ProducesSameBytes) {
  const TempDir directory;
  const std::string scene = kScenes + "/box.toml";
  constexpr const char* kStep = "0.005";
  constexpr int kSteps = 150;
  const std::string embedded = embedded_csv(directory, scene, kSteps, kStep);
  ASSERT_FALSE(embedded.empty());

  const std::string csv = directory.path("faults.csv");
  RunningProgram service(
      service_command(scene, {"-l", kServiceUrl, "--mode", GetParam(), "--inject",
                              "drop=0.1,delay=1ms,jitter=2ms,duplicate=0.1,reorder=0.1,corrupt=0.1,"
                              "stall=100ms/500ms,seed=7"}));
  const nlohmann::json summary =
      simulate(scene, {"-l", kServiceUrl, "--duration", std::to_string(kSteps * std::stod(kStep)), "--step",
                       kStep, "--csv", csv, "--timeout", "0.02", "--retries", "10000"});
  ASSERT_TRUE(summary.is_object());
  EXPECT_TRUE(read_file(csv) == embedded);
  EXPECT_EQ(summary["unanswered"], 0);
  EXPECT_GT(summary["malformed"].get<int>(), 0);
  EXPECT_GT(summary["retries"].get<int>(), 0);

  service.send_signal(SIGTERM);
  EXPECT_EQ(service.wait(kWaitTimeout), 0);
  const std::string log = service.standard_error();
  for (const char* absent : {": 0 responses dropped", " 0 delayed", " 0 duplicated", " 0 reordered",
                             " 0 corrupted", "; 0 stalls"}) {
    EXPECT_FALSE(contains(log, absent));
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, ClientOfFaultyService, testing::Values("lockstep", "latest"),
                         [](const auto& mode) { return std::string(mode.param); });

// Position, quaternion and velocities of one body.
using State = std::array<double, 13>;

// The states that a simulator with one body sends, by the number of the request: its trajectory, to the bit.
// A request that is sent again has the same number.
class SentStates {
 public:
  SentStates() : connection_(open()), thread_([this] { listen(); }) {}
  SentStates(const SentStates&) = delete;
  SentStates& operator=(const SentStates&) = delete;
  ~SentStates() {
    if (thread_.joinable()) stop();
  }

  // What has been sent so far. Call it once.
  std::map<std::int64_t, State> stop() {
    stopped_ = true;
    thread_.join();
    return std::move(states_);
  }

 private:
  static LcmConnection open() {
    Expected<LcmConnection> connection = LcmConnection::open(kServiceUrl);
    if (!connection) throw std::runtime_error(connection.error().message());
    return *std::move(connection);
  }

  void listen() {
    const Expected<void> subscribed =
        connection_.subscribe(std::string(kStatesChannel), [this](Bytes bytes, std::string_view) {
          WrenchRequest request;
          if (decode(bytes, request) || request.bodies.size() != 1) return;
          const BodyState& body = request.bodies[0];
          State state{};
          auto end = state.begin();
          const auto append = [&end](const auto& values) {
            end = std::copy(values.begin(), values.end(), end);
          };
          append(body.position);
          append(body.quaternion_wxyz);
          append(body.linear_velocity);
          append(body.angular_velocity);
          states_.emplace(request.id.seq, state);
        });
    EXPECT_TRUE(subscribed);
    pollfd readable{connection_.fileno(), POLLIN, 0};
    constexpr int kMilliseconds = 10;
    // What has arrived when the simulator has ended is read before the thread ends.
    while (connection_.handle_one() || !stopped_) {
      if (!stopped_) poll(&readable, 1, kMilliseconds);
    }
  }

  LcmConnection connection_;
  std::atomic<bool> stopped_{false};
  std::map<std::int64_t, State> states_;
  std::thread thread_;
};

std::map<std::int64_t, State> trajectory_of_crate(const std::vector<std::string>& service_options) {
  const RunningProgram service(service_command(kScenes + "/crate.toml", service_options));
  SentStates sent;
  const FinishedProcess run = run_to_end(command_of({BULLET_CRATE, "--loads", "", kCrateStep}), kRunTimeout);
  EXPECT_EQ(run.exit_code, 0) << run.standard_error;
  return sent.stop();
}

TEST(BulletCrateOfFaultyService, HasTheSameTrajectory) {
  if (*BULLET_CRATE == '\0') {
    GTEST_SKIP() << "CMake did not find double-precision Bullet; install libbullet-dev and configure again";
  }
  const std::map<std::int64_t, State> expected = trajectory_of_crate({});
  EXPECT_GE(expected.size(), 1000U);
  EXPECT_NE(expected.begin()->second, expected.rbegin()->second);
  // Its client waits 0.1 s for what is lost.
  EXPECT_TRUE(trajectory_of_crate({"--inject",
                                   "drop=0.005,delay=200us,jitter=200us,duplicate=0.02,reorder=0.005,"
                                   "corrupt=0.005,stall=200ms/1s,seed=7"}) == expected);
}

}  // namespace
}  // namespace buoyancy
