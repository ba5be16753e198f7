// buoyancyd as a program: arguments, exit codes, signals, log and status.
#include <algorithm>
#include <csignal>
#include <set>

#include <gtest/gtest.h>

#include "tests/service/running_service.h"
#include "tests/support/build_paths.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

FinishedProcess run(std::vector<std::string> arguments) {
  return run_program("buoyancyd", std::move(arguments));
}

// Expects this exit code, nothing on stdout, and one line on stderr that contains `text`.
void expect_failure(const FinishedProcess& finished, int exit_code, const std::string& text) {
  EXPECT_EQ(finished.exit_code, exit_code) << finished.standard_error;
  EXPECT_EQ(finished.standard_output, "");
  const std::string& error = finished.standard_error;
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
  EXPECT_EQ(error.rfind("buoyancyd: ", 0), 0U) << error;
  EXPECT_TRUE(contains(error, text));
}

class BuoyancydTermination : public testing::TestWithParam<int> {};

TEST_P(BuoyancydTermination, LogsTotalsAndExitsWithSuccess) {
  RunningService service;
  RawLcmSocket socket;
  send_request(socket, one_body(1, 1, 0.0));
  receive(socket);
  service.child().send_signal(GetParam());
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0);
  const std::string log = service.log();
  EXPECT_TRUE(contains(log, GetParam() == SIGINT ? "received SIGINT" : "received SIGTERM"));
  EXPECT_TRUE(contains(log, "1 requests: 1 computed"));
  EXPECT_EQ(service.child().standard_output(), "");
}

INSTANTIATE_TEST_SUITE_P(Signals, BuoyancydTermination, testing::Values(SIGINT, SIGTERM));

TEST(Buoyancyd, LogsItsConfigurationWhenReady) {
  RunningService service({"-l", "udpm://239.255.76.67:7667?ttl=0", "--mode", "latest"});
  const std::string log = service.log();
  for (const char* text :
       {"ready: 2 bodies", "BUOYANCY_STATES", "BUOYANCY_WRENCHES", "BUOYANCY_HYDROSTATICS", "BUOYANCY_LOADS",
        "BUOYANCY_STATUS", "udpm://239.255.76.67:7667?ttl=0", "mode latest"}) {
    EXPECT_TRUE(contains(log, text));
  }
}

TEST(Buoyancyd, RejectsInvalidArgumentsWithOneLineAndUsageError) {
  const TempDir directory;
  const std::string scene = directory.write("scene.toml", kBoxScene);
  expect_failure(run({}), 2, "--scene");
  expect_failure(run({"--scene"}), 2, "--scene");
  expect_failure(run({"--scene", scene, "--no-such-option"}), 2, "--no-such-option");
  expect_failure(run({"--scene", scene, "more"}), 2, "more");
  expect_failure(run({"--scene", scene, "--mode", "fast"}), 2, "--mode");
  expect_failure(run({"--scene", scene, "--log-level", "loud"}), 2, "--log-level");
  expect_failure(run({"--scene", scene, "--json"}), 2, "--check");
  expect_failure(run({"--scene", scene, "-l", "tcpq://127.0.0.1:7700"}), 2, "tcpq://");
  expect_failure(run({"--scene", scene, "-l", "udpm://1.2.3.4:7667"}), 2, "1.2.3.4");
  expect_failure(run({"--scene", scene, "--states-channel", ""}), 2, "0 characters");
  expect_failure(run({"--scene", scene, "--states-channel", std::string(64, 'a')}), 2, "64 characters");
  expect_failure(run({"--scene", scene, "--states-channel", "BUOYANCY_WRENCHES"}), 2, "two are equal");
  expect_failure(run({"--scene", scene, "--hydrostatics-channel", "BUOYANCY_WRENCHES"}), 2, "two are equal");
  expect_failure(run({"--scene", scene, "--loads-channel", "BUOYANCY_WRENCHES"}), 2, "two are equal");
  expect_failure(run({"--scene", scene, "--condition-channel", "BUOYANCY_SEA"}), 2, "two are equal");
  expect_failure(run({"--scene", scene, "--pose", "BUOYANCY_LOADS=1"}), 2, "used for two purposes");
  expect_failure(run({"--scene", scene, "--pose", "BUOYANCY_CONDITION=1"}), 2, "used for two purposes");
  expect_failure(run({"--scene", scene, "--inject", ""}), 2, "no fault");
  expect_failure(run({"--scene", scene, "--inject", "drop=2"}), 2, "a probability from 0 to 1");
  expect_failure(run({"--scene", scene, "--inject", "dorp=0.1"}), 2, "The nearest is 'drop'");
  expect_failure(run({"--scene", scene, "--inject", "drop=0.1,drop=0.1"}), 2, "for the second time");
  expect_failure(run({"--scene", scene, "--inject", "stall=60s/2s"}), 2, "shorter than its period");
}

TEST(Buoyancyd, RefusesPosesThatCannotGiveTheVelocitiesThatDragNeeds) {
  const TempDir directory;
  const std::string scene = directory.write("scene.toml", kLoadsBoxScene);
  expect_failure(run({"--scene", scene, "--pose", "HULL=hull"}), 2,
                 "--pose HULL=1: no --velocity-frame; expected --velocity-frame world or body, since body "
                 "'hull' has drag or added mass");
}

TEST(Buoyancyd, RejectsInvalidScenesAndMeshesWithUsageError) {
  const TempDir directory;
  expect_failure(run({"--scene", directory.path("missing.toml")}), 2, "missing.toml");
  expect_failure(run({"--scene", directory.path(".")}), 2, directory.path("."));
  expect_failure(run({"--scene", directory.write("bad.toml", "[[body]]\nid = ")}), 2, "bad.toml");
  directory.write("bad.stl", "solid nothing at all");
  expect_failure(run({"--scene", directory.write("scene.toml", "[[body]]\nid = 1\nmesh = \"bad.stl\"\n")}), 2,
                 "bad.stl");
  expect_failure(
      run({"--scene", directory.write("scene.toml", "[[body]]\nid = 1\nmesh = \"gone.stl\"\n"), "--check"}),
      2, "gone.stl");
}

TEST(Buoyancyd, PrintsFixForMissingMulticastRoute) {
  const TempDir directory;
  const std::string scene = directory.write("scene.toml", kBoxScene);
  const FinishedProcess finished =
      run_to_end(command_of({"unshare", "-n", "sh", "-c", "ip link set lo up && exec \"$0\" --scene \"$1\"",
                             built_program("buoyancyd"), scene}),
                 kWaitTimeout);
  expect_failure(finished, 1, "ip route add 224.0.0.0/4 dev lo");
}

TEST(Buoyancyd, LogsLostRouteAndRecoversWhenItReturns) {
  RunningService service;
  const std::vector<std::string> route{"224.0.0.0/4", "dev", "lo"};
  ASSERT_EQ(
      run_to_end(command_of({"ip", "route", "del", route[0], route[1], route[2]}), kWaitTimeout).exit_code,
      0);
  EXPECT_TRUE(service.child().wait_for_text("was not sent (Network is unreachable)", kWaitTimeout))
      << service.log();
  ASSERT_EQ(
      run_to_end(command_of({"ip", "route", "add", route[0], route[1], route[2]}), kWaitTimeout).exit_code,
      0);
  RawLcmSocket socket;
  send_request(socket, one_body(1, 1, 0.0));
  EXPECT_EQ(receive(socket).id.seq, 1);
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) { return status.send_failures > 0; }));
}

TEST(Buoyancyd, WarnsAboutAnotherInstanceOnItsChannels) {
  RunningService first;
  RawLcmSocket bus;
  for (int received = 0; received < 3; ++received) ASSERT_TRUE(bus.receive("BUOYANCY_STATUS", kWaitTimeout));
  EXPECT_FALSE(contains(first.log(), "another buoyancyd"));  // its own status
  RunningService second;
  EXPECT_TRUE(first.child().wait_for_text("another buoyancyd", kWaitTimeout)) << first.log();
  EXPECT_TRUE(second.child().wait_for_text("another buoyancyd", kWaitTimeout)) << second.log();
}

// The spdlog level names that occur in the log.
std::set<std::string> levels_in(const std::string& log) {
  std::set<std::string> found;
  for (const char* level : {"debug", "info", "warning", "error"}) {
    if (log.find("[" + std::string(level) + "]") != std::string::npos) found.insert(level);
  }
  return found;
}

class LogLevel : public testing::TestWithParam<std::pair<const char*, std::set<std::string>>> {};

TEST_P(LogLevel, LogsItsOwnAndMoreSevereLines) {
  const auto& [level, expected] = GetParam();
  const TempDir directory;
  const std::string scene = directory.write("scene.toml", kBoxScene);
  ChildProcess child(command_of({built_program("buoyancyd"), "--scene", scene, "--log-level", level}));
  RawLcmSocket socket;
  ASSERT_TRUE(socket.receive("BUOYANCY_STATUS", kWaitTimeout));  // ready, whatever it logs
  socket.send("BUOYANCY_STATES", {1, 2, 3});                     // causes a warning
  send_request(socket, one_body(7, 3, 0.0));
  EXPECT_EQ(receive(socket).id.seq, 3);
  directory.write("scene.toml", "nothing");
  child.send_signal(SIGHUP);
  ASSERT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    return status.counters.rejected() == 1 && status.reloads_failed == 1;
  }));
  child.send_signal(SIGTERM);
  EXPECT_EQ(child.wait(kWaitTimeout), 0);
  const std::string log = child.standard_error();
  EXPECT_EQ(levels_in(log), expected) << log;
  EXPECT_EQ(log.find("session 7 with seq 3") != log.npos, expected.contains("debug")) << log;
  EXPECT_EQ(log.find("ready:") != log.npos, expected.contains("info")) << log;
  EXPECT_EQ(log.find("messages rejected") != log.npos, expected.contains("warning")) << log;
  EXPECT_EQ(log.find("reload failed") != log.npos, expected.contains("error")) << log;
}

INSTANTIATE_TEST_SUITE_P(Levels, LogLevel,
                         testing::Values(std::pair{"debug", std::set<std::string>{"debug", "info", "warning",
                                                                                  "error"}},
                                         std::pair{"info", std::set<std::string>{"info", "warning", "error"}},
                                         std::pair{"warning", std::set<std::string>{"warning", "error"}},
                                         std::pair{"error", std::set<std::string>{"error"}},
                                         std::pair{"off", std::set<std::string>{}}),
                         [](const auto& level) { return level.param.first; });

TEST(Buoyancyd, PrefixesJournalLinesWithTheirLevelWithoutTime) {
  const TempDir directory;
  const std::string scene = directory.write("scene.toml", kBoxScene);
  const auto started = [&scene](const std::string& journal_stream) {
    return command_of({"bash", "-c",
                       "export JOURNAL_STREAM=" + journal_stream + "; exec \"$0\" --scene \"$1\"",
                       built_program("buoyancyd"), scene});
  };
  RunningProgram child(started("$(stat -L -c %d:%i /dev/stderr)"));
  EXPECT_TRUE(child.standard_error().starts_with("<6>ready: 2 bodies;")) << child.standard_error();
  directory.write("scene.toml", "nothing");
  child.send_signal(SIGHUP);
  EXPECT_TRUE(child.wait_for_text("\n<3>reload failed", kWaitTimeout)) << child.standard_error();
  ChildProcess failed(started("$(stat -L -c %d:%i /dev/stderr)"));
  EXPECT_EQ(failed.wait(kWaitTimeout), 2);
  EXPECT_TRUE(failed.standard_error().starts_with("<3>buoyancyd: ")) << failed.standard_error();

  directory.write("scene.toml", kBoxScene);
  ChildProcess redirected(started("1:2"));
  ASSERT_TRUE(redirected.wait_for_text("[info] ready:", kWaitTimeout)) << redirected.standard_error();
}

TEST(Buoyancyd, PublishesConfigurationAndUptimeInItsStatus) {
  RunningService service({"--mode", "latest"});
  RawLcmSocket socket;
  const auto first = wait_for_status(socket, [](const ServiceStatus&) { return true; });
  ASSERT_TRUE(first);
  EXPECT_EQ(first->version, BUOYANCY_VERSION);
  EXPECT_EQ(first->scene, service.path("scene.toml"));
  EXPECT_EQ(first->mode, ServiceMode::kLatest);
  EXPECT_EQ(first->scene_bodies, 2);
  EXPECT_GE(first->uptime, 0.0);
  EXPECT_LT(first->uptime, kWaitTimeout);
  service.child().send_signal(SIGHUP);
  const auto reloaded =
      wait_for_status(socket, [](const ServiceStatus& status) { return status.reloads == 1; });
  ASSERT_TRUE(reloaded);
  EXPECT_EQ(reloaded->reloads_failed, 0);
  EXPECT_GT(reloaded->uptime, first->uptime);
}

TEST(Buoyancyd, PublishesLongestQueueWaitOfLastSecond) {
  const RunningService service;
  RawLcmSocket socket;
  WrenchRequest states = one_body(1, 0, 0.0);
  states.bodies.resize(20, states.bodies[0]);  // a burst fits into the receive buffer that every user gets
  // The last request of a burst waits for those before it. There are several bursts, since the test may be
  // suspended during one.
  bool waited = false;
  for (int burst = 0; burst < 20 && !waited; ++burst) {
    for (int request = 0; request < 40; ++request) {
      states.id.seq++;
      for (BodyState& body : states.bodies) body.position[2] = 0.001 * static_cast<double>(states.id.seq);
      send_request(socket, states);
    }
    const std::int64_t requests = states.id.seq;
    EXPECT_TRUE(wait_for_status(socket, [&waited, requests](const ServiceStatus& status) {
      waited = waited || status.queue_wait > 3 * status.latency.p50;
      return status.counters.requests == requests;
    }));
  }
  EXPECT_TRUE(waited);
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) { return status.queue_wait == 0.0; }))
      << "covers the last second only";
}

TEST(Buoyancyd, ChecksSceneWithoutNetwork) {
  const TempDir directory;
  const std::string scene = directory.write("scene.toml", kBoxScene);
  const FinishedProcess text = run({"--scene", scene, "--check"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_EQ(text.standard_error, "");
  EXPECT_TRUE(contains(text.standard_output, "volume"));
  const FinishedProcess json = run({"--scene", scene, "--check", "--json"});
  EXPECT_EQ(json.exit_code, 0);
  EXPECT_TRUE(parse_json(json.standard_output).is_object());
}

TEST(Buoyancyd, FailsIfItsReportCannotBeWritten) {
  const TempDir directory;
  ChildCommand command = command_of(
      {built_program("buoyancyd"), "--scene", directory.write("scene.toml", kBoxScene), "--check"});
  command.standard_output = "/dev/full";
  expect_failure(run_to_end(command, kWaitTimeout), 1, "standard output");
}

TEST(Buoyancyd, PrintsVersionAndHelp) {
  const FinishedProcess finished = run({"--version"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.standard_output, "buoyancyd " BUOYANCY_VERSION "\n");
  EXPECT_EQ(run({"--help"}).exit_code, 0);
}

}  // namespace
}  // namespace buoyancy
