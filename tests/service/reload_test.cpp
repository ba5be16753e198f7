// SIGHUP during a session over UDP: buoyancyd replaces its scene.
#include <chrono>
#include <cmath>
#include <csignal>

#include <gtest/gtest.h>

#include "tests/geometry/mesh_files.h"
#include "tests/service/leased_file.h"
#include "tests/service/running_service.h"
#include "tests/support/contains.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

// One body: a box of 2 x 3 m and this height [m], in water of this density [kg/m^3].
std::string box_scene(double density, double height) {
  return "[world]\ngravity = 10.0\n[water]\ndensity = " + std::to_string(density) +
         "\n[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 3, " + std::to_string(height) +
         "], segments = [1, 1, 1] }\n";
}
const std::string kBefore = box_scene(1000.0, 4.0);
constexpr double kForceBefore = 120'000.0;  // [N], half submerged

constexpr double kHalfSubmerged = 0.0;  // [m], height of the body's origin
constexpr double kSubmerged = -100.0;

double vertical_force(RawLcmSocket& socket, std::int64_t seq, double height = kHalfSubmerged) {
  send_request(socket, one_body(1, seq, height));
  const WrenchResponse response = receive(socket);
  EXPECT_EQ(response.id.session_id, 1);
  EXPECT_EQ(response.id.seq, seq);
  return response.bodies.at(0).force[2];
}

// Sends requests until the condition holds for the last force. Returns false if it does not in time.
template <typename Condition>
bool request_until(RawLcmSocket& socket, std::int64_t& seq, double height, const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (!condition(vertical_force(socket, seq++, height))) {
    if (std::chrono::steady_clock::now() > deadline) return false;
  }
  return true;
}

void reload(RunningService& service, const std::string& scene, const std::string& until) {
  service.write("scene.toml", scene);
  service.child().send_signal(SIGHUP);
  ASSERT_TRUE(service.child().wait_for_text(until, kWaitTimeout)) << service.log();
}

// The exit code also shows the findings of a sanitizer.
void expect_clean_exit(RunningService& service) {
  service.child().send_signal(SIGTERM);
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0) << service.log();
}

std::size_t lines_with(const std::string& text, const std::string& log) {
  std::size_t count = 0;
  for (std::size_t at = log.find(text); at != std::string::npos; at = log.find(text, at + 1)) ++count;
  return count;
}

TEST(Reload, UsesNewSceneFromNextRequestOfSession) {
  RunningService service({}, kBefore);
  RawLcmSocket socket;
  EXPECT_NEAR(vertical_force(socket, 1), kForceBefore, 1e-6);
  reload(service, box_scene(500.0, 4.0), "reloaded: 1 body");
  EXPECT_NEAR(vertical_force(socket, 2), 0.5 * kForceBefore, 1e-6);
  reload(service, box_scene(500.0, 8.0) + "[[body]]\nid = 2\nshape = { type = \"box\", size = [1, 1, 1] }\n",
         "reloaded: 2 bodies (before: 1)");
  EXPECT_NEAR(vertical_force(socket, 3), kForceBefore, 1e-6);
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    return status.counters.computed == 3 && status.counters.sessions == 1 && status.counters.stale == 0;
  }));
}

TEST(Reload, KeepsResponsesOfOldSceneForRetries) {
  RunningService service({}, kBefore);
  RawLcmSocket socket;
  send_request(socket, one_body(1, 5, 0.3));
  const auto first = receive_bytes(socket);
  ASSERT_TRUE(first);
  reload(service, box_scene(500.0, 4.0), "reloaded:");
  send_request(socket, one_body(1, 5, 0.3));
  EXPECT_EQ(receive_bytes(socket), first);
  send_request(socket, one_body(1, 6, 0.3));
  const auto next = receive_bytes(socket);
  ASSERT_TRUE(next);
  EXPECT_NEAR(decoded<WrenchResponse>(*next).bodies[0].force[2],
              0.5 * decoded<WrenchResponse>(*first).bodies[0].force[2], 1e-6);
}

TEST(Reload, KeepsOldSceneIfNewOneIsInvalid) {
  RunningService service({}, kBefore);
  RawLcmSocket socket;
  EXPECT_NEAR(vertical_force(socket, 1), kForceBefore, 1e-6);
  reload(service, "[[body]]\nid = ", "reload failed");
  EXPECT_TRUE(contains(service.log(), "scene.toml:2"));
  EXPECT_NEAR(vertical_force(socket, 2), kForceBefore, 1e-6);
  std::string deep = "a";  // toml++ would overflow the stack
  for (int i = 0; i < 50'000; ++i) deep += ".a";
  reload(service, kBefore + deep + " = 1\n", "more than 32 levels of tables and arrays");
  EXPECT_NEAR(vertical_force(socket, 3), kForceBefore, 1e-6);
  reload(service, "[[body]]\nid = 1\nmesh = \"gone.stl\"\n", "gone.stl");
  EXPECT_NEAR(vertical_force(socket, 4), kForceBefore, 1e-6);
  reload(service, box_scene(500.0, 4.0), "reloaded:");
  EXPECT_NEAR(vertical_force(socket, 5), 0.5 * kForceBefore, 1e-6);
  EXPECT_EQ(lines_with("reload failed", service.log()), 3U) << service.log();
}

TEST(Reload, LosesNoResponseOfSteadyStream) {
  RunningService service({}, kBefore);
  RawLcmSocket socket;
  constexpr std::int64_t kRequests = 4000;
  std::size_t reloads = 0;
  for (std::int64_t seq = 0; seq < kRequests; ++seq) {
    if (seq % 100 == 50) {
      service.write("scene.toml", box_scene(++reloads % 2 == 0 ? 1000.0 : 500.0, 4.0));
      service.child().send_signal(SIGHUP);
    }
    const double force = vertical_force(socket, seq);
    ASSERT_TRUE(std::abs(force - kForceBefore) < 1e-6 || std::abs(force - 0.5 * kForceBefore) < 1e-6)
        << force;
  }
  EXPECT_TRUE(service.child().wait_for_text("reloaded:", kWaitTimeout)) << service.log();
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    return status.counters.computed == kRequests && status.counters.retries == 0 &&
           status.counters.sessions == 1;
  }));
  expect_clean_exit(service);
}

TEST(Reload, UsesOldSceneWhileLoadingAndQueuesOneReload) {
  RunningService service({"--log-level", "debug"}, kBefore);
  RawLcmSocket socket;
  service.write("tetrahedron.obj", tetrahedron::obj());
  service.write("scene.toml", "[[body]]\nid = 1\nmesh = \"tetrahedron.obj\"\n");
  LeasedFile mesh(service.path("tetrahedron.obj"));
  if (!mesh.held()) GTEST_SKIP() << no_lease_on(service.path(""));
  service.child().send_signal(SIGHUP);
  std::int64_t seq = 0;
  ASSERT_TRUE(request_until(socket, seq, kHalfSubmerged, [&mesh](double) { return mesh.awaited(); }))
      << service.log();
  for (const std::int64_t end = seq + 100; seq < end; ++seq) {
    ASSERT_NEAR(vertical_force(socket, seq), kForceBefore, 1e-6);
  }
  // The scene that names the mesh has been read, the mesh has not.
  service.write("scene.toml", box_scene(500.0, 4.0));
  for (int again = 0; again < 3; ++again) {
    service.child().send_signal(SIGHUP);
    EXPECT_NEAR(vertical_force(socket, seq++), kForceBefore, 1e-6);
  }
  ASSERT_TRUE(service.child().wait_for_text("in progress; queued", kWaitTimeout)) << service.log();
  EXPECT_FALSE(contains(service.log(), "reloaded:"));
  // The service has looked at its signals, the third SIGHUP among them, when it answers once more.
  EXPECT_NEAR(vertical_force(socket, seq++), kForceBefore, 1e-6);
  mesh.release();
  EXPECT_TRUE(request_until(socket, seq, kHalfSubmerged,
                            [](double force) { return std::abs(force - 0.5 * kForceBefore) < 1e-6; }))
      << "the scene file as of the last SIGHUP: " << service.log();
  expect_clean_exit(service);
  EXPECT_LE(lines_with("reloaded:", service.log()), 2U) << "one load for the three requests during the first";
}

TEST(Reload, LetsServiceExitDuringLoad) {
  RunningService service({}, kBefore);
  LeasedFile scene(service.path("scene.toml"));
  if (!scene.held()) GTEST_SKIP() << no_lease_on(service.path("scene.toml"));
  service.child().send_signal(SIGHUP);
  ASSERT_TRUE(service.child().wait_for_text("SIGHUP: reloading", kWaitTimeout)) << service.log();
  expect_clean_exit(service);
  EXPECT_TRUE(contains(service.log(), "received SIGTERM"));
}

TEST(Reload, ImportsMeshesWhileWorkerThreadsRun) {
  RunningService service({"--threads", "2"}, kBefore);
  RawLcmSocket socket;
  service.write("tetrahedron.obj", tetrahedron::obj());
  std::int64_t seq = 0;
  for (const double scale : {2.0, 4.0}) {
    service.write("scene.toml",
                  "[world]\ngravity = 10.0\n[water]\ndensity = 1000.0\n[[body]]\nid = 1\nmesh = "
                  "\"tetrahedron.obj\"\nscale = " +
                      std::to_string(scale) + "\n");
    const std::size_t before = lines_with("reloaded:", service.log());
    service.child().send_signal(SIGHUP);
    EXPECT_TRUE(request_until(socket, seq, kSubmerged, [&service, before](double) {
      return lines_with("reloaded:", service.log()) > before;
    }));
    EXPECT_NEAR(vertical_force(socket, seq++, kSubmerged), 1e4 * scale * scale * scale / 6, 1e-6)
        << service.log();
  }
  expect_clean_exit(service);
}

}  // namespace
}  // namespace buoyancy
