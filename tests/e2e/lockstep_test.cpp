// Lock-step and free-running mode over UDP multicast, on good and bad networks, each test in its own network
// namespace. In lock-step a bad network costs time but never changes a result.
#include <chrono>

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>

#include "tests/e2e/closed_loop.h"
#include "tests/e2e/lossy_relay.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"
#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

constexpr const char* kScene = R"(
[[body]]
id = 7
name = "rock"
shape = { type = "rock", frequency = 4 }
reference_point = [0.3, 0, 0.1]
[body.client]
density = 500
position = [0, 0, 0.8]
orientation = [0.9, 0.3, 0.2, 0.1]
angular_velocity = [0.1, 2, 0]
linear_damping_quadratic = 300
[[body]]
id = 8
name = "crate"
shape = { type = "box" }
[body.client]
density = 400
position = [4, 0, 0.3]
orientation = [0.9, 0.3, 0.2, 0.1]
)";

class Lockstep : public testing::Test {
 protected:
  std::string csv_of_run(const std::string& name, Options options) {
    const std::string csv = directory_.path(name);
    options.insert(options.end(), {"--step", "0.002", "--csv", csv});
    summary_ = simulate(scene_, options);
    return read_file(csv);
  }

  TempDir directory_;
  std::string scene_ = directory_.write("scene.toml", kScene);
  nlohmann::json summary_;
};

TEST_F(Lockstep, ProducesSameBytesEmbeddedOverUdpAndOverLossyNetwork) {
  const std::string embedded = csv_of_run("embedded.csv", {"--embedded", "--duration", "4"});
  ASSERT_GT(embedded.size(), 4000U * 300U);
  const RunningProgram service(service_command(scene_, {"-l", kServiceUrl}));
  EXPECT_TRUE(csv_of_run("udp.csv", {"-l", kServiceUrl, "--duration", "4"}) == embedded);

  const LossyRelay relay({kClientUrl, kServiceUrl, 0.05, 0.0, 20250405});
  const Options short_timeout = {"-l",        kClientUrl, "--duration", "4",
                                 "--timeout", "0.005",    "--retries",  "10000"};
  EXPECT_TRUE(csv_of_run("lossy.csv", short_timeout) == embedded);
  EXPECT_GT(relay.lost_requests(), 50);
  EXPECT_GT(relay.lost_responses(), 50);
  EXPECT_GE(summary_["retries"].get<std::int64_t>(), relay.lost_requests() + relay.lost_responses());
  EXPECT_EQ(summary_["unanswered"], 0);
}

constexpr const char* kDamagedScene = R"(
[[body]]
id = 7
shape = { type = "box", size = [4, 2, 1] }
[[body.compartment]]
shape = { type = "box", size = [1, 2, 1] }
position = [1.5, 0, 0]
flooded = 0
[[body.tank]]
shape = { type = "box", size = [1, 1, 0.5] }
position = [-1, 0.3, -0.2]
fill = 0.5
[body.client]
density = 400
start = "equilibrium"
[[body.client.event]]
time = 0.3
compartment = 0
flooded = 1.0
[[body.client.event]]
time = 0.31
compartment = 0
flooded = 0.5
[[body.client.event]]
time = 0.5
tank = 0
liquid_volume = 0.1
)";

// The second run over UDP meets a service that has the first one's damage.
TEST_F(Lockstep, ProducesSameBytesWithEventsOverLossyNetwork) {
  scene_ = directory_.write("damaged.toml", kDamagedScene);
  const std::string embedded = csv_of_run("embedded.csv", {"--embedded", "--duration", "1"});
  const std::vector<double> volumes = csv_column(embedded, "volume");
  ASSERT_EQ(volumes.size(), 501U);
  EXPECT_NEAR(volumes[149], volumes[0], 1e-9) << "at rest until then";
  EXPECT_LT(volumes[150], volumes[0] - 0.3);
  const RunningProgram service(service_command(scene_, {"-l", kServiceUrl}));
  for (int run = 0; run < 2; ++run) {
    EXPECT_TRUE(csv_of_run("udp.csv", {"-l", kServiceUrl, "--duration", "1"}) == embedded) << run;
  }
  const LossyRelay relay({kClientUrl, kServiceUrl, 0.05, 0.0, 20251125});
  const Options short_timeout = {"-l",        kClientUrl, "--duration", "1",
                                 "--timeout", "0.005",    "--retries",  "10000"};
  EXPECT_TRUE(csv_of_run("lossy.csv", short_timeout) == embedded);
  EXPECT_GT(relay.lost_requests(), 5);
  EXPECT_GT(relay.lost_conditions(), 0);
}

TEST_F(Lockstep, ProducesSameBytesAcrossServiceRestart) {
  auto service = std::make_unique<ChildProcess>(service_command(scene_, {"-l", kServiceUrl}));
  const std::string csv = directory_.path("udp.csv");
  // The run does not end by itself, so that the service always dies in the middle of it.
  ChildProcess client(
      client_command(scene_, {"-l", kServiceUrl, "--duration", "1e6", "--step", "0.002", "--csv", csv,
                              "--timeout", "0.05", "--retries", "10000", "--json"}));
  ASSERT_TRUE(grows_to(csv, 200'000, client)) << client.standard_error();
  service.reset();
  service = std::make_unique<ChildProcess>(service_command(scene_, {"-l", kServiceUrl}));
  ASSERT_TRUE(grows_to(csv, size_of(csv) + 200'000, client)) << client.standard_error();
  const nlohmann::json summary = interrupt(client);
  ASSERT_TRUE(summary.is_object());
  EXPECT_TRUE(read_file(csv) == embedded_csv(directory_, scene_, summary["steps"], "0.002"));
}

TEST_F(Lockstep, FailsWithoutServiceAndNamesEndpoint) {
  const FinishedProcess finished = run_to_end(
      client_command(scene_, {"-l", kServiceUrl, "--timeout", "0.01", "--retries", "3", "--states-channel",
                              "SOME_STATES", "--wrenches-channel", "SOME_WRENCHES"}),
      kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_EQ(finished.standard_output, "");
  for (const char* text :
       {"request 0", "no response", "buoyancyd", kServiceUrl, "SOME_STATES", "SOME_WRENCHES"}) {
    EXPECT_TRUE(contains(finished.standard_error, text)) << text << ": ";
  }
}

TEST_F(Lockstep, NamesBodyAndStatusIfServiceHasDifferentScene) {
  const std::string other = directory_.write("other.toml", "[[body]]\nid = 7\nshape = { type = \"box\" }\n");
  const RunningProgram service(service_command(other, {"-l", kServiceUrl}));
  const FinishedProcess finished = run_to_end(client_command(scene_, {"-l", kServiceUrl}), kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "body 8 (crate)"));
  EXPECT_TRUE(contains(finished.standard_error, "UNKNOWN_BODY"));
}

TEST_F(Lockstep, EndsOnSigintWithSummaryAndValidCsv) {
  const RunningProgram service(service_command(scene_, {"-l", kServiceUrl}));
  const std::string csv = directory_.path("interrupted.csv");
  ChildProcess client(
      client_command(scene_, {"-l", kServiceUrl, "--duration", "1e6", "--csv", csv, "--json"}));
  ASSERT_TRUE(grows_to(csv, 100'000, client)) << client.standard_error();
  const nlohmann::json summary = interrupt(client);
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(csv_column(read_file(csv), "energy").size(), 2 * (std::size_t{summary["steps"]} + 1));
}

TEST_F(Lockstep, EndsOnSigtermWhileWaitingForService) {
  Expected<LcmConnection> bus = LcmConnection::open(kServiceUrl);
  ASSERT_TRUE(bus) << bus.error().message();
  bool received = false;
  ASSERT_TRUE(bus->subscribe(std::string(kStatesChannel), [&](Bytes, std::string_view) { received = true; }));
  ChildProcess client(client_command(scene_, {"-l", kServiceUrl, "--timeout", "1e6"}));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (!received && std::chrono::steady_clock::now() < deadline) {
    pollfd waiting{bus->fileno(), POLLIN, 0};
    if (::poll(&waiting, 1, to_milliseconds(kWaitTimeout)) == 1) bus->handle_one();
  }
  ASSERT_TRUE(received) << client.standard_error();
  client.send_signal(SIGTERM);
  EXPECT_EQ(client.wait(kWaitTimeout), 1);
}

using FreeRunning = Lockstep;

TEST_F(FreeRunning, UsesNewestResponseAndCountsLag) {
  // Responses take eight intervals or more.
  const RunningProgram service(
      service_command(scene_, {"-l", kServiceUrl, "--mode", "latest", "--inject", "delay=40ms"}));
  const nlohmann::json summary =
      simulate_with_warnings(scene_, {"-l", kServiceUrl, "--rate", "200", "--duration", "1"});
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(summary["step"], 0.005);
  EXPECT_EQ(summary["steps"], 200);
  EXPECT_EQ(summary["requests"], 201);
  EXPECT_GE(summary["late"].get<int>(), 150);
  EXPECT_GE(summary["max_lag"].get<int>(), 8);
  EXPECT_GE(summary["round_trip"]["p50"].get<double>(), 0.04);
  EXPECT_GE(summary["wall_time"].get<double>(), 0.9);
  // The crate has a natural frequency of at least 5 rad/s: w times the delay is at least 0.2.
  ASSERT_FALSE(summary["warnings"].empty());
  EXPECT_TRUE(contains(std::string(summary["warnings"][0]), "response delay"));
}

TEST_F(FreeRunning, ContinuesWithOlderResponseAfterLoss) {
  const RunningProgram service(
      service_command(scene_, {"-l", kServiceUrl, "--mode", "latest", "--inject", "drop=0.2,seed=2"}));
  // Warnings may appear: they depend on the machine's load.
  const nlohmann::json summary =
      simulate_with_warnings(scene_, {"-l", kServiceUrl, "--rate", "500", "--duration", "1"});
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(summary["steps"], 500);
  EXPECT_GE(summary["unanswered"].get<int>(), 50);
  EXPECT_GE(summary["late"].get<int>(), summary["unanswered"].get<int>());
}

TEST_F(FreeRunning, FailsIfServiceDies) {
  const RunningProgram service(service_command(scene_, {"-l", kServiceUrl}));
  const std::string csv = directory_.path("free.csv");
  ChildProcess client(client_command(scene_, {"-l", kServiceUrl, "--rate", "1000", "--duration", "1e6",
                                              "--timeout", "0.5", "--retries", "1", "--csv", csv}));
  ASSERT_TRUE(grows_to(csv, 20'000, client)) << client.standard_error();
  service.send_signal(SIGKILL);
  EXPECT_EQ(client.wait(kWaitTimeout), 1);
  EXPECT_TRUE(contains(client.standard_error(), "no response for"));
}

}  // namespace
}  // namespace buoyancy
