// The fixtures that users test with: they start the real service, on addresses that do not meet.

#include "testing/service_process.h"

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include "client/client.h"
#include "testing/private_network.h"
#include "tests/support/build_paths.h"
#include "tests/support/child_process.h"
#include "tests/support/contains.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"

namespace buoyancy::testing {
namespace {

using ::testing::HasSubstr;

ServiceOptions box(double density = 1025.0) {
  ServiceOptions options;
  options.program = built_program("buoyancyd");
  options.ready_timeout = kWaitTimeout;
  options.scene_text = "[water]\ndensity = " + std::to_string(density) +
                       "\n[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1] }\n";
  return options;
}

ServiceProcess started(const ServiceOptions& options) {
  Expected<ServiceProcess> service = ServiceProcess::start(options);
  if (!service) throw std::runtime_error(service.error().message());
  return *std::move(service);
}

double lift_of_half_a_box(const std::string& url) {
  ClientOptions options;
  options.channel.lcm_url = url;
  options.retry_policy.timeout = kWaitTimeout / 10.0;
  auto client = Client::open(options);
  if (!client) throw std::runtime_error(client.error().message());
  BodyState state;
  state.body_id = 1;
  state.quaternion_wxyz = {1, 0, 0, 0};
  const auto response = client->request(0, std::vector{state});
  if (!response) throw std::runtime_error(response.error().message());
  return (*response)->bodies[0].force[2];
}

std::string error_of(const ServiceOptions& options) {
  const auto service = ServiceProcess::start(options);
  return service ? "" : service.error().message();
}

TEST(ServiceProcess, AnswersOnAnAddressOfItsOwn) {
  ServiceProcess fresh = started(box(1000.0));
  ServiceProcess salt = started(box(1025.0));
  EXPECT_NE(fresh.lcm_url(), salt.lcm_url());
  EXPECT_NEAR(lift_of_half_a_box(fresh.lcm_url()), 500.0 * 9.80665, 1e-9);
  EXPECT_NEAR(lift_of_half_a_box(salt.lcm_url()), 512.5 * 9.80665, 1e-9);
}

TEST(ServiceProcess, StopsTheService) {
  ServiceOptions options = box();
  options.arguments = {"--mode", "latest"};
  ServiceProcess service = started(options);
  EXPECT_TRUE(service.wait_for_log("ready:", kWaitTimeout));
  EXPECT_TRUE(service.is_running());
  const int pid = service.pid();
  EXPECT_EQ(kill(pid, SIGTERM), 0);
  EXPECT_FALSE(service.wait_for_log("no such line", kWaitTimeout)) << "it ends with the service";
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(service.stop(), 0);
  EXPECT_FALSE(service.is_running());
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_THAT(service.log(), HasSubstr("latest"));
  EXPECT_THAT(service.log(), HasSubstr("ready:"));
}

TEST(ServiceProcess, StopsTheServiceWithItsObject) {
  int pid = 0;
  {
    ServiceProcess service = started(box());
    pid = service.pid();
    ServiceProcess moved = std::move(service);
    EXPECT_TRUE(moved.is_running());
  }
  EXPECT_EQ(kill(pid, 0), -1);
}

TEST(ServiceProcess, OutlivesTheThreadThatStartedIt) {
  std::optional<ServiceProcess> service;
  std::thread([&] { service.emplace(started(box())); }).join();
  EXPECT_NEAR(lift_of_half_a_box(service->lcm_url()), 512.5 * 9.80665, 1e-9);
  EXPECT_EQ(service->stop(), 0);
}

TEST(ServiceProcess, ReportsWhyTheServiceDidNotStart) {
  ServiceOptions options = box();
  options.scene_text += "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1] }\n";
  const std::string duplicate = error_of(options);
  EXPECT_THAT(duplicate, HasSubstr("exit code 2"));
  EXPECT_THAT(duplicate, HasSubstr("the same id"));

  options = box();
  options.program = "/no/such/buoyancyd";
  EXPECT_THAT(error_of(options), HasSubstr("set $BUOYANCYD"));

  options = box();
  options.scene = "scene.toml";
  EXPECT_THAT(error_of(options), HasSubstr("one of scene and scene_text"));
  options.scene.clear();
  options.scene_text.clear();
  EXPECT_THAT(error_of(options), HasSubstr("no scene"));

  options = box();
  options.program = "/bin/sleep";  // does not know --scene
  EXPECT_THAT(error_of(options), HasSubstr("exit code 1"));
}

TEST(ServiceProcess, RemovesTheSceneThatItWrote) {
  const TempDir folder;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): the test has one thread
  ASSERT_EQ(setenv("TMPDIR", folder.path().c_str(), 1), 0);
  {
    const ServiceProcess service = started(box());
    EXPECT_FALSE(std::filesystem::is_empty(folder.path()));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  unsetenv("TMPDIR");  // NOLINT(concurrency-mt-unsafe)
}

FinishedProcess run_example(const std::string& program, std::vector<std::string> wrapper) {
  wrapper.push_back(program);
  ChildCommand command = command_of(std::move(wrapper));
  command.environment = {"BUOYANCYD=" + built_program("buoyancyd")};
  return run_to_end(command, kRunTimeout);
}

TEST(ServiceRoundTripExample, Passes) {
  const FinishedProcess run = run_example(built_program("service_round_trip_test"), {});
  EXPECT_EQ(run.exit_code, 0) << run.standard_output << run.standard_error;
  EXPECT_FALSE(contains(run.standard_output, "The log of buoyancyd"));
}

TEST(ServiceTest, PrintsTheLogOfAFailedTest) {
  const FinishedProcess failed = run_example(built_program("failing_service_test"), {});
  EXPECT_EQ(failed.exit_code, 1);
  const std::size_t log = failed.standard_output.find("The log of buoyancyd:");
  ASSERT_NE(log, std::string::npos) << failed.standard_output;
  EXPECT_NE(failed.standard_output.find("ready:", log), std::string::npos);
  EXPECT_THAT(failed.standard_output, HasSubstr("buoyancyd ended with this exit code"));
}

// In a new network namespace the loopback is down and there is no route.
TEST(ServiceRoundTripExample, NeedsNeitherRootNorAMulticastRoute) {
  std::vector<std::string> wrapper{"unshare", "--net"};
  if (geteuid() == 0) {
    wrapper.insert(wrapper.end(), {"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
  } else {
    wrapper.emplace_back("--user");
  }
  std::vector<std::string> probe = wrapper;
  probe.insert(probe.end(), {"unshare", "--user", "--net"});
  const FinishedProcess permitted = run_example("true", probe);
  if (permitted.exit_code != 0) GTEST_SKIP() << "no user namespaces here: " << permitted.standard_error;
  const FinishedProcess run = run_example(built_program("service_round_trip_test"), wrapper);
  EXPECT_EQ(run.exit_code, 0) << run.standard_output << run.standard_error;
}

}  // namespace
}  // namespace buoyancy::testing
