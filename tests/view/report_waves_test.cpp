// The page of buoyancy-report for a run in waves, in a real browser.
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "engine/sea_timeline.h"
#include "messages/request.h"
#include "messages/sea_state.h"
#include "tests/support/recorded_log.h"
#include "tests/support/scene_of.h"
#include "tests/view/report_page_test.h"
#include "tests/view/waves_on_page.h"

namespace buoyancy::view {
namespace {

// A wave that is long beside the box, towards +x. Its crest is at the box at kTodayUtime.
const std::string kLongWave = R"(
[water]
time_origin = 1790000000123456
[[water.waves]]
type = "regular"
height = 1.0
period = 8.0
)";

class ReportPageInWaves : public ReportPageTest {
 protected:
  // Opens the page of a run in which the box has a row every 5 s.
  void open(const std::string& scene, double x, double y, double z) {
    std::string run = "utime,body_id,px,py,pz,qw,qx,qy,qz,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz\n";
    for (int second = 0; second <= 100; second += 5) {
      run += std::to_string(kTodayUtime + 1'000'000LL * second) + ",1," + std::to_string(x) + "," +
             std::to_string(y) + "," + std::to_string(z) + ",1,0,0,0,0,0,0,1e5,0,0,0,12,0,0,-1\n";
    }
    open_run(directory_.write("waves.toml", scene), directory_.write("run.csv", run));
  }

  static void go_to(std::int64_t utime) {
    browser().run("buoyancy_report.seek(arguments[0])", 1e-6 * static_cast<double>(utime - kTodayUtime));
  }
};

TEST_F(ReportPageInWaves, DrawsSurfaceOfSea) {
  for (const NamedWater& water : kSeasOfPages) {
    SCOPED_TRACE(water.name);
    const Scene scene = scene_of(water.table + kBox);
    ASSERT_NO_FATAL_FAILURE(open(water.table + kBox, kBodiesAt[0], kBodiesAt[1], 1.5));
    SeaSnapshot sea(*scene.sea());
    for (const std::int64_t utime : kShownUtimes) {
      SCOPED_TRACE(utime);
      sea.set_time(utime);
      go_to(utime);
      expect_page_draws(browser(), "buoyancy_report.scene", sea);
    }
    EXPECT_EQ(browser().console_errors(), std::vector<std::string>{});
  }
}

TEST_F(ReportPageInWaves, DrawsEachReceivedSeaWhileItHolds) {
  const std::string received = "[water]\nlevel = 0.5\nwaves = \"received\"\n" + kCurrentOfPages + kBox;
  RecordedLog log;
  std::vector<SeaState> seas;
  for (const NamedWater& water : kSeasOfPages) {
    seas.push_back(to_sea_state(*scene_of(water.table + kBox).sea(), 7));
    seas.back().utime = kTodayUtime + 10'000'000LL * static_cast<std::int64_t>(seas.size());
  }
  for (std::int64_t second = 0; second <= 40; ++second) {
    const std::int64_t utime = kTodayUtime + 1'000'000 * second;
    for (const SeaState& sea : seas) {
      if (sea.utime == utime) log.add(utime, kSeaChannel, encoded(sea));
    }
    WrenchRequest request;
    request.id = {.utime = utime, .session_id = 1, .seq = second};
    request.bodies = {{.body_id = 1,
                       .position = {kBodiesAt[0], kBodiesAt[1], 1.5},
                       .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0}}};
    log.add(utime, kStatesChannel, encoded(request));
  }
  ASSERT_NO_FATAL_FAILURE(
      open_run(directory_.write("waves.toml", received), directory_.write("run.lcmlog", log.text())));

  go_to(kTodayUtime + 5'000'000);
  EXPECT_EQ(browser().run("const { scene } = buoyancy_report; return [scene.waves, scene.water.visible];"),
            nlohmann::json({nullptr, true}))
      << "no sea yet";
  const Water water = scene_of(received).water();
  for (const std::int64_t seconds : {12, 29, 10, 20}) {
    SCOPED_TRACE(seconds);
    const Expected<Sea> sea = to_sea(seas[seconds < 20 ? 0 : 1], water, scene_of(received).current_W());
    ASSERT_TRUE(sea) << sea.error().message();
    SeaSnapshot snapshot(*sea);
    snapshot.set_time(kTodayUtime + 1'000'000 * seconds);
    go_to(kTodayUtime + 1'000'000 * seconds);
    expect_page_draws(browser(), "buoyancy_report.scene", snapshot);
  }
}

TEST_F(ReportPageInWaves, DrawsTheSurfaceOfGridsAtEachRow) {
  const Scene scene = scene_of(kSeaOnGrids);
  RecordedLog log;
  SeaTimeline timeline(scene);
  std::vector<ByteVector> grids;
  for (std::int64_t second = 0; second <= 12; ++second) {
    const std::int64_t utime = kTodayUtime + 1'000'000 * second;
    SeaGridHeader header = grid_of_pages();
    header.utime = utime + 300'000;
    grids.push_back(
        waves_on_grid(header, 0.2 + 0.01 * static_cast<double>(second), static_cast<double>(second)));
    log.add(utime, kSeaGridChannel, grids.back());
    WrenchRequest request;
    request.id = {.utime = utime, .session_id = 1, .seq = second};
    request.bodies = {{.body_id = 1,
                       .position = {kBodiesAt[0], kBodiesAt[1], 1.5},
                       .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0}}};
    log.add(utime + 1, kStatesChannel, encoded(request));
  }
  ASSERT_NO_FATAL_FAILURE(
      open_run(directory_.write("grid.toml", kSeaOnGrids), directory_.write("run.lcmlog", log.text())));
  go_to(kTodayUtime + 500'000);
  EXPECT_EQ(browser().run("return buoyancy_report.scene.water.visible;"), nlohmann::json(true))
      << "the first request comes before the first grid";
  for (const ByteVector& grid : grids) ASSERT_TRUE(timeline.receive(grid, scene));
  for (const std::int64_t second : {3, 11, 1}) {
    SCOPED_TRACE(second);
    const std::int64_t utime = kTodayUtime + 1'000'000 * second;
    go_to(utime + 200'000);
    expect_page_draws(browser(), "buoyancy_report.scene", SeaSnapshot(*(**timeline.at(utime)).sea, utime));
  }
  EXPECT_EQ(browser().console_errors(), std::vector<std::string>{});
}

TEST_F(ReportPageInWaves, DrawsWaterlineWhereSurfaceMeetsHull) {
  ASSERT_NO_FATAL_FAILURE(open(kLongWave + kBox, 0.0, 0.0, 0.0));
  const Scene scene = scene_of(kLongWave + kBox);
  SeaSnapshot sea(*scene.sea());
  for (const double seconds : {0.0, 4.0}) {  // crest and trough
    const std::int64_t utime = kTodayUtime + static_cast<std::int64_t>(1e6 * seconds);
    sea.set_time(utime);
    go_to(utime);
    const Image image = browser().screenshot();
    // The face at y = -1.5 is towards the camera.
    for (const double x : {-0.7, 0.1, 0.8}) {
      const double elevation = sea.elevation(x, -1.5);
      EXPECT_GT(std::abs(elevation), 0.45);
      EXPECT_TRUE(waterline_at(image, x, -1.5, elevation)) << seconds << " s, x = " << x;
      EXPECT_FALSE(waterline_at(image, x, -1.5, 0.0)) << seconds << " s, x = " << x;
    }
  }
}

TEST_F(ReportPageInWaves, DrawsPlaneOfWaterAtRest) {
  ASSERT_NO_FATAL_FAILURE(open(kBox, 0.0, 0.0, 0.0));
  EXPECT_EQ(browser().run("const { data, scene } = buoyancy_report;"
                          "return ['sea' in data.model, data.columns.includes('sea_time'), scene.waves,"
                          "        scene.water.visible, buoyancyPage.surfaceHeight(3, 4)];"),
            nlohmann::json({false, false, nullptr, true, 0}));
}

}  // namespace
}  // namespace buoyancy::view
