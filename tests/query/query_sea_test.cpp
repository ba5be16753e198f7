#include "query/query_sea.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026

QuerySea sea_of(const std::string& text) {
  return QuerySea::parse(text, "sea", {}).value();
}

std::string error_of(const std::string& text) {
  const auto sea = QuerySea::parse(text, "sea", {});
  return sea ? "" : sea.error().message();
}

const std::string kWaves =
    "[world]\nup = [0, 1, 0]\n[water]\nlevel = 2.0\ndepth = 30\nramp = 10\ntime_origin = 1790000000000000\n"
    "waves = { type = \"jonswap\", significant_wave_height = 1.5, peak_period = 5.0, frequencies = 40, seed "
    "= 3 }\n";

TEST(QuerySea, ReadsTheKeysOfASceneFile) {
  const QuerySea sea = sea_of(kWaves);
  EXPECT_EQ(sea.water().level, 2.0);
  EXPECT_EQ(sea.water().up_W, Vec3::UnitY());
  ASSERT_NE(sea.waves(), nullptr);
  EXPECT_EQ(sea.waves()->depth(), 30.0);
  EXPECT_EQ(sea_of("").waves(), nullptr);
  EXPECT_EQ(sea_of("[water]\nwaves = { type = \"regular\", height = 0.0, period = 3 }").waves(), nullptr);
}

TEST(QuerySea, SaysWhatIsWrongWithItsKeys) {
  EXPECT_THAT(error_of("[water]\nlevl = 1"), HasSubstr("level"));
  EXPECT_THAT(error_of("[water]\nwaves = \"received\""), HasSubstr("received"));
  EXPECT_THAT(error_of("[[body]]\nid = 1"), HasSubstr("body"));
  EXPECT_THAT(error_of("water = "), HasSubstr("TOML"));
  EXPECT_THAT(error_of("[water]\ndepth = 1\nwaves = { type = \"regular\", height = 9, period = 3 }"),
              HasSubstr("sea: [water]"));
}

TEST(QuerySea, LayersPressAndProfilesCarryAtTheirHeights) {
  const std::vector<double> points{0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 0.0, 0.0, -3.0, 1.0, 2.0, -6.0};
  const QuerySea sea = sea_of(
      "[world]\ngravity = 10\n[water]\nlevel = 1\ndensity = 850\n[[water.layer]]\nbelow = -1\ndensity = "
      "1000\n[[water.layer]]\nbelow = -5\ndensity = 1020\n[[water.current.profile]]\nheight = 0\nvelocity = "
      "[1, 0, 0]\n[[water.current.profile]]\nheight = -8\nvelocity = [0, 1, 0]\n");
  std::vector<double> pressures(4);
  std::vector<double> velocities(12);
  water_at_points(sea, points, std::vector<std::int64_t>{kNow}, {pressures, velocities, {}});
  EXPECT_EQ(pressures, (std::vector<double>{0.0, 8500.0, 17000.0 + 20000.0, 17000.0 + 40000.0 + 10200.0}));
  EXPECT_EQ(velocities,
            (std::vector<double>{1.0, 0.0, 0.0, 0.875, 0.125, 0.0, 0.5, 0.5, 0.0, 0.125, 0.875, 0.0}));
}

TEST(QuerySea, WaterMovesWithTheCurrentToo) {
  const std::vector<double> point{1.0, 2.0, -0.5};
  for (const std::string& waves :
       {std::string(), std::string("waves = { type = \"regular\", height = 0.4, period = 3 "
                                   "}\n")}) {
    const QuerySea sea = sea_of("[water]\n" + waves + "[water.current]\nvelocity = [1, -2, 0.5]\n");
    std::vector<double> velocity(3);
    water_at_points(sea, point, std::vector<std::int64_t>{kNow}, {{}, velocity, {}});
    Vec3 expected(1.0, -2.0, 0.5);
    if (sea.waves() != nullptr) {
      expected += SeaSnapshot(*sea.waves(), kNow).at({1.0, 2.0, -0.5}).velocity_W;
    }
    for (int i = 0; i < 3; ++i) EXPECT_EQ(velocity[static_cast<std::size_t>(i)], expected[i]);
  }
}

TEST(QuerySea, HasTheWaterOfASnapshotAtEveryPoint) {
  const QuerySea sea = sea_of(kWaves);
  constexpr std::size_t kPoints = 3000;
  std::vector<double> x1(kPoints), x2(kPoints), points(3 * kPoints);
  std::vector<std::int64_t> utimes(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto n = static_cast<double>(i);
    x1[i] = 0.37 * n - 400.0;
    x2[i] = 300.0 - 0.11 * n;
    points[3 * i] = x1[i];
    points[3 * i + 1] = 3.0 - 0.01 * n;
    points[3 * i + 2] = x2[i];
    utimes[i] = kNow + static_cast<std::int64_t>(i / 100) * 700'001;
  }
  for (const unsigned threads : {1U, 0U}) {
    std::vector<double> elevations(kPoints), pressures(kPoints), velocities(3 * kPoints),
        accelerations(3 * kPoints);
    sea_elevations(sea, x1, x2, utimes, elevations, threads);
    water_at_points(sea, points, utimes, {pressures, velocities, accelerations}, threads);
    SeaSnapshot snapshot(*sea.waves());
    for (std::size_t i = 0; i < kPoints; ++i) {
      snapshot.set_time(utimes[i]);
      EXPECT_EQ(elevations[i], snapshot.amplitude_factor() > 0.0 ? snapshot.elevation(x1[i], x2[i]) : 0.0);
      const WaterAtPoint expected = snapshot.at({points[3 * i], points[3 * i + 1], points[3 * i + 2]});
      EXPECT_EQ(pressures[i], expected.pressure);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        EXPECT_EQ(velocities[3 * i + k], expected.velocity_W[axis]);
        EXPECT_EQ(accelerations[3 * i + k], expected.acceleration_W[axis]);
      }
    }
  }
}

TEST(QuerySea, IsFlatWithoutWaves) {
  const QuerySea sea =
      sea_of("[world]\nup = [0, -3, 4]\ngravity = 5\n[water]\nlevel = 1.5\ndensity = 1000\n");
  const std::vector<double> x{0.0, 5.0, 7.0};
  std::vector<double> elevations(3, 9.0), pressures(3), velocities(9, 9.0), accelerations(9, 9.0);
  const std::vector<std::int64_t> now{kNow};
  sea_elevations(sea, x, x, now, elevations);
  EXPECT_EQ(elevations, std::vector(3, 0.0));
  // 2.5 m below the surface, 0.5 m below it and above it.
  water_at_points(sea, std::vector<double>{9, 3, 1, -9, -3, -1, 4, 2, 4}, now,
                  {pressures, velocities, accelerations});
  const std::vector<double> depths{2.5, 0.5, 0.0};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(pressures[i], depths[i] * 1000.0 * 5.0, 1e-9);
  EXPECT_EQ(velocities, std::vector<double>(9, 0.0));
  EXPECT_EQ(accelerations, std::vector<double>(9, 0.0));
}

}  // namespace
}  // namespace buoyancy
