// The live page in a real browser, with the real programs over UDP.
#include <csignal>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "messages/request.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/support/build_paths.h"
#include "tests/view/page_test.h"
#include "tests/view/running_view.h"

namespace buoyancy::view {
namespace {

// A box of half the default density of water, 1025 kg/m^3, which floats in equilibrium and therefore looks
// the same at every step, and a second box without [body.client].
const std::string kScene = R"(
[[body]]
id = 1
name = "floating box"
shape = { type = "box", size = [1, 1, 1] }
outputs = ["wrench", "hydrostatics"]
[body.client]
density = 512.5
position = [0, 0, 0]
[[body]]
id = 2
name = "second box"
shape = { type = "box", size = [1, 1, 1] }
)";

// Channels of the second box.
const std::vector<std::string> kPoseChannels{"--pose", "POSE=2", "--force-torque", "FORCE=2"};

class LivePage : public PageTest {
 protected:
  void SetUp() override {
    PageTest::SetUp();
    service_ = std::make_unique<RunningService>(kPoseChannels, kScene);
    view_ = std::make_unique<RunningView>(kScene, kPoseChannels);
    client_ = std::make_unique<ChildProcess>(
        command_of({built_program("buoyancy-client"), "--scene", service_->path("scene.toml"), "--rate",
                    "200", "--duration", "1000", "--retries", "100000"}));
    browser().open(view_->url());
  }
  static void wait_for_snapshots(int snapshots = 3) {
    browser().run("window.target = buoyancyView.snapshots + arguments[0];", snapshots);
    browser().wait_until("buoyancyView.snapshots >= window.target");
  }

  std::unique_ptr<RunningService> service_;
  std::unique_ptr<RunningView> view_;
  std::unique_ptr<ChildProcess> client_;
};

TEST_F(LivePage, ShowsRunWithoutConsoleErrors) {
  browser().wait_until(
      "window.buoyancyView && buoyancyView.state === 'answering' && buoyancyView.renders > 3");
  browser().wait_until("buoyancyView.history.some((second) => second.p50 > 0)");
  browser().wait_until("document.querySelector('#strip').textContent.includes('lockstep')");
  browser().wait_until("document.querySelectorAll('#plots path').length >= 4");
  EXPECT_GT(browser().run("return buoyancyView.last.bodies[0].f[2];").get<double>(), 0.0);
  browser().press(" ");
  EXPECT_NEAR(browser().run("return buoyancyView.scene.bodies.get(1).group.position.z;").get<double>(), 0.0,
              1e-6)
      << "half submerged";
  const Image image = browser().screenshot();
  const Region canvas = browser().region_of("#canvas");
  const auto amber = [](const Colour& colour) {
    return colour.red > colour.green + 20 && colour.red > colour.blue + 60;
  };
  EXPECT_GT(image.share(canvas, amber), 0.01) << "dry part of the box";
  const auto dark_blue = [](const Colour& colour) {
    return colour.blue > colour.red + 80 && colour.red < 90;
  };
  EXPECT_GT(image.share(canvas, dark_blue), 0.01) << "wetted part of the box";
  EXPECT_GT(image.share(canvas, is_near({255, 255, 255}, 4)), 0.0005) << "waterline";
  EXPECT_TRUE(is_near({234, 243, 250}, 4)(image.pixel(canvas.left + 6, canvas.top + 6))) << "sky";
  const Colour water = image.pixel(canvas.left + 6, canvas.top + canvas.height - 6);
  EXPECT_GT(water.blue, water.red + 50) << "water";
}

TEST_F(LivePage, ShowsServiceOfflineAndBack) {
  browser().wait_until("window.buoyancyView && buoyancyView.state === 'answering'");
  service_->child().send_signal(SIGKILL);
  browser().wait_until("buoyancyView.state === 'offline'");
  browser().wait_until("document.getElementById('state_text').textContent === 'The service is offline'");
  browser().wait_until(
      "document.getElementById('notices').textContent.includes('No message from the service')");
  service_ = std::make_unique<RunningService>(std::vector<std::string>{}, kScene);
  browser().wait_until("buoyancyView.state === 'answering'");
  browser().wait_until(
      "!document.getElementById('notices').textContent.includes('No message from the service')");
}

TEST_F(LivePage, ShowsServiceOfflineWhilePaused) {
  browser().wait_until(
      "window.buoyancyView && buoyancyView.state === 'answering' && buoyancyView.renders > 3");
  browser().press(" ");
  const nlohmann::json renders = browser().run("return buoyancyView.renders;");
  service_->child().send_signal(SIGKILL);
  browser().wait_until("document.getElementById('state_text').textContent === 'The service is offline'");
  browser().wait_until(
      "document.getElementById('notices').textContent.includes('No message from the service')");
  EXPECT_EQ(browser().run("return [buoyancyView.paused, buoyancyView.renders];"),
            nlohmann::json({true, renders}));
}

TEST_F(LivePage, ShowsNoForceWithoutResponse) {
  browser().wait_until(
      "window.buoyancyView && buoyancyView.state === 'answering' && buoyancyView.renders > 1");
  service_->child().send_signal(SIGKILL);
  browser().wait_until("buoyancyView.state === 'offline'");
  browser().press("n");
  RawLcmSocket socket;
  socket.send("POSE", encoded_by_lcm(upright_pose(0.25, 1)));
  const std::string facts = "document.getElementById('body_facts').textContent";
  browser().wait_until(facts + ".includes('requested, no response yet')");
  browser().wait_until(facts + ".includes('force, N–')");
  wait_for_snapshots(30);
  EXPECT_EQ(browser().run("const body = buoyancyView.scene.bodies.get(2);"
                          "return [body.group.visible, body.markers.force.visible];"),
            nlohmann::json({true, false}));
  EXPECT_EQ(browser().run("return Array.from(document.querySelectorAll('#plots figure')).at(-1).className;"),
            "empty");
}

TEST_F(LivePage, ReconnectsToRestartedView) {
  // Outside the ephemeral range, so that the port is still free when the view restarts.
  constexpr std::uint16_t kPort = 8667;
  may_report_errors_ = true;  // while the view is away
  view_ = std::make_unique<RunningView>(kScene, std::vector<std::string>{}, kPort);
  browser().open(view_->url());
  browser().wait_until("window.buoyancyView && buoyancyView.snapshots > 3");
  view_.reset();
  browser().wait_until("buoyancyView.state === 'connecting'");
  view_ = std::make_unique<RunningView>(kScene, std::vector<std::string>{}, kPort);
  browser().wait_until("buoyancyView.connections >= 2 && buoyancyView.state === 'answering'");
  wait_for_snapshots();
}

TEST_F(LivePage, ShowsBotCorePoseAndForceTorque) {
  browser().wait_until("window.buoyancyView && buoyancyView.renders > 1");
  RawLcmSocket socket;
  socket.send("POSE", encoded_by_lcm(upright_pose(0.25, 1)));
  browser().press("n");
  browser().wait_until(
      "document.getElementById('body_facts').textContent.includes('unknown: force and torque only')");
  const nlohmann::json body = browser().run("return buoyancyView.last.bodies.find((one) => one.id === 2);");
  EXPECT_NEAR(body["f"][2].get<double>(), 0.25 * 1'025.0 * 9.80665, 1.0) << "a quarter of a cubic metre";
  browser().wait_until("buoyancyView.scene.bodies.get(2).markers.force.visible");
  EXPECT_EQ(browser().run("const markers = buoyancyView.scene.bodies.get(2).markers;"
                          "return [markers.centre_of_buoyancy.visible, markers.force.position.z];"),
            nlohmann::json({false, 0.25}))
      << "at the body's origin";
}

TEST_F(LivePage, RespondsToKeys) {
  browser().wait_until("window.buoyancyView && buoyancyView.renders > 1");
  browser().press("n");
  EXPECT_EQ(browser().run("return buoyancyView.selected;"), 2);
  browser().wait_until("document.getElementById('body_facts').textContent.includes('no request yet')");
  browser().press("p");
  EXPECT_EQ(browser().run("return buoyancyView.selected;"), 1);
  browser().press("f");
  EXPECT_EQ(browser().run("return [buoyancyView.following, document.getElementById('follow').checked];"),
            nlohmann::json({true, true}));
  const nlohmann::json azimuth = browser().run("return buoyancyView.scene.azimuth;");
  browser().press("a");
  EXPECT_NE(browser().run("return buoyancyView.scene.azimuth;"), azimuth);
  browser().press(" ");
  EXPECT_EQ(browser().run("return buoyancyView.paused;"), true);
  const nlohmann::json renders = browser().run("return buoyancyView.renders;");
  wait_for_snapshots();
  EXPECT_EQ(browser().run("return buoyancyView.renders;"), renders);
  browser().press(" ");
  browser().wait_until("buoyancyView.renders > " + renders.dump());
}

TEST_F(LivePage, FitsPhoneAndDesktopScreens) {
  for (const Screen& screen : {kPhone, Screen{600, 800, false}, Screen{799, 800, false}, kDesktop}) {
    browser().resize(screen);
    browser().wait_until("window.buoyancyView && buoyancyView.renders > 3");
    browser().wait_until("document.querySelectorAll('#counters table').length === 4");
    EXPECT_LE(browser().run("return document.documentElement.scrollWidth;"), screen.width);
    EXPECT_GT(browser().run("return document.getElementById('canvas').clientHeight;"), 200);
  }
  EXPECT_EQ(
      browser().run("return document.getElementById('pause').getBoundingClientRect().bottom <= innerHeight;"),
      true)
      << "3D view and controls fit a desktop screen";
}

}  // namespace
}  // namespace buoyancy::view
