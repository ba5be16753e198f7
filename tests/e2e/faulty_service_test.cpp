// Clients of a service that misbehaves on purpose (buoyancyd --inject): in lock-step they finish, and with
// the same trajectory as with a service that behaves.
#include <string>

#include <gtest/gtest.h>

#include "tests/e2e/closed_loop.h"
#include "tests/support/json.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

const std::string kScenes = std::string(BUOYANCY_SOURCE_DIR) + "/scenes";

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
    EXPECT_EQ(log.find(absent), std::string::npos) << log;
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, ClientOfFaultyService, testing::Values("lockstep", "latest"),
                         [](const auto& mode) { return std::string(mode.param); });

// The line that bullet_crate prints about the crate's final pose.
std::string final_pose_of_crate(const std::vector<std::string>& service_options) {
  const RunningProgram service(service_command(kScenes + "/crate.toml", service_options));
  const FinishedProcess run = run_to_end(command_of({BULLET_CRATE, "--loads", "", "0.02"}), kRunTimeout);
  EXPECT_EQ(run.exit_code, 0) << run.standard_error;
  return run.standard_output.substr(0, run.standard_output.find('\n'));
}

TEST(BulletCrateOfFaultyService, EndsAtSamePose) {
  if (*BULLET_CRATE == '\0') {
    GTEST_SKIP() << "CMake did not find double-precision Bullet; install libbullet-dev and configure again";
  }
  const std::string expected = final_pose_of_crate({});
  EXPECT_EQ(expected.rfind("height ", 0), 0U) << expected;
  // Its client waits 0.1 s for what is lost.
  EXPECT_EQ(
      final_pose_of_crate({"--inject",
                           "drop=0.005,delay=200us,jitter=200us,duplicate=0.02,reorder=0.005,corrupt=0.005,"
                           "stall=200ms/1s,seed=7"}),
      expected);
}

}  // namespace
}  // namespace buoyancy
