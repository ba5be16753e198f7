// The live page in waves, in a real browser: buoyancy-view receives the requests that a test sends.
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/service/raw_lcm.h"
#include "tests/support/scene_of.h"
#include "tests/view/page_test.h"
#include "tests/view/running_view.h"
#include "tests/view/waves_on_page.h"
#include "view/common/sea_json.h"

namespace buoyancy::view {
namespace {

const std::string kBox = R"(
[[body]]
id = 1
name = "box"
shape = { type = "box", size = [2, 3, 4] }
)";

class LivePageInWaves : public PageTest {
 protected:
  void open(const std::string& scene) {
    view_ = std::make_unique<RunningView>(scene);
    browser().open(view_->url());
    browser().wait_until("window.buoyancyView && buoyancyView.snapshots > 0");
  }
  void TearDown() override {
    PageTest::TearDown();
    view_.reset();
  }

  void send_request(std::int64_t utime, double lead_time) {
    RawStates states;
    states.utime = utime;
    states.session_id = 1;
    states.seq = ++seq_;
    states.lead_time = lead_time;
    states.bodies.resize(1);
    states.bodies[0].position = {kBodiesAt[0], kBodiesAt[1], 1.5};
    socket_.send("BUOYANCY_STATES", encode_states(states));
  }
  // Waits until the picture is that of this time of the sea [s].
  static void wait_for_time(double t) {
    browser().wait_until("Math.abs(buoyancyView.scene.sea_time - " + std::to_string(t) + ") < 1e-5");
  }

  RawLcmSocket socket_;
  std::unique_ptr<RunningView> view_;
  std::int64_t seq_ = 0;
};

TEST_F(LivePageInWaves, DrawsSurfaceOfSea) {
  for (const NamedWater& water : kSeasOfPages) {
    SCOPED_TRACE(water.name);
    const Scene scene = scene_of(water.table + kBox);
    open(water.table + kBox);
    EXPECT_EQ(browser().run("return [buoyancyView.last.sea_time, buoyancyPage.surfaceHeight(3, 4)];"),
              nlohmann::json({nullptr, 0}))
        << "before a request";
    SeaSnapshot sea(*scene.sea());
    for (const std::int64_t utime : kShownUtimes) {
      SCOPED_TRACE(utime);
      constexpr double kLeadTime = 0.125;  // [s]
      sea.set_time(utime, kLeadTime);
      send_request(utime, kLeadTime);
      wait_for_time(sea_time(*scene.sea(), utime, kLeadTime));
      expect_page_draws(browser(), "buoyancyView.scene", sea);
    }
    EXPECT_EQ(browser().console_errors(), std::vector<std::string>{});
  }
}

}  // namespace
}  // namespace buoyancy::view
