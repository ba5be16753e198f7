// The page of buoyancy-hydrostatics --html, in a real browser.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/contains.h"
#include "tests/support/csv.h"
#include "tests/support/temp_dir.h"
#include "tests/view/page_test.h"

namespace buoyancy::view {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

// Beam 20, depth 12, draught 6, KG 8 [m], with B's origin in the middle.
const std::string kShip = R"([[body]]
id = 3
name = "ship"
shape = { type = "box", size = [80, 20, 12], segments = [2, 2, 2] }
[body.client]
density = 512.5
center_of_mass = [0, 0, 2]
)";

// A log that floats with a corner down, at 45 degrees.
const std::string kLog = R"([[body]]
id = 1
name = "log </script>"
shape = { type = "box", size = [8, 1, 1] }
[body.client]
density = 512.5
)";

class HydrostaticsPage : public PageTest {
 protected:
  static void SetUpTestSuite() { directory_ = std::make_unique<TempDir>(); }
  static void TearDownTestSuite() {
    PageTest::TearDownTestSuite();
    directory_.reset();
  }

  static std::string scene(const std::string& text) { return directory_->write("scene.toml", text); }
  static std::string page() { return directory_->path("page.html"); }
  static std::string csv() { return directory_->path("page.csv"); }

  // Writes and opens the page of a command; returns what it printed with --json.
  static nlohmann::json open(const std::string& scene_text, std::vector<std::string> arguments) {
    for (const std::string& argument : {std::string("--scene"), scene(scene_text), std::string("--json"),
                                        std::string("--html"), page(), std::string("--csv"), csv()}) {
      arguments.push_back(argument);
    }
    const FinishedProcess written = run_program("buoyancy-hydrostatics", std::move(arguments));
    EXPECT_EQ(written.exit_code, 0) << written.standard_error;
    browser().open_file(page());
    browser().wait_until("window.buoyancy_hydrostatics !== undefined");
    return nlohmann::json::parse(written.standard_output);
  }
  static nlohmann::json open_arms() {
    return open(kShip, {"gz", "--heel", "-90:90:5", "--deck-edge", "0,-10,6", "--deck-edge", "0,10,6",
                        "--downflooding", "10,-10,8"});
  }

  static std::vector<double> recorded(const std::string& name) { return csv_column(read_file(csv()), name); }
  static std::vector<double> plotted(const std::string& plot, int series = 0) {
    return browser()
        .run("return Array.from(buoyancy_hydrostatics.plots[arguments[0]].series[arguments[1]].values)", plot,
             series)
        .get<std::vector<double>>();
  }
  // Where a point of B is drawn in W.
  static std::array<double, 3> drawn(double x, double y, double z) {
    return browser()
        .run(
            "const { scene } = buoyancy_hydrostatics; const { group } = scene.bodies.get(1);"
            "const point = new "
            "THREE.Vector3(...arguments[0]).applyQuaternion(group.quaternion).add(group.position);"
            "return [0, 1, 2].map((i) => point.getComponent(i) + scene.origin[i]);",
            std::array{x, y, z})
        .get<std::array<double, 3>>();
  }
  static Colour colour_at(const Image& image, std::array<double, 3> point) {
    const nlohmann::json at = browser().run(
        "const box = document.getElementById('canvas').getBoundingClientRect();"
        "const [x, y] = buoyancy_hydrostatics.scene.project(arguments[0]); return [x + box.left, y + "
        "box.top];",
        point);
    return image.pixel(static_cast<int>(at[0].get<double>()), static_cast<int>(at[1].get<double>()));
  }

 private:
  static inline std::unique_ptr<TempDir> directory_;
};

TEST_F(HydrostaticsPage, OpensWithoutErrorsOrOtherResources) {
  const std::vector<std::vector<std::string>> commands{
      {"gz", "--heel", "10"}, {"table", "--draft", "1:11:1", "--trim", "-2:2:2"}, {"table", "--draft", "6"}};
  for (const std::vector<std::string>& command : commands) {
    SCOPED_TRACE(command.front());
    open(kShip, command);
    EXPECT_EQ(browser().console_errors(), std::vector<std::string>{});
    EXPECT_EQ(browser().run("return performance.getEntriesByType('resource').length"), 0);
    EXPECT_EQ(browser().run("return buoyancy_hydrostatics.scene !== null"), true);
    EXPECT_LT(read_file(page()).size(), 2'000'000);
  }
}

TEST_F(HydrostaticsPage, PlotsRightingArmsAndMarksTheirLimits) {
  const nlohmann::json results = open_arms();
  const std::vector<double> arms = recorded("gz");
  const std::vector<double> shown = plotted("gz");
  ASSERT_EQ(shown.size(), 37U);
  for (std::size_t i = 0; i < arms.size(); ++i) EXPECT_NEAR(shown[i], arms[i], 1e-9) << i;
  EXPECT_EQ(plotted("area"), recorded("area"));
  EXPECT_EQ(plotted("kn").back(), recorded("kn").back());
  EXPECT_EQ(browser().run("return buoyancy_hydrostatics.plots.trim.figure.textContent"),
            "Trim, °0 throughout");

  const auto marks = browser()
                         .run(
                             "return [...document.querySelectorAll('#plots figure:first-child text')].map("
                             "(text) => text.textContent).filter((text) => text.includes(' at '))")
                         .get<std::vector<std::string>>();
  const auto has_mark = [&marks](const char* name, const nlohmann::json& heel) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%s at %.2f°", name, heel.get<double>());
    return std::ranges::find(marks, text.data()) != marks.end();
  };
  EXPECT_TRUE(has_mark("GZ vanishes", results.at("vanishing_starboard")));
  EXPECT_TRUE(has_mark("GZ vanishes", results.at("vanishing_port")));
  EXPECT_TRUE(has_mark("largest arm", results.at("max_starboard").at("heel")));
  EXPECT_TRUE(has_mark("deck edge", std::atan(0.6) / kRadiansPerDegree));
  EXPECT_TRUE(has_mark("downflooding", results.at("downflooding").at("starboard").at("heel")));
  EXPECT_TRUE(contains(text_of("#tables"), "area from 0 to downflooding at "));
  EXPECT_TRUE(contains(text_of("#tables"), "not a class approval"));
  EXPECT_EQ(browser().run("return document.querySelectorAll('#tables table').length"), 4);
}

TEST_F(HydrostaticsPage, HeelsHullWithSliderPlotAndKeys) {
  open_arms();
  EXPECT_EQ(text_of("#position"), "0°") << "upright at first";
  EXPECT_NEAR(drawn(0, -10, 6)[2], 6.0, 1e-6);
  browser().run("buoyancy_hydrostatics.show_row(24)");
  EXPECT_EQ(text_of("#position"), "30°");
  // To starboard, which is at negative y in B: the water plane turns about its middle.
  EXPECT_NEAR(drawn(0, -10, 6)[2],
              (6.0 - 10.0 * std::tan(30 * kRadiansPerDegree)) * std::cos(30 * kRadiansPerDegree), 1e-5);
  EXPECT_GT(drawn(0, 10, 6)[2], 6.0);
  browser().press("Home");
  EXPECT_EQ(text_of("#position"), "-90°");
  browser().press("ArrowRight");
  EXPECT_EQ(text_of("#position"), "-85°");
  browser().click("#plots figure:first-child svg");
  EXPECT_NEAR(browser().run("return buoyancy_hydrostatics.columns.heel[buoyancy_hydrostatics.shown.row]"),
              0.0, 11.0)
      << "the middle of the picture, which has a wider margin on the left";
  browser().drag("#slider", 100, 0);
  EXPECT_GT(browser().run("return buoyancy_hydrostatics.shown.row").get<int>(), 20);
  browser().press("End");
  browser().press("n");
  EXPECT_EQ(text_of("#status"), "heel 0°, trim 0°, draft 6 m");
  EXPECT_EQ(browser().run("return document.querySelectorAll('#attitudes [aria-pressed=true]').length"), 1);
}

TEST_F(HydrostaticsPage, PicturesAnglesOfLoll) {
  open(std::string(kShip).replace(kShip.find("0, 2]"), 5, "0, 2.8]"), {"gz"});
  constexpr double kBm = 400.0 / 72.0;
  constexpr double kGm = 3.0 + kBm - 8.8;
  const double loll = std::atan(std::sqrt(-2.0 * kGm / kBm)) / kRadiansPerDegree;
  const auto heels =
      browser().run("return buoyancy_hydrostatics.rests.map(({ heel }) => heel)").get<std::vector<double>>();
  ASSERT_EQ(heels.size(), 3U) << "to either side, and upside down";
  EXPECT_NEAR(heels[0], -loll, 1e-6);
  EXPECT_NEAR(heels[1], loll, 1e-6);
  EXPECT_NEAR(heels[2], 180.0, 1e-6);
  browser().click("#attitudes button:nth-child(2)");
  EXPECT_EQ(text_of("#status").find("at rest: heel 16.52"), 0U);
  EXPECT_NEAR(drawn(0, 0, 0)[2], 0.0, 1e-5) << "the middle of the waterplane";
  EXPECT_LT(drawn(0, -10, 0)[2], -2.0) << "starboard";
}

TEST_F(HydrostaticsPage, DrawsCentresWithGzBetweenThem) {
  const std::string with_tank = kShip + R"([[body.tank]]
name = "ballast"
shape = { type = "box", size = [20, 16, 3] }
position = [-20, 0, -4]
fill = 0.5
density = 1025
)";
  for (const std::string& ship : {kShip, with_tank}) {
    open(ship, {"gz", "--heel", "-40:40:20"});
    const std::vector<double> arms = recorded("gz");
    for (int row = 0; row < 5; ++row) {
      // Starboard is at negative y in W.
      const auto distance = browser().run(
          "buoyancy_hydrostatics.show_row(arguments[0]);"
          "const { centre_of_buoyancy: b, centre_of_mass: g } = "
          "buoyancy_hydrostatics.scene.bodies.get(1).markers;"
          "return g.position.y - b.position.y;",
          row);
      EXPECT_NEAR(distance.get<double>(), arms.at(static_cast<std::size_t>(row)), 1e-6) << row;
    }
  }
}

TEST_F(HydrostaticsPage, PicturesEveryStableAttitude) {
  const nlohmann::json results = open(kLog, {"equilibrium", "--unstable"});
  std::vector<nlohmann::json> stable;
  for (const nlohmann::json& at : results.at("attitudes")) {
    if (at.at("stable").get<bool>()) stable.push_back(at);
  }
  ASSERT_EQ(stable.size(), 4U);
  EXPECT_GT(results.at("attitudes").size(), stable.size());
  // Pixels of the dry and of the wetted hull in each picture.
  const auto shares = browser().run(R"(
    return [...document.querySelectorAll('#attitudes canvas')].map((canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let dry = 0, wet = 0;
      for (let i = 0; i < data.length; i += 4) {
        if (data[i] > data[i + 2] + 60) ++dry;
        if (data[i + 2] > data[i] + 40 && data[i] + data[i + 1] + data[i + 2] < 330) ++wet;
      }
      return [dry, wet];
    });)");
  ASSERT_EQ(shares.size(), stable.size());
  for (const nlohmann::json& share : shares) {
    EXPECT_GT(share[0].get<int>(), 500) << share;
    EXPECT_GT(share[1].get<int>(), 50) << share;
  }
  for (std::size_t i = 0; i < stable.size(); ++i) {
    const std::string button = "#attitudes button:nth-child(" + std::to_string(i + 1) + ")";
    browser().click(button);
    const double heel = stable[i].at("heel").get<double>();
    EXPECT_NEAR(std::abs(std::remainder(heel, 90.0)), 45.0, 1e-6);
    EXPECT_EQ(
        browser().run("return document.querySelector(arguments[0]).getAttribute('aria-pressed')", button),
        "true");
    EXPECT_EQ(text_of("#status").find("stable: heel "), 0U);
    EXPECT_NEAR(drawn(0, 0, 0)[2], stable[i].at("position")[2].get<double>(), 1e-6);
  }
  EXPECT_TRUE(contains(text_of("pre"), "orientation = ["));
  EXPECT_EQ(text_of("#title"), "scene.toml, log </script>: attitudes at rest");
}

TEST_F(HydrostaticsPage, DrawsHullAtItsWaterline) {
  open(kShip, {"equilibrium"});
  browser().run(
      "const { rests, show_rest } = buoyancy_hydrostatics; show_rest(rests.find(({ text }) => "
      "text.startsWith("
      "'heel 0°')));");
  const Image image = browser().screenshot();
  // The side at y = -10 is towards the camera.
  const Colour dry = colour_at(image, {5.0, -10.0, 3.0});
  EXPECT_GT(dry.red, dry.blue + 60);
  const Colour wetted = colour_at(image, {5.0, -10.0, -2.0});
  EXPECT_GT(wetted.blue, wetted.red + 40);
  const Colour line = colour_at(image, {5.0, -10.0, 0.0});
  EXPECT_GT(std::min({line.red, line.green, line.blue}), 180) << "white";
}

TEST_F(HydrostaticsPage, PlotsCurvesOfEachTrim) {
  open(kShip, {"table", "--draft", "1:11:1", "--trim", "-2:2:1"});
  const std::vector<double> volumes = recorded("displacement_volume");
  ASSERT_EQ(volumes.size(), 55U);
  EXPECT_EQ(browser().run("return buoyancy_hydrostatics.plots.km_t.series.map(({ name }) => name)"),
            nlohmann::json({"trim -2°", "trim -1°", "trim 0°", "trim 1°", "trim 2°"}));
  for (int trim = 0; trim < 5; ++trim) {
    const std::vector<double> expected(volumes.begin() + 11 * trim, volumes.begin() + 11 * (trim + 1));
    EXPECT_EQ(plotted("displacement_volume", trim), expected);
  }
  EXPECT_EQ(browser().run("return Object.keys(buoyancy_hydrostatics.plots).length"), 24);
  // The middle draft without trim, then one with the bow up.
  EXPECT_EQ(text_of("#status"), "draft 6 m, trim 0°");
  EXPECT_NEAR(drawn(0, 0, -6)[2], -6.0, 1e-6);
  browser().run("buoyancy_hydrostatics.show_row(4 * 11 + 3)");
  EXPECT_EQ(text_of("#status"), "draft 4 m, trim 2°");
  EXPECT_NEAR(drawn(0, 0, -2)[2], 0.0, 1e-6) << "the point on the water at midship";
  EXPECT_NEAR(drawn(40, 0, -2)[2], 40.0 * std::sin(2 * kRadiansPerDegree), 1e-5);
  EXPECT_EQ(browser().run("return document.getElementById('group').selectedIndex"), 4);
  EXPECT_EQ(browser().run("return buoyancy_hydrostatics.scene.bodies.get(1).markers.weight.visible"), false);
}

TEST_F(HydrostaticsPage, SaysThatABodySinks) {
  const std::string heavy = std::string(kShip).replace(kShip.find("512.5"), 5, "2000");
  open(heavy, {"equilibrium"});
  EXPECT_TRUE(contains(text_of("#notices"), "The body sinks"));
  EXPECT_TRUE(contains(text_of("#notices"), "Fully submerged it rests at a heel of"));
  EXPECT_EQ(browser().run("return document.getElementById('stage').offsetHeight"), 0);
}

TEST_F(HydrostaticsPage, StaysSmallWithLargeHullAndManyRows) {
  open(R"([[body]]
id = 1
shape = { type = "rock", frequency = 71 }
[body.client]
density = 500
)",
       {"table", "--draft", "1"});
  EXPECT_LT(read_file(page()).size(), 5'000'000);
  EXPECT_TRUE(contains(text_of("#notices"), "The results are those of all 100,820."));
  open(kShip, {"gz", "--heel", "0:50:0.008"});
  EXPECT_LT(read_file(page()).size(), 5'000'000);
  EXPECT_TRUE(contains(text_of("#notices"), "5,000 rows of 6,251"));
  const std::vector<double> all = recorded("kn");
  const std::vector<double> shown = plotted("kn");
  ASSERT_EQ(shown.size(), 5'000U);
  EXPECT_NEAR(shown.front(), all.front(), 1e-10);
  EXPECT_EQ(shown.back(), all.back());
}

TEST_F(HydrostaticsPage, FitsPhoneScreen) {
  browser().resize(kPhone);
  open_arms();
  EXPECT_LE(browser().run("return document.documentElement.scrollWidth").get<int>(), kPhone.width);
  EXPECT_GT(browser().region_of("#canvas").width, 300);
  open(kLog, {"equilibrium"});
  EXPECT_LE(browser().run("return document.documentElement.scrollWidth").get<int>(), kPhone.width);
}

}  // namespace
}  // namespace buoyancy::view
