// Service and client on two machines, joined by a switch: real programs in network namespaces of their own,
// ttl=1. What the way between them does costs time and changes no byte of a lock-step run.
//
// BUOYANCY_CUT_SECONDS: how long the cable is out; 3 s where it is not set (scripts/two_machines takes 30).
#include "tests/client/two_machines.h"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/client/closed_loop.h"
#include "tests/client/lossy_relay.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

constexpr double kReady = 60.0;  // s
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
      std::getenv("BUOYANCY_CUT_SECONDS");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return set != nullptr ? std::stod(set) : 3.0;
}

class TwoMachinesTest : public testing::Test {
 protected:
  void SetUp() override {
    // Network namespaces are root's, and not every container's kernel lets even root make them.
    if (machines_.trouble()) GTEST_SKIP() << "network: " << *machines_.trouble();
  }

  std::string embedded(const std::string& duration) {
    const std::string csv = directory_.path("embedded.csv");
    simulate(scene_, {"--embedded", "--duration", duration, "--csv", csv});
    return read_file(csv);
  }

  ChildCommand service() const {
    return machines_.on_the_services(service_command(scene_, {"-l", kTwoMachinesUrl}));
  }

  std::uintmax_t written() const {
    return std::filesystem::exists(csv_) ? std::filesystem::file_size(csv_) : 0;
  }

  // Returns in the middle of the client's run of 20 s of the scene's time, which goes into csv_. Throws where
  // it was over before.
  void be_under_way(ChildProcess& client) const {
    while (written() < 300'000 && !client.wait(0.001)) {
    }
    if (client.wait(0.0)) throw std::runtime_error("the client ended before: " + client.standard_error());
  }
  ChildCommand long_run() const {
    return client_command(scene_, {"-l", kTwoMachinesUrl, "--duration", "20", "--csv", csv_, "--timeout",
                                   "0.05", "--retries", "10000", "--json"});
  }

  TwoMachines machines_;
  TemporaryDirectory directory_;
  std::string csv_ = directory_.path("run.csv");
  std::string scene_ = directory_.write("scene.toml", kScene);
};

TEST_F(TwoMachinesTest, ARunAcrossThemGivesTheBytesOfARunInOneProcess) {
  ChildProcess running(service());
  ASSERT_TRUE(running.wait_for_text("ready", kReady)) << running.standard_error();
  const std::string csv = directory_.path("across.csv");
  simulate(scene_, {"-l", kTwoMachinesUrl, "--duration", "2", "--csv", csv});
  EXPECT_TRUE(read_file(csv) == embedded("2"));
}

TEST_F(TwoMachinesTest, WithTtlZeroTheyDoNotHearEachOther) {
  ChildProcess running(service());
  ASSERT_TRUE(running.wait_for_text("ready", kReady)) << running.standard_error();
  const FinishedProcess finished =
      run_to_end(client_command(scene_, {"-l", kServiceUrl, "--timeout", "0.05", "--retries", "3"}), kReady);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.standard_error.find("no answer"), std::string::npos) << finished.standard_error;
}

TEST_F(TwoMachinesTest, LossDuplicationAndReorderingOnTheWayChangeNoByte) {
  ChildProcess running(service());
  ASSERT_TRUE(running.wait_for_text("ready", kReady)) << running.standard_error();
  RelayOptions options{kClientUrl, kTwoMachinesUrl, 0.05, 0.0, 7};
  options.duplication = 0.1;
  options.reordering = 0.1;
  const LossyRelay relay(options);
  const std::string csv = directory_.path("bad_way.csv");
  const nlohmann::json summary = simulate(scene_, {"-l", kClientUrl, "--duration", "2", "--csv", csv,
                                                   "--timeout", "0.005", "--retries", "10000"});
  EXPECT_TRUE(read_file(csv) == embedded("2"));
  EXPECT_GT(relay.lost_questions() + relay.lost_answers(), 100);
  EXPECT_GT(relay.duplicated(), 200);
  EXPECT_GT(relay.reordered(), 200);
  EXPECT_EQ(summary["lost"], 0);
}

TEST_F(TwoMachinesTest, ARunOutlastsTheCableBeingOutAndSaysHowLongItWaited) {
  ChildProcess running(service());
  ASSERT_TRUE(running.wait_for_text("ready", kReady)) << running.standard_error();
  ChildProcess client(long_run());
  be_under_way(client);
  machines_.pull_cable();
  ASSERT_EQ(client.wait(0.5), std::nullopt);  // what was on its way has arrived
  const auto at_the_cut = written();
  ASSERT_EQ(client.wait(cut_seconds()), std::nullopt) << client.standard_error();
  EXPECT_EQ(written(), at_the_cut) << "the cable was not out";
  machines_.plug_cable();
  EXPECT_FALSE(machines_.trouble()) << *machines_.trouble();
  ASSERT_EQ(client.wait(kRunTimeout), 0) << client.standard_error();
  EXPECT_TRUE(read_file(csv_) == embedded("20"));
  const nlohmann::json summary = nlohmann::json::parse(client.standard_output());
  EXPECT_GE(summary["round_trip"]["max"], cut_seconds());
  EXPECT_GE(summary["retries"], 1);
  EXPECT_EQ(summary["lost"], 0);
}

TEST_F(TwoMachinesTest, ARunOutlastsItsMachinesInterfaceBeingTakenDown) {
  ChildProcess running(service());
  ASSERT_TRUE(running.wait_for_text("ready", kReady)) << running.standard_error();
  ChildProcess client(long_run());
  be_under_way(client);
  machines_.take_interface_down();
  EXPECT_EQ(client.wait(1.0), std::nullopt) << client.standard_error();
  machines_.bring_interface_up();
  EXPECT_FALSE(machines_.trouble()) << *machines_.trouble();
  ASSERT_EQ(client.wait(kRunTimeout), 0) << client.standard_error();
  EXPECT_TRUE(read_file(csv_) == embedded("20"));
}

}  // namespace
}  // namespace buoyancy
