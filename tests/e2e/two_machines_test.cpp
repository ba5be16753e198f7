// Service and client on two machines connected by a switch: the real programs in network namespaces, with
// ttl=1. The connection between them may cost time, but it never changes a byte of a lock-step run.
//
// BUOYANCY_CUT_SECONDS: how long the cable is unplugged [s]; 1 by default (scripts/two_machines sets 30).
#include "tests/e2e/two_machines.h"

#include <chrono>
#include <cstdlib>

#include <gtest/gtest.h>
#include <poll.h>

#include "messages/wire.h"
#include "tests/e2e/closed_loop.h"
#include "tests/e2e/lossy_relay.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"
#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

constexpr const char* kStep = "0.001";
constexpr std::int64_t kSteps = 1000;   // length of a run that ends by itself
constexpr const char* kDuration = "1";  // [s], of the same run
constexpr const char* kScene = R"(
[[body]]
id = 1
shape = { type = "rock", frequency = 4 }
[body.client]
density = 500
position = [0, 0, 0.8]
orientation = [0.9, 0.3, 0.2, 0.1]
)";

double cut_seconds() {
  const char* const set =
      std::getenv("BUOYANCY_CUT_SECONDS");  // NOLINT(concurrency-mt-unsafe): no thread sets it
  return set != nullptr ? std::stod(set) : 1.0;
}

class TwoMachinesTest : public testing::Test {
 protected:
  void SetUp() override {
    if (machines_.error()) {
      GTEST_SKIP() << "network: two machines take a kernel with veth and bridge, and permission for network "
                      "namespaces; run ctest as root, in a container with --privileged. "
                   << *machines_.error();
    }
  }

  std::string embedded(std::int64_t steps) const { return embedded_csv(directory_, scene_, steps, kStep); }

  ChildCommand service() const {
    return machines_.on_service_machine(service_command(scene_, {"-l", kTwoMachinesUrl}));
  }

  // A run that lasts until it is interrupted, so that a test always finds it in progress.
  ChildCommand endless_run() const {
    return client_command(scene_, {"-l", kTwoMachinesUrl, "--duration", "1e6", "--csv", csv_, "--timeout",
                                   "0.05", "--retries", "1000000", "--json"});
  }
  // Checks that the run makes progress.
  testing::AssertionResult advances(ChildProcess& client) const {
    if (grows_to(csv_, size_of(csv_) + 100'000, client)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "the run makes no progress: " << client.standard_error();
  }
  // Interrupts the run and checks that its CSV equals that of an --embedded run of the same length.
  nlohmann::json interrupt_and_compare(ChildProcess& client) const {
    nlohmann::json summary = interrupt(client);
    if (summary.is_object()) {
      EXPECT_TRUE(read_file(csv_) == embedded(summary["steps"]));
    }
    return summary;
  }

  TwoMachines machines_;
  TempDir directory_;
  std::string csv_ = directory_.path("run.csv");
  std::string scene_ = directory_.write("scene.toml", kScene);
};

TEST_F(TwoMachinesTest, MatchesRunInOneProcess) {
  const RunningProgram running(service());
  const std::string csv = directory_.path("across.csv");
  simulate(scene_, {"-l", kTwoMachinesUrl, "--duration", kDuration, "--csv", csv, "--retries", "10000"});
  EXPECT_TRUE(read_file(csv) == embedded(kSteps));
}

TEST_F(TwoMachinesTest, DoesNotConnectWithTtlZero) {
  const RunningProgram running(service());
  const FinishedProcess finished = run_to_end(
      client_command(scene_, {"-l", kServiceUrl, "--timeout", "0.05", "--retries", "3"}), kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "no response"));
}

TEST_F(TwoMachinesTest, ProducesSameBytesDespiteLossAndReordering) {
  const RunningProgram running(service());
  RelayOptions options{kClientUrl, kTwoMachinesUrl, 0.05, 0.0, 7};
  options.duplication = 0.1;
  options.reordering = 0.1;
  const LossyRelay relay(options);
  const std::string csv = directory_.path("bad_network.csv");
  const nlohmann::json summary = simulate(scene_, {"-l", kClientUrl, "--duration", kDuration, "--csv", csv,
                                                   "--timeout", "0.005", "--retries", "10000"});
  EXPECT_TRUE(read_file(csv) == embedded(kSteps));
  EXPECT_GT(relay.lost_requests() + relay.lost_responses(), 50);
  EXPECT_GT(relay.duplicated(), 100);
  EXPECT_GT(relay.reordered(), 100);
  EXPECT_EQ(summary["unanswered"], 0);
}

// Waits until the same request was received so often that the client must be waiting for a response.
bool wait_for_retries(LcmConnection& bus, int times) {
  std::int64_t seq = -1;
  int received = 0;
  bus.subscribe(std::string(kStatesChannel), [&](Bytes bytes, std::string_view) {
    WrenchRequest request;
    if (decode(bytes, request)) return;
    received = request.id.seq == seq ? received + 1 : 1;
    seq = request.id.seq;
  });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (received < times && std::chrono::steady_clock::now() < deadline) {
    pollfd waiting{bus.fileno(), POLLIN, 0};
    if (::poll(&waiting, 1, to_milliseconds(kWaitTimeout)) == 1) bus.handle_one();
  }
  return received >= times;
}

TEST_F(TwoMachinesTest, SurvivesUnpluggedCableAndReportsItsDuration) {
  const RunningProgram running(service());
  ChildProcess client(endless_run());
  ASSERT_TRUE(advances(client));
  machines_.unplug_cable();
  {
    Expected<LcmConnection> bus = LcmConnection::open(kTwoMachinesUrl);
    ASSERT_TRUE(bus) << bus.error().message();
    ASSERT_TRUE(wait_for_retries(*bus, 4)) << "the cable was not unplugged";
  }
  const auto size_at_cut = size_of(csv_);
  ASSERT_EQ(client.wait(cut_seconds()), std::nullopt) << client.standard_error();
  EXPECT_EQ(size_of(csv_), size_at_cut) << "the cable was not unplugged";
  machines_.plug_in_cable();
  EXPECT_FALSE(machines_.error()) << *machines_.error();
  ASSERT_TRUE(advances(client));
  const nlohmann::json summary = interrupt_and_compare(client);
  ASSERT_TRUE(summary.is_object());
  EXPECT_GE(summary["round_trip"]["max"].get<double>(), cut_seconds());
  EXPECT_GE(summary["retries"].get<int>(), 3);
  EXPECT_EQ(summary["unanswered"], 0);
}

TEST_F(TwoMachinesTest, SurvivesClientInterfaceDown) {
  const RunningProgram running(service());
  ChildProcess client(endless_run());
  ASSERT_TRUE(advances(client));
  machines_.take_interface_down();
  // Ten timeouts during which no request can be sent. The attempts are not visible outside the client.
  EXPECT_EQ(client.wait(0.5), std::nullopt) << client.standard_error();
  machines_.bring_interface_up();
  EXPECT_FALSE(machines_.error()) << *machines_.error();
  ASSERT_TRUE(advances(client));
  interrupt_and_compare(client);
}

}  // namespace
}  // namespace buoyancy
