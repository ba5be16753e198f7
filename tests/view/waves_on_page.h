// Seas for tests of pages in waves, and the comparison of the surface that a page draws with that of the sea.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/grid_bytes.h"
#include "tests/view/browser.h"
#include "waves/sea_snapshot.h"

namespace buoyancy::view {

inline constexpr std::int64_t kTodayUtime = 1'790'000'000'123'456;  // [us], in 2026

struct NamedWater {
  const char* name;
  std::string table;  // of a scene file
};

inline const std::string kCurrentOfPages = "[water.current]\nvelocity = [1.2, -0.4, 0.1]\n";
inline const std::array<NamedWater, 2> kSeasOfPages{{{"deep, two systems, phases of 1970", R"(
[water]
level = 1.5
[[water.waves]]
type = "jonswap"
significant_wave_height = 0.8
peak_period = 4.0
direction = 30.0
spreading = 8.0
frequencies = 40
directions = 5
seed = 3
[[water.waves]]
type = "regular"
height = 0.6
period = 11.0
direction = -100.0
phase = 40.0
)" + kCurrentOfPages},
                                                     {"finite depth, ramp", R"(
[water]
level = 1.5
depth = 6.0
time_origin = 1790000000000000
ramp = 30.0
[[water.waves]]
type = "jonswap"
significant_wave_height = 1.2
peak_period = 6.0
direction = 200.0
frequencies = 25
)" + kCurrentOfPages}}};

// Within the ramp, at its end and after it [us].
inline constexpr std::array<std::int64_t, 3> kShownUtimes{kTodayUtime + 12'000'000, kTodayUtime + 29'500'000,
                                                          kTodayUtime + 95'250'000};

// A body of a scene.
inline const std::string kBox = R"(
[[body]]
id = 1
name = "box"
shape = { type = "box", size = [2, 3, 4] }
)";

// Where the bodies of these tests are: kilometres from W's origin.
inline constexpr std::array<double, 2> kBodiesAt{3'200.0, -1'700.0};

inline std::vector<std::array<double, 2>> points_of_surface() {
  std::vector<std::array<double, 2>> points{{0.0, 0.0}, {-2'500.0, 40'000.0}, {1e5, -3e4}};
  for (int i = 0; i < 17; ++i)
    points.push_back({kBodiesAt[0] + 0.37 * i * i - 20.0, kBodiesAt[1] + 7.0 * i - 60.0});
  return points;
}

// Grids for a scene of kSeaOnGrids: periodic, so that they hold everywhere.
inline const std::string kSeaOnGrids = "[water]\nlevel = 0.5\nwaves = \"grid\"\n" + kCurrentOfPages + kBox;
inline SeaGridHeader grid_of_pages() {
  SeaGridHeader header{.utime = kTodayUtime, .instance_id = 5, .origin = {-8.0, 3.0}, .spacing = {0.5, 0.4}};
  header.level = 0.75;
  header.periodic = 1;
  header.rows = 48;
  header.columns = 65;
  return header;
}
inline ByteVector waves_on_grid(const SeaGridHeader& header, double amplitude, double phase) {
  const double k1 = 2.0 * std::numbers::pi / (header.columns * header.spacing[0]);
  const double k2 = 2.0 * std::numbers::pi / (header.rows * header.spacing[1]);
  return grid_bytes(header, [&](double x1, double x2) {
    return amplitude * (std::cos(2.0 * k1 * x1 + phase) + std::sin(k1 * x1 - 3.0 * k2 * x2 + phase));
  });
}

// scene_in_page: the page's WaterScene, an expression. Compares what buoyancyPage.surfaceHeight() returns,
// and where the vertices of the surface are drawn, with the sea at that time.
inline void expect_page_draws(Browser& browser, const std::string& scene_in_page, const SeaSnapshot& sea) {
  constexpr double kTolerance = 1e-3;  // [m]
  const std::vector<std::array<double, 2>> points = points_of_surface();
  const auto heights =
      browser.run("return arguments[0].map(([x, y]) => buoyancyPage.surfaceHeight(x, y));", points)
          .get<std::vector<double>>();
  ASSERT_EQ(heights.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(heights[i], sea.elevation(points[i][0], points[i][1]), kTolerance)
        << "at " << points[i][0] << ", " << points[i][1];
  }

  const auto vertices = browser
                            .run("const { origin, waves } = " + scene_in_page + R"(;
    const { position, water } = waves.surface.geometry.attributes, lines = waves.grid.lines;
    waves.surface.updateMatrixWorld();
    const vertices = [];
    for (let n = 0; n < lines; n += 1) {
      for (let m = 0; m < lines; m += 1) {
        const at = n * lines + m;
        const vertex = waves.surface.localToWorld(new THREE.Vector3(position.getX(at), position.getY(at), water.getX(at)));
        if (Math.max(Math.abs(position.getX(at)), Math.abs(position.getY(at))) < 3) vertices.push(vertex.toArray().map((x, i) => x + origin[i]));
      }
    }
    return vertices;)")
                            .get<std::vector<std::array<double, 3>>>();
  ASSERT_GT(vertices.size(), 20U);
  for (const auto& [x, y, z] : vertices) {
    ASSERT_NEAR(z - sea.sea().water().level, sea.elevation(x, y), kTolerance)
        << "drawn at " << x << ", " << y;
  }
}

}  // namespace buoyancy::view
