#include "view/common/sea_json.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages/request.h"
#include "recording/event_log.h"
#include "tests/support/byte_vector.h"
#include "tests/support/json.h"
#include "tests/support/recorded_log.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"
#include "view/common/scene_model.h"
#include "view/report/run_file.h"

namespace buoyancy::view {
namespace {

const std::string kBox = R"(
[[body]]
id = 1
shape = { type = "box", size = [2, 3, 4] }
)";
const std::string kWaves = R"(
[water]
level = 0.1
depth = 7.3
time_origin = -5
ramp = 2.5
wave_pressure = "hydrostatic"
[[water.waves]]
type = "jonswap"
significant_wave_height = 0.5
peak_period = 3.1
direction = 17.0
spreading = 4.0
)";

TEST(SeaJson, KeepsEveryNumberOfSea) {
  const Scene scene = scene_of("[world]\nup = [0, 1, 0]\n" + kWaves + kBox);
  const Sea& sea = *scene.sea();
  const auto json = parse_json(scene_model(scene).dump())["sea"];
  const auto vector = [&json](const char* name) {
    const auto numbers = json[name].get<std::array<double, 3>>();
    return Vec3(numbers[0], numbers[1], numbers[2]);
  };
  EXPECT_EQ(vector("e1"), sea.axes().e1_W);
  EXPECT_EQ(vector("e2"), sea.axes().e2_W);
  EXPECT_EQ(vector("up"), Vec3::UnitY());
  EXPECT_EQ(json["level"], 0.1);
  EXPECT_EQ(json["depth"], 7.3);
  EXPECT_EQ(json["time_origin"], -5);
  EXPECT_EQ(json["ramp"], 2.5);
  EXPECT_EQ(json["pressure"], "hydrostatic");
  const PreparedComponents& components = sea.prepared();
  EXPECT_EQ(components.size(), 200U);
  EXPECT_EQ(json["amplitude"].get<std::vector<double>>(), components.amplitude);
  EXPECT_EQ(json["apparent_frequency"].get<std::vector<double>>(), components.apparent_frequency);
  EXPECT_EQ(json["wave_number"].get<std::vector<double>>(), components.wave_number);
  EXPECT_EQ(json["k1"].get<std::vector<double>>(), components.k1);
  EXPECT_EQ(json["k2"].get<std::vector<double>>(), components.k2);
  EXPECT_EQ(json["phase"].get<std::vector<double>>(), components.phase);
}

TEST(SeaJson, HasNoDepthInDeepWaterAndNoSeaAtRest) {
  const std::string deep = "[[water.waves]]\ntype = \"regular\"\nheight = 1\nperiod = 5\n";
  EXPECT_EQ(scene_model(scene_of(deep + kBox))["sea"]["depth"], nullptr);
  EXPECT_FALSE(scene_model(scene_of(kBox)).contains("sea"));
}

TEST(SeaTime, CountsFromTimeOriginForEveryUtime) {
  const auto time = [](std::int64_t time_origin, std::int64_t utime, double lead_time) {
    const Expected<Sea> sea = Sea::make({.time_origin = time_origin, .systems = {}}, {});
    return sea_time(*sea, utime, lead_time);
  };
  EXPECT_EQ(time(1'790'000'000'000'000, 1'790'000'012'250'000, 0.5), 12.75);
  EXPECT_EQ(time(-3, -1'000'005, 0.0), -1.000002);
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  EXPECT_DOUBLE_EQ(time(kMin, kMax, 0.0), 18446744073709.551615);
  EXPECT_DOUBLE_EQ(time(kMax, kMin, 0.0), -18446744073709.551615);
}

TEST(RunFileInWaves, KeepsTimeOfSeaWithLeadTime) {
  const Scene scene = scene_of(kWaves + kBox);
  WrenchRequest request;
  request.id = {.utime = 2'000'000 - 5, .session_id = 1, .seq = 1};
  request.lead_time = 0.25;
  request.bodies = {{.body_id = 1, .position = {}, .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0}}};
  WrenchResponse response;
  response.id = request.id;
  response.bodies = {{.body_id = 1}};
  RecordedLog log;
  log.add(0, kStatesChannel, encoded(request));
  log.add(0, kWrenchesChannel, encoded(response));
  const TempDir directory;
  const auto run = read_run(directory.write("run.lcmlog", log.text()), scene, 10, {});
  ASSERT_TRUE(run) << run.error().message();
  ASSERT_EQ(run->bodies[0].rows.size(), 1U);
  EXPECT_EQ(run->bodies[0].rows[0][kSeaTime], 2.25);
}

}  // namespace
}  // namespace buoyancy::view
