// The plots of loads in the live page, in a real browser, with the real programs over UDP.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages/wire.h"
#include "tests/support/build_paths.h"
#include "tests/support/byte_vector.h"
#include "tests/view/moving_bodies.h"
#include "tests/view/page_test.h"
#include "tests/view/running_view.h"

namespace buoyancy::view {
namespace {

class LivePageOfLoads : public PageTest {
 protected:
  void SetUp() override {
    PageTest::SetUp();
    service_ = std::make_unique<RunningService>(channel_, moving_bodies());
    view_ = std::make_unique<RunningView>(moving_bodies(), channel_);
    client_ = std::make_unique<ChildProcess>(
        command_of({built_program("buoyancy-client"), "--scene", service_->path("scene.toml"), "--rate",
                    "200", "--duration", "1000", "--retries", "100000"}));
    browser().open(view_->url());
  }

  const std::vector<std::string> channel_{"--loads-channel", "LOADS"};
  std::unique_ptr<RunningService> service_;
  std::unique_ptr<RunningView> view_;
  std::unique_ptr<ChildProcess> client_;
};

TEST_F(LivePageOfLoads, StacksLoadsThatServicePublishes) {
  browser().wait_until(
      "window.buoyancyView && buoyancyView.load_plots.stack.series.length === 5 &&"
      "buoyancyView.load_plots.stack.series[0].values.filter(Number.isFinite).length > 10");
  // The latest point of the plot and the snapshot that it came from.
  const nlohmann::json shown = browser().run(R"(
    buoyancyView.select(1);
    const { last, load_plots, model } = buoyancyView;
    const at = load_plots.times.length - 1;
    return { parts: load_plots.stack.series.map((one) => [one.name, one.values[at]]), point: load_plots.loads(at),
             immersion: load_plots.immersion.series[0].values[at], mass: model.bodies[0].mass,
             hidden: load_plots.box.hidden };)");
  const nlohmann::json& point = shown["point"];
  const std::vector<std::string> names{"buoyancy", "drag", "added_mass"};
  double sum = 0.0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(shown["parts"][i][1], point[names[i]][2]) << names[i];
    sum += point[names[i]][2].get<double>();
  }
  EXPECT_EQ(shown["parts"][3][1], -1200.0 * kGravity) << "weight";
  EXPECT_NEAR(shown["parts"][4][1].get<double>(), sum - 1200.0 * kGravity, 1e-9);
  EXPECT_EQ(shown["immersion"].get<double>(), 100.0 * point["immersion"].get<double>());
  EXPECT_EQ(shown["hidden"], false);
  EXPECT_EQ(point["water_velocity"], nlohmann::json({0.5, -0.25, 0.125}));

  // Wrench and loads are two messages; a snapshot taken between them has those of different steps.
  browser().wait_until(R"((() => {
    const body = buoyancyView.last.bodies.find((one) => one.id === 1);
    const { buoyancy, drag, added_mass } = body.loads;
    return [...body.f, ...body.t].every(
        (one, i) => Math.abs(buoyancy[i] + drag[i] + added_mass[i] - one) <= 0.01);
  })())");
  browser().wait_until("document.getElementById('body_facts').textContent.includes('velocity of the water')");
  browser().wait_until("buoyancyView.scene.bodies.get(1).markers.water_velocity.visible");
}

TEST_F(LivePageOfLoads, ChangesNothingForHostileLoads) {
  browser().wait_until(
      "window.buoyancyView && buoyancyView.last && buoyancyView.last.bodies.some((one) => one.loads)");
  client_.reset();
  // A page that lags behind still gets snapshots of the run.
  browser().wait_until("buoyancyView.last.service === 'idle'");
  const std::string loads = "return buoyancyView.last.bodies.find((one) => one.id === 1).loads;";
  const nlohmann::json before = browser().run(loads);
  RawLcmSocket socket;
  ByteVector bytes = encoded(BodiesLoads{.id = {}, .bodies = {BodyLoads{.body_id = 1, .immersion = 0.5}}});
  bytes.pop_back();
  socket.send("LOADS", bytes);
  bytes.assign(bytes.size(), 0xff);
  socket.send("LOADS", bytes);
  socket.send("LOADS", {});
  socket.send("LOADS",
              encoded(BodiesLoads{.id = {}, .bodies = {BodyLoads{.body_id = 77, .immersion = 0.5}}}));
  browser().wait_until(
      "Object.values(buoyancyView.last.counts.malformed).reduce((sum, count) => sum + count) === 3");
  EXPECT_EQ(browser().run(loads), before);
}

TEST_F(LivePageOfLoads, HidesLoadsOfOtherBodies) {
  browser().wait_until("window.buoyancyView && buoyancyView.load_plots && buoyancyView.last");
  for (const auto& [id, hidden] : {std::pair{1, false}, {2, true}, {3, false}, {4, true}}) {
    EXPECT_EQ(
        browser().run("buoyancyView.select(arguments[0]); return buoyancyView.load_plots.box.hidden;", id),
        hidden)
        << id;
  }
}

}  // namespace
}  // namespace buoyancy::view
