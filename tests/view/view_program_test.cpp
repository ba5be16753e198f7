// buoyancy-view as a separate process with the real service and the real client, over UDP.
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <sched.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/support/build_paths.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"
#include "tests/view/moving_bodies.h"
#include "tests/view/running_view.h"

namespace buoyancy::view {
namespace {

using nlohmann::json;

// Body 2 has the output "hydrostatics", so that its metacentres are on the bus.
const std::string kScene = kHydrostaticBoxScene;

ChildCommand client(const std::string& scene, std::vector<std::string> options) {
  options.insert(options.begin(), {built_program("buoyancy-client"), "--scene", scene});
  return command_of(std::move(options));
}

// Returns the first snapshot that satisfies `condition`. Throws if there is none within kWaitTimeout.
template <typename Condition>
json wait_for_snapshot(EventReader& events, Condition&& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  json snapshot;
  while (std::chrono::steady_clock::now() < deadline) {
    const std::optional<std::string> text = events.next(kWaitTimeout);
    if (!text) break;
    snapshot = parse_json(*text);
    if (condition(snapshot)) return snapshot;
  }
  throw std::runtime_error("no such snapshot; the last one: " + snapshot.dump());
}

TEST(ViewProgram, ShowsRunOfRealPrograms) {
  RunningView view(kScene);
  EventReader events(view.port());
  RunningService service({}, kScene);
  // Body 1 has no [body.client]; the client simulates body 2. The packets of this run, three per step, fit
  // into the kernel's buffer, so the view loses none even if it reads them late.
  const FinishedProcess run =
      run_to_end(client(service.path("scene.toml"), {"--duration", "0.05"}), kWaitTimeout);
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  RawLcmSocket socket;
  send_request(socket, one_body(7, 1, 0.0));
  const json snapshot = wait_for_snapshot(events, [](const json& now) {
    return now["counts"]["responses"].get<int>() > 50 && now["bodies"].size() == 2 &&
           !now["bodies"][0]["f"].is_null();
  });
  const json& counts = snapshot["counts"];
  EXPECT_EQ(counts["responses"], counts["requests"]);
  EXPECT_EQ(counts["responses_without_request"], 0);
  EXPECT_EQ(counts["requests_missed"], 0);
  EXPECT_EQ(snapshot["service"], "answering");
  EXPECT_GT(snapshot["latency"]["p50"].get<double>(), 0.0);
  EXPECT_LE(snapshot["latency"]["p50"].get<double>(), snapshot["latency"]["max"].get<double>());
  const json& upright = snapshot["bodies"][0];
  EXPECT_EQ(upright["p"], json({1.0, 2.0, 0.0}));
  EXPECT_NEAR(upright["f"][2].get<double>(), 2.0 * 3.0 * 2.0 * 1e4, 1e-2) << "half submerged";
  EXPECT_TRUE(upright["m"].is_null());
  const json& floating = snapshot["bodies"][1];
  EXPECT_EQ(floating["status"], 0);
  EXPECT_TRUE(floating["m"].is_array()) << floating;
}

TEST(ViewProgram, ServesMetricsOnlyIfAsked) {
  RunningView view(kScene, {"--metrics"});
  const auto metrics = [&view] {
    HttpPeer peer(view.port());
    peer.send(get_request("/metrics"));
    return peer.receive_all(kWaitTimeout);
  };
  EXPECT_TRUE(contains(metrics(), "\nbuoyancy_up 0\n"));
  RunningService service({}, kScene);
  RawLcmSocket socket;
  send_request(socket, one_body(7, 1, 0.0));
  receive(socket);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  std::string text;
  while (!contains(text, "\nbuoyancy_requests_total 1\n") && std::chrono::steady_clock::now() < deadline) {
    text = metrics();
  }
  for (const char* line :
       {"Content-Type: text/plain; version=0.0.4; charset=utf-8", "# TYPE buoyancy_requests_total counter",
        "buoyancy_up 1", "buoyancy_scene_bodies 2", "buoyancy_bodies_ok_total 1", "buoyancy_sessions 1",
        "# TYPE buoyancy_latency_p99_seconds gauge", "\nbuoyancy_info{version=\""}) {
    EXPECT_TRUE(contains(text, line)) << text;
  }
  RunningView other(kScene);
  HttpPeer peer(other.port());
  peer.send(get_request("/metrics"));
  EXPECT_TRUE(contains(peer.receive_all(kWaitTimeout), "404 Not Found"));
}

TEST(ViewProgram, ShowsLoadsOfRealPrograms) {
  RunningView view(moving_bodies());
  EventReader events(view.port());
  RunningService service({}, moving_bodies());
  const FinishedProcess run =
      run_to_end(client(service.path("scene.toml"), {"--duration", "0.05"}), kWaitTimeout);
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  // Wrench and loads are two messages; a snapshot taken between them has those of different steps.
  const auto loads_add_up = [](const json& body) {
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0.0;
      for (const char* part : {"buoyancy", "drag", "added_mass"}) sum += body["loads"][part][i].get<double>();
      if (std::abs(sum - body["f"][i].get<double>()) > 0.01) return false;
    }
    return true;
  };
  const json snapshot = wait_for_snapshot(events, [&](const json& now) {
    return now["counts"]["responses"].get<int>() > 50 && now["bodies"].size() == 1 &&
           now["bodies"][0].contains("loads") && loads_add_up(now["bodies"][0]);
  });
  const json& body = snapshot["bodies"][0];
  const json& loads = body["loads"];
  EXPECT_EQ(loads["water_velocity"], json({0.5, -0.25, 0.125})) << "the current";
  EXPECT_GT(loads["drag"][2].get<double>(), 100.0) << "it falls into the water at 1 m/s";
  EXPECT_NEAR(loads["immersion"].get<double>(), body["volume"].get<double>() / 2.0, 1e-6);
}

TEST(ViewProgram, ReportsServiceOfflineAndBack) {
  RunningView view(kScene);
  EventReader events(view.port());
  const auto service_is = [](const std::string& state) {
    return [state](const json& now) { return now["service"] == state; };
  };
  std::string first_instance;
  {
    RunningService service({}, kScene);
    const json snapshot = wait_for_snapshot(events, service_is("idle"));
    first_instance = snapshot["status"]["instance_id"];
    EXPECT_EQ(snapshot["services"], json({first_instance}));
    service.child().send_signal(SIGKILL);
  }
  const json offline = wait_for_snapshot(events, service_is("offline"));
  EXPECT_GT(offline["status_age"].get<double>(), 3.0);
  EXPECT_EQ(offline["status"]["instance_id"], first_instance) << "the last status is still shown";
  RunningService again({}, kScene);
  const json back = wait_for_snapshot(events, service_is("idle"));
  EXPECT_NE(back["status"]["instance_id"], first_instance);
  EXPECT_EQ(back["counts"]["services_started"], 2);
}

TEST(ViewProgram, ReportsStoppedServiceAsNotAnswering) {
  RunningView view(kScene);
  EventReader events(view.port());
  RunningService service({}, kScene);
  RawLcmSocket socket;
  wait_for_snapshot(events, [](const json& now) { return now["service"] == "idle"; });
  service.stop();
  // This state ends after a few seconds without a status; a test that was suspended for as long tries again.
  wait_for_snapshot(events, [&service, &socket, seq = 0](const json& now) mutable {
    send_request(socket, one_body(7, ++seq, 0.0));
    if (now["service"] == "offline") service.child().send_signal(SIGCONT);
    if (now["service"] == "answering") service.stop();
    return now["service"] == "not answering";
  });
  service.child().send_signal(SIGCONT);
  wait_for_snapshot(events, [](const json& now) { return now["service"] != "not answering"; });
}

TEST(ViewProgram, DetectsTwoServicesOnOneBus) {
  RunningView view(kScene);
  EventReader events(view.port());
  RunningService one({}, kScene);
  RunningService other({}, kScene);
  RawLcmSocket socket;
  send_request(socket, one_body(7, 1, 0.0));
  const json snapshot = wait_for_snapshot(events, [](const json& now) {
    return now["services"].size() == 2 && now["counts"]["responses_repeated"].get<int>() > 0;
  });
  EXPECT_EQ(snapshot["counts"]["responses"], 1);
}

TEST(ViewProgram, UsesConfiguredChannels) {
  RunningView view(kScene, {"--states-channel", "S.*", "--wrenches-channel", "W", "--status-channel", "T"});
  EventReader events(view.port());
  RunningService service({"--states-channel", "S.*", "--wrenches-channel", "W", "--status-channel", "T"},
                         kScene);
  RawLcmSocket socket;
  send_request(socket, one_body(7, 1, 0.0));  // on a channel that it does not receive
  socket.send("S.*", encoded(one_body(8, 1, 0.0)));
  const json snapshot =
      wait_for_snapshot(events, [](const json& now) { return now["counts"]["responses"] == 1; });
  EXPECT_EQ(snapshot["counts"]["requests"], 1);
}

TEST(ViewProgram, ShowsBotCorePosesAndResponses) {
  const std::vector<std::string> poses{"--pose",         "HULL=1",          "--pose", "HULL_ESTIMATE=2",
                                       "--force-torque", "FORCE_ON_HULL=2", "--pose", "HULL_TRUTH=2"};
  RunningView view(kScene, poses);
  EventReader events(view.port());
  RunningService service(poses, kScene);
  RawLcmSocket socket;
  for (std::int64_t i = 0; i < 10; ++i) {
    socket.send("HULL", encoded_by_lcm(upright_pose(0.0, 100 + i)));
    socket.send("HULL_ESTIMATE", encoded_by_lcm(upright_pose(1.0, 200 + i)));
    socket.send("HULL_TRUTH", encoded_by_lcm(upright_pose(1.0, 300 + i)));
  }
  const json snapshot =
      wait_for_snapshot(events, [](const json& now) { return now["counts"]["responses"] == 30; });
  EXPECT_EQ(snapshot["counts"]["responses_without_request"], 0);
  EXPECT_EQ(snapshot["counts"]["requests_missed"], 0);
  EXPECT_EQ(snapshot["service"], "answering");
  EXPECT_GT(snapshot["latency"]["p50"].get<double>(), 0.0);
  EXPECT_EQ(snapshot["bodies"][0]["p"], json({0.0, 0.0, 0.0}));
  EXPECT_NEAR(snapshot["bodies"][0]["f"][2].get<double>(), 2.0 * 3.0 * 2.0 * 1e4, 1e-2);
  EXPECT_NEAR(snapshot["bodies"][1]["f"][2].get<double>(), 2.0 * 3.0 * 1.0 * 1e4, 1e-2);
  EXPECT_TRUE(snapshot["bodies"][1]["status"].is_null()) << "force and torque only";
}

TEST(ViewProgram, SurvivesMalformedPackets) {
  RunningView view(kScene);
  EventReader events(view.port());
  RawLcmSocket socket;
  socket.send_packet({});
  socket.send_packet({'L', 'C', '0', '2'});
  socket.send("BUOYANCY_STATES", {});
  socket.send("BUOYANCY_STATUS", RawBytes(100, 0xff));
  const json snapshot = wait_for_snapshot(events, [](const json& now) {
    const json& malformed = now["counts"]["malformed"];
    return malformed["shorter than the fixed fields"].get<int>() == 2;
  });
  EXPECT_EQ(snapshot["service"], "offline");
}

TEST(ViewProgram, ExitsOnSignalWithConnectedPages) {
  for (const int signal : {SIGINT, SIGTERM}) {
    RunningView view(kScene);
    EventReader events(view.port());
    ASSERT_TRUE(events.next(kWaitTimeout));
    view.child().send_signal(signal);
    EXPECT_EQ(view.child().wait(kWaitTimeout), 0);
    while (events.next(kWaitTimeout)) {
    }
    EXPECT_EQ(view.child().standard_error(), "");
  }
}

// The scheduling policies of the process's threads.
std::set<int> policies_of(const ChildProcess& process) {
  std::set<int> policies;
  for (const auto& thread :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process.pid()) + "/task")) {
    policies.insert(sched_getscheduler(std::stoi(thread.path().filename())));
  }
  return policies;
}

TEST(ViewProgram, UsesIdleSchedulingByDefault) {
  const TempDir directory;
  ChildProcess view(command_of(
      {built_program("buoyancy-view"), "--scene", directory.write("scene.toml", kScene), "--port", "0"}));
  // It is not ready for as long as the machine is busy. Its later threads inherit the policy.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (policies_of(view) != std::set<int>{SCHED_IDLE} && std::chrono::steady_clock::now() < deadline) {
    ASSERT_FALSE(view.wait(0.002)) << view.standard_error();
  }
  EXPECT_EQ(policies_of(view), std::set<int>{SCHED_IDLE});
  RunningView normal(kScene);
  EXPECT_EQ(policies_of(normal.child()), std::set<int>{SCHED_OTHER});
}

TEST(ViewProgram, WarnsIfMessagesMayNotFitReceiveBuffer) {
  std::string scene;
  for (int id = 1; id <= 30; ++id) {
    scene += "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = [1, 1, 1] }\n";
  }
  RunningView view(scene, {"-l", "udpm://239.255.76.67:7667?recv_buf_size=3000"});
  EXPECT_TRUE(view.child().wait_for_text(
      "buoyancy-view: warning: the messages of a step of all 30 bodies: 6440 bytes", kWaitTimeout))
      << view.child().standard_error();
  RunningView enough(scene);
  EXPECT_EQ(enough.child().standard_error(), "");
}

TEST(ViewProgram, ReportsErrorsInOneLineAndExitCode) {
  TempDir directory;
  const std::string scene = directory.write("scene.toml", kScene);
  for (const std::vector<std::string>& options : {std::vector<std::string>{},
                                                  {"--scene", scene, "--port", "65536"},
                                                  {"--scene", scene, "--port", "-1"},
                                                  {"--scene", scene, "--listen", "localhost"},
                                                  {"--scene", scene, "-l", "tcpq://"},
                                                  {"--scene", scene, "--what"},
                                                  {"--scene", scene, "--scheduling", "best"},
                                                  {"--scene", scene, "--states-channel", "BUOYANCY_STATUS"},
                                                  {"--scene", scene, "--loads-channel", "BUOYANCY_STATUS"},
                                                  {"--scene", scene, "--pose", "HULL=77"},
                                                  {"--scene", scene, "--pose", "BUOYANCY_STATUS=1"},
                                                  {"--scene", directory.path("absent.toml")}}) {
    const FinishedProcess view = run_program("buoyancy-view", options);
    EXPECT_EQ(view.exit_code, 2) << testing::PrintToString(options);
    EXPECT_TRUE(view.standard_error.starts_with("buoyancy-view: ")) << view.standard_error;
    EXPECT_EQ(view.standard_output, "");
  }
  const RunningView other(kScene);
  const FinishedProcess taken =
      run_program("buoyancy-view", {"--scene", scene, "--port", std::to_string(other.port())});
  EXPECT_EQ(taken.exit_code, 1);
  EXPECT_TRUE(contains(taken.standard_error, "Address already in use"));
}

}  // namespace
}  // namespace buoyancy::view
