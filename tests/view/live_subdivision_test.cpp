// Compartments and tanks in the live page, in a real browser, with buoyancy-view as it listens on the bus.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/support/byte_vector.h"
#include "tests/support/contains.h"
#include "tests/view/page_test.h"
#include "tests/view/running_view.h"
#include "tests/view/subdivided_hull.h"

namespace buoyancy::view {
namespace {

class LivePageOfTanks : public PageTest {
 protected:
  void open(const std::string& scene) {
    view_ = std::make_unique<RunningView>(scene, std::vector<std::string>{"--pose", "POSE=1"});
    browser().open(view_->url());
    browser().wait_until("window.buoyancyView && buoyancyView.snapshots > 1");
    RawLcmSocket socket;
    socket.send("POSE", encoded_by_lcm(upright_pose(0.25, 1)));
    browser().wait_until("buoyancyView.scene.bodies.get(1).group.visible");
  }

  std::unique_ptr<RunningView> view_;
};

TEST_F(LivePageOfTanks, DrawsLiquidsAndListsThem) {
  ASSERT_NO_FATAL_FAILURE(open(subdivided_hull()));
  browser().wait_until("buoyancyView.scene.bodies.get(1).group.inside.tanks[0].level !== undefined");
  EXPECT_NEAR(
      browser().run("return buoyancyView.scene.bodies.get(1).group.inside.tanks[0].level;").get<double>(),
      0.0, 1e-6)
      << "half full";
  browser().wait_until("document.getElementById('body_facts').textContent.includes('ring')");
  const nlohmann::json rows = browser().run(
      "return Array.from(document.querySelectorAll('#body_facts .scroll:nth-of-type(2) tbody tr')).map((row) "
      "=> Array.from(row.cells).map((cell) => cell.textContent));");
  EXPECT_EQ(rows[0],
            nlohmann::json({"engine room", "compartment", "2", "permeability 0.85", "25", "–", "–"}));
  EXPECT_EQ(rows[2], nlohmann::json({"wide", "tank", "12", "1,000 kg/m³", "–", "6", "50"}));
  EXPECT_TRUE(contains(text_of("#legend"), "liquid in a tank"));
}

TEST_F(LivePageOfTanks, ShowsConditionsReceivedOnBus) {
  ASSERT_NO_FATAL_FAILURE(open(subdivided_hull()));
  RawLcmSocket socket;
  const auto send = [&socket](double liquid_volume) {
    socket.send(std::string(kConditionChannel), encoded(ConditionChange{.utime = 10,
                                                                        .body_id = 1,
                                                                        .kind = ConditionKind::kTank,
                                                                        .index = 0,
                                                                        .liquid_volume = liquid_volume}));
  };
  const std::string level = "buoyancyView.scene.bodies.get(1).group.inside.tanks[0].level";
  send(9.0);
  socket.send("POSE", encoded_by_lcm(upright_pose(0.25, 9)));
  browser().wait_until("buoyancyView.last.bodies[0].condition !== undefined");
  EXPECT_NEAR(browser().run("return buoyancyView.last.bodies[0].condition.liquid_volumes[0];").get<double>(),
              6.0, 1e-9)
      << "before its time";
  socket.send("POSE", encoded_by_lcm(upright_pose(0.25, 10)));
  browser().wait_until("Math.abs(" + level + " - 0.5) < 1e-6");
  browser().wait_until("document.getElementById('body_facts').textContent.includes('975')");  // m^3, %
  send(99.0);
  socket.send("POSE", encoded_by_lcm(upright_pose(0.25, 11)));
  browser().wait_until("buoyancyView.last.bodies[0].condition === null");
  browser().wait_until("buoyancyView.last.counts.conditions_rejected === 1");
}

TEST_F(LivePageOfTanks, AddsNothingToPageOfOtherScenes) {
  ASSERT_NO_FATAL_FAILURE(open(kOneBoxScene));
  const auto script =
      browser().run("return fetch('page.js').then((response) => response.text());").get<std::string>();
  EXPECT_TRUE(contains(script, "class WaterScene"));
  for (const char* word : {"subdivision", "Subdivision", "show_observed_condition"}) {
    EXPECT_FALSE(contains(script, word));
  }
  EXPECT_EQ(browser().run("return buoyancyView.scene.bodies.get(1).drawn.material.transparent;"), false);
}

}  // namespace
}  // namespace buoyancy::view
