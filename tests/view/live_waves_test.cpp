// The live page in waves, in a real browser: buoyancy-view receives the requests that a test sends.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/sea_timeline.h"
#include "messages/sea_state.h"
#include "tests/service/raw_lcm.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"
#include "tests/view/page_test.h"
#include "tests/view/running_view.h"
#include "tests/view/waves_on_page.h"
#include "view/common/sea_json.h"

namespace buoyancy::view {
namespace {

class LivePageInWaves : public PageTest {
 protected:
  void open(const std::string& scene) {
    if (view_ != nullptr) {
      // A page that is still open would report that its server is gone.
      browser().open("about:blank");
      view_.reset();
    }
    view_ = std::make_unique<RunningView>(scene);
    browser().open(view_->url());
    browser().wait_until("window.buoyancyView && buoyancyView.snapshots > 0");
  }

  void send_request(std::int64_t utime, double lead_time) {
    WrenchRequest request;
    request.id = {.utime = utime, .session_id = 1, .seq = ++seq_};
    request.lead_time = lead_time;
    request.bodies = {{.body_id = 1,
                       .position = {kBodiesAt[0], kBodiesAt[1], 1.5},
                       .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0}}};
    socket_.send("BUOYANCY_STATES", encoded(request));
  }
  // Waits until the picture is that of this time of the sea [s].
  static void wait_for_time(double t) {
    browser().wait_until("Math.abs(buoyancyView.scene.sea_time - " + std::to_string(t) + ") < 1e-5");
  }

  void send_sea(SeaState state, std::int64_t utime) {
    state.utime = utime;
    socket_.send(std::string(kSeaChannel), encoded(state));
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

TEST_F(LivePageInWaves, DrawsReceivedSeaThatHolds) {
  const std::string received = "[water]\nlevel = 0.5\nwaves = \"received\"\n" + kCurrentOfPages + kBox;
  const Water water = scene_of(received).water();
  const Scene first = scene_of(kSeasOfPages[0].table + kBox);
  const Scene second = scene_of(kSeasOfPages[1].table + kBox);
  open(received);
  send_request(kTodayUtime, 0.0);
  browser().wait_until("buoyancyView.last.bodies.length === 1");
  EXPECT_EQ(browser().run("return [buoyancyView.last.sea_time, buoyancyView.scene.water.visible];"),
            nlohmann::json({nullptr, true}))
      << "no sea yet";

  const auto expect_drawn = [&](const Sea& sent, std::int64_t utime) {
    SCOPED_TRACE(utime);
    const Expected<Sea> sea = to_sea(to_sea_state(sent, 7), water, scene_of(received).current_W());
    ASSERT_TRUE(sea) << sea.error().message();
    SeaSnapshot snapshot(*sea);
    snapshot.set_time(utime);
    send_request(utime, 0.0);
    wait_for_time(sea_time(*sea, utime, 0.0));
    expect_page_draws(browser(), "buoyancyView.scene", snapshot);
  };
  send_sea(to_sea_state(*first.sea(), 7), kTodayUtime);
  send_sea(to_sea_state(*second.sea(), 7), kTodayUtime + 20'000'000);
  expect_drawn(*first.sea(), kTodayUtime + 19'000'000);
  expect_drawn(*second.sea(), kTodayUtime + 20'000'000);

  SeaState wrong = to_sea_state(*first.sea(), 7);
  wrong.gravity = 1.0;
  send_sea(wrong, kTodayUtime);
  browser().wait_until("buoyancyView.last.counts.seas_rejected === 1");
  expect_drawn(*second.sea(), kTodayUtime + 40'000'000);

  SeaState calm = to_sea_state(*second.sea(), 7);
  for (auto* numbers : {&calm.amplitude, &calm.angular_frequency, &calm.direction, &calm.phase})
    numbers->clear();
  send_sea(calm, kTodayUtime + 50'000'000);
  send_request(kTodayUtime + 50'000'000, 0.0);
  wait_for_time(0.0);
  EXPECT_EQ(browser().run("return [buoyancyPage.surfaceHeight(3, 4), buoyancyView.scene.waves.level];"),
            nlohmann::json({0, 1.0}))
      << "at the level of the message";
}

TEST_F(LivePageInWaves, DrawsSurfaceOfGrids) {
  const Scene scene = scene_of(kSeaOnGrids);
  open(kSeaOnGrids);
  SeaTimeline timeline(scene);
  const auto send_grid = [&](const SeaGridHeader& header, double amplitude, double phase) {
    const ByteVector bytes = waves_on_grid(header, amplitude, phase);
    ASSERT_TRUE(timeline.receive(bytes, scene));
    socket_.send(std::string(kSeaGridChannel), bytes);
  };
  SeaGridHeader header = grid_of_pages();
  send_grid(header, 0.3, 0.2);
  header.utime += 200'000;
  header.level = 0.6;
  send_grid(header, 0.4, 0.9);
  header.utime += 200'000;
  header.columns = 81;  // on another grid
  send_grid(header, 0.2, -1.0);
  for (const std::int64_t after : {0, 50'000, 200'000, 290'000, 400'000}) {
    SCOPED_TRACE(after);
    const std::int64_t utime = kTodayUtime + after;
    const SeaPeriod& period = **timeline.at(utime);
    send_request(utime, 0.0);
    wait_for_time(sea_time(period, utime, 0.0));
    expect_page_draws(browser(), "buoyancyView.scene", SeaSnapshot(*period.sea, utime));
  }
  EXPECT_EQ(browser().console_errors(), std::vector<std::string>{});
}

}  // namespace
}  // namespace buoyancy::view
