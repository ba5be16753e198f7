// The page of buoyancy-report for a run of buoyancy-client, in a real browser.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/service/one_box_scene.h"
#include "tests/support/contains.h"
#include "tests/support/csv.h"
#include "tests/view/report_page_test.h"

namespace buoyancy::view {
namespace {

// A box that floats half submerged and starts 1 m below its equilibrium.
const std::string kBobbingBox = kOneBoxScene + R"(outputs = ["wrench", "hydrostatics"]
[body.client]
density = 500.0
position = [0, 0, -1]
linear_damping = 8000
)";

FinishedProcess report(std::vector<std::string> arguments) {
  return run_program("buoyancy-report", std::move(arguments));
}

class ReportPage : public ReportPageTest {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<TempDir>();
    const std::string scene = shared_->write("box.toml", kBobbingBox);
    const FinishedProcess simulated =
        run_program("buoyancy-client", {"--scene", scene, "--embedded", "--duration", "5", "--csv", csv()});
    written_ = simulated.exit_code == 0 && report({"--scene", scene, csv(), page()}).exit_code == 0;
  }
  static void TearDownTestSuite() {
    PageTest::TearDownTestSuite();
    shared_.reset();
  }

  void SetUp() override {
    ASSERT_TRUE(written_) << "buoyancy-client or buoyancy-report failed";
    PageTest::SetUp();
    open_page(page());
  }

  static std::string csv() { return shared_->path("run.csv"); }
  static std::string page() { return shared_->path("run.html"); }

  static std::vector<double> recorded(const std::string& name) { return csv_column(read_file(csv()), name); }

  static void go_to(double time) { browser().run("buoyancy_report.seek(arguments[0])", time); }
  static double time() { return browser().run("return buoyancy_report.state().time").get<double>(); }

 private:
  static inline std::unique_ptr<TempDir> shared_;
  static inline bool written_ = false;
};

TEST_F(ReportPage, OpensWithoutErrorsOrOtherResources) {
  EXPECT_EQ(browser().console_errors(), std::vector<std::string>{});
  EXPECT_EQ(browser().run("return performance.getEntriesByType('resource').length"), 0);
  EXPECT_LT(read_file(page()).size(), 5'000'000);
}

TEST_F(ReportPage, DrawsSkyWaterHullAndWaterline) {
  go_to(5.0);
  const double heave = recorded("pz").back();
  const Image image = browser().screenshot();
  const auto at = [&image](std::array<int, 2> pixel) { return image.pixel(pixel[0], pixel[1]); };
  // The face at y = -1.5 is towards the camera.
  const Colour dry = at(pixel_of(0.7, -1.5, 0.7 + heave));
  EXPECT_GT(dry.red, dry.green);
  EXPECT_GT(dry.green, dry.blue + 60) << "orange";
  const Colour wetted = at(pixel_of(0.7, -1.5, -1.2));
  EXPECT_GT(wetted.blue, wetted.red + 60) << "blue";
  const Region canvas = browser().region_of("#canvas");
  const Colour sky = image.pixel(canvas.left + 5, canvas.top + 5);
  EXPECT_TRUE(is_near({234, 243, 250}, 4)(sky));
  const Colour water = image.pixel(canvas.left + 8, canvas.top + canvas.height - 8);
  EXPECT_GT(water.blue, water.red + 50);
  EXPECT_LT(wetted.red + wetted.green + wetted.blue, water.red + water.green + water.blue - 60)
      << "hull, not water";

  EXPECT_TRUE(waterline_at(image, 0.7, -1.5, 0.0)) << "at the face's middle";
  const std::array<int, 2> line = pixel_of(0.7, -1.5, 0.0);
  EXPECT_FALSE(is_near({255, 255, 255}, 45)(at({line[0], line[1] - 12})));
}

TEST_F(ReportPage, MovesBodyWithSlider) {
  const auto height = [] {
    return browser().run("return buoyancy_report.scene.bodies.get(1).group.position.z").get<double>();
  };
  const Region canvas = browser().region_of("#canvas");
  const Image at_start = browser().screenshot();
  EXPECT_NEAR(height(), recorded("pz").front(), 1e-6);
  browser().drag("#slider", 60, 0);
  const double later = time();
  EXPECT_GT(later, 2.0);
  EXPECT_NEAR(height(), recorded("pz").at(static_cast<std::size_t>(later * 1e3)), 0.01);
  EXPECT_GT(browser().screenshot().share_changed(at_start, canvas), 0.01);
}

TEST_F(ReportPage, SeeksToClickedTimeInPlot) {
  browser().run("document.querySelector('#plots figure:nth-of-type(2) svg').id = 'angles'");
  browser().click("#angles");
  EXPECT_GT(time(), 1.5);
  EXPECT_LT(time(), 3.5);
}

TEST_F(ReportPage, RespondsToKeys) {
  browser().press("End");
  EXPECT_EQ(time(), 5.0);
  browser().press("Home");
  EXPECT_EQ(time(), 0.0);
  browser().press("ArrowRight");
  EXPECT_NEAR(time(), 0.05, 1e-9);
  browser().press("+");
  EXPECT_EQ(browser().run("return buoyancy_report.state().speed"), 2);
  // At the lowest speed the run takes 50 s, so it does not end during the test.
  for (int i = 0; i < 4; ++i) browser().press("-");
  EXPECT_EQ(browser().run("return buoyancy_report.state().speed"), 0.1);
  const double before = time();
  browser().press(" ");
  browser().wait_until("buoyancy_report.state().playing && buoyancy_report.state().time > " +
                       std::to_string(before + 0.01));
  browser().press(" ");
  EXPECT_EQ(browser().run("return buoyancy_report.state().playing"), false);
  const double azimuth = browser().run("return buoyancy_report.scene.azimuth").get<double>();
  browser().press("a");
  EXPECT_NE(browser().run("return buoyancy_report.scene.azimuth").get<double>(), azimuth);
}

TEST_F(ReportPage, RotatesCameraOnDrag) {
  const Image before = browser().screenshot();
  browser().drag("#canvas", 120, 20);
  EXPECT_GT(browser().screenshot().share_changed(before, browser().region_of("#canvas")), 0.01);
}

TEST_F(ReportPage, DistinguishesDryAndWettedByLuminance) {
  const auto luminance = [](const std::string& name) {
    return browser()
        .run(
            "const c = parseInt(WaterScene.colours[arguments[0]].slice(1), 16);"
            "const part = (v) => { v /= 255; return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; "
            "};"
            "return 0.2126 * part(c >> 16) + 0.7152 * part(c >> 8 & 255) + 0.0722 * part(c & 255);",
            name)
        .get<double>();
  };
  const auto contrast = [&](const std::string& brighter, const std::string& darker) {
    return (luminance(brighter) + 0.05) / (luminance(darker) + 0.05);
  };
  EXPECT_GT(contrast("dry", "wet"), 3.0);
  EXPECT_GT(contrast("waterline", "wet"), 3.0);
  EXPECT_GT(contrast("waterline", "dry"), 1.5);
}

TEST_F(ReportPage, RefusesToOverwriteInputAndInvalidThreeJs) {
  const std::string scene = directory_.write("box.toml", kBobbingBox);
  EXPECT_EQ(report({"--scene", scene, csv(), scene}).exit_code, 2);
  EXPECT_EQ(report({"--scene", scene, csv(), csv()}).exit_code, 2);
  EXPECT_EQ(read_file(scene), kBobbingBox);
  const FinishedProcess refused =
      report({"--scene", scene, csv(), directory_.path("run.html"), "--three", directory_.path("")});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(contains(refused.standard_error, "cannot be read"));
}

TEST_F(ReportPage, FitsPhoneScreen) {
  browser().resize(kPhone);
  open_page(page());
  EXPECT_LE(browser().run("return document.documentElement.scrollWidth").get<int>(), kPhone.width);
  EXPECT_GT(browser().region_of("#canvas").width, 300);
  EXPECT_EQ(browser().run("return [...document.querySelectorAll('caption span')]"
                          ".filter((caption) => caption.getBoundingClientRect().right > innerWidth).length"),
            0)
      << "captions that are cut";
}

TEST_F(ReportPage, SeeksToTimeInUrlFragment) {
  for (const std::string hash : {"#t=abc", "#t=", "#t=NaN", "#t=1e999", "#x"}) {
    browser().open("about:blank");
    browser().open("file://" + page() + hash);
    browser().wait_until("window.buoyancy_report !== undefined");
    EXPECT_EQ(time(), 0.0) << hash;
    EXPECT_EQ(browser().run("return document.getElementById('clock').textContent"), "0.000 s") << hash;
  }
  browser().run("location.hash = '#t=2.5'");
  browser().wait_until("buoyancy_report.state().time === 2.5");
  browser().run("location.hash = '#t=-3'");
  browser().wait_until("buoyancy_report.state().time === 0");
}

// The columns of buoyancy-client --csv without the velocities.
const std::string kRunHeader =
    "utime,body_id,px,py,pz,qw,qx,qy,qz,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz,energy\n";

TEST_F(ReportPage, PlotsGapsForFailedResponsesAndInvalidPoses) {
  const std::string run = kRunHeader +
                          "0,1,0,0,0.1,1,0,0,0,0,0,0,1e5,0,0,0,1,0,0,0,5\n"
                          "1000000,1,0,0,0.2,1,0,0,0,0,0,0,2e5,0,0,0,1,0,0,0,5\n"
                          "2000000,1,0,0,0.3,1,0,0,0,6,0,0,0,0,0,0,0,0,0,0,0\n"
                          "3000000,1,0,0,0.4,1,0,0,0,0,0,0,4e5,0,0,0,1,0,0,0,5\n"
                          "4000000,1,nan,0,0.5,1,0,0,0,2,0,0,0,0,0,0,0,0,0,0,0\n"
                          "5000000,1,0,0,0.6,0,0,0,0,3,0,0,0,0,0,0,0,0,0,0,0\n"
                          "6000000,1,0,0,0.7,1,0,0,0,99,0,0,0,0,0,0,0,0,0,0,0\n";
  ASSERT_NO_FATAL_FAILURE(
      open_run(directory_.write("box.toml", kBobbingBox), directory_.write("run.csv", run)));

  const auto plotted = [](const std::string& plot) {
    return browser().run("return Array.from(buoyancy_report.plots[arguments[0]].series[0].values)", plot);
  };
  const nlohmann::json none;
  EXPECT_EQ(plotted("force"), nlohmann::json({1e5, 2e5, none, 4e5, none, none, none}));
  EXPECT_EQ(plotted("torque"), nlohmann::json({0, 0, none, 0, none, none, none}));
  EXPECT_EQ(plotted("energy"), nlohmann::json({5, 5, none, 5, none, none, none}));
  EXPECT_EQ(plotted("heave"), nlohmann::json({0.1, 0.2, 0.3, 0.4, none, none, 0.7}));
  EXPECT_EQ(plotted("angles"), nlohmann::json({0, 0, 0, 0, none, none, 0}));
  EXPECT_EQ(browser().run("return Array.from(buoyancy_report.bodies[0].columns.fz)"),
            nlohmann::json({1e5, 2e5, 0, 4e5, 0, 0, 0}))
      << "as recorded";
  const nlohmann::json drawn = browser().run(R"(
    const paths = Array.from(buoyancy_report.plots.force.svg.querySelectorAll('path')).slice(0, 2);
    return paths.map((path) => path.getAttribute('d').replace(/[^MLh]/g, ''));)");
  EXPECT_EQ(drawn, nlohmann::json({"MLM", "Mh"})) << "a line, and a dot for an isolated row";

  const auto at = [](double when) {
    go_to(when);
    return browser().run(
        "const body = buoyancy_report.scene.bodies.get(1);"
        "return [document.getElementById('status').textContent.split(':')[1].trim(), body.group.visible, "
        "body.markers.centre_of_mass.visible, body.markers.force.visible];");
  };
  EXPECT_EQ(at(1.5), nlohmann::json({"OK", true, true, true}));
  EXPECT_EQ(at(2.5), nlohmann::json({"OPEN_EDGE_WET", true, true, false}));
  EXPECT_EQ(at(3.5), nlohmann::json({"OK", true, true, true})) << "until the invalid pose";
  EXPECT_EQ(at(4.5), nlohmann::json({"NON_FINITE_POSE", false, false, false}));
  EXPECT_EQ(at(5.5), nlohmann::json({"BAD_QUATERNION", false, false, false}));
  EXPECT_EQ(at(6.0), nlohmann::json({"status 99", true, true, false}));

  const nlohmann::json counted = browser().run(R"(
    const table = Array.from(document.querySelectorAll('#tables table')).find((one) => one.caption.textContent.includes('by the status'));
    return Array.from(table.tBodies[0].rows).map((row) => [row.cells[1].textContent.split(':')[0], row.cells[2].textContent]);)");
  const auto row = [](const char* status, const char* count) {
    return nlohmann::json::array({status, count});
  };
  EXPECT_EQ(counted,
            nlohmann::json::array({row("OK", "3"), row("NON_FINITE_POSE", "1"), row("BAD_QUATERNION", "1"),
                                   row("OPEN_EDGE_WET", "1"), row("status 99", "1")}));
}

TEST_F(ReportPage, OmitsStatusTableIfAllRowsAreOk) {
  EXPECT_EQ(browser().run("return document.getElementById('tables').textContent.includes('by the status')"),
            false);
}

TEST_F(ReportPage, ListsShownBodiesAndSummarizesOthers) {
  std::string text = kTestWater;
  for (const char* id : {"1", "2", "3", "5", "6"}) {
    text += std::string("[[body]]\nid = ") + id + "\nshape = { type = \"box\", size = [2, 3, 4] }\n";
  }
  const std::string run = directory_.write("run.csv", kRunHeader +
                                                          "0,1,0,0,0,1,0,0,0,0,0,0,700,0,0,0,1,0,0,-5,0\n"
                                                          "0,2,0,0,0,1,0,0,0,0,0,0,625,0,0,0,1,0,0,0,0\n"
                                                          "0,3,0,0,0,1,0,0,0,6,0,0,0,0,0,0,0,0,0,0,0\n"
                                                          "0,5,0,0,0,1,0,0,0,0,0,0,9,0,0,0,1,0,0,0,0\n");
  const FinishedProcess made = report(
      {"--scene", directory_.write("five.toml", text), "--bodies", "1,5", run, directory_.path("run.html")});
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  EXPECT_TRUE(
      contains(made.standard_output, "2 bodies, 2 rows; 2 more bodies only as a summary (see --bodies)"));
  open_page(directory_.path("run.html"));
  EXPECT_EQ(browser().run("return document.getElementById('subtitle').textContent"), "2 of 4 bodies, 0 s");
  const nlohmann::json notices = browser().run(
      "return Array.from(document.querySelectorAll('#notices p')).map((line) => line.textContent)");
  EXPECT_EQ(notices, nlohmann::json({"The 3D view, the plots and the evaluations show 2 bodies (selected "
                                     "with --bodies). For 2 other bodies, the "
                                     "table \"The bodies\" lists rows, statuses and the largest recorded "
                                     "force. To show them, write a page with "
                                     "--bodies, such as --bodies 2-3.",
                                     "1 body of the scene has no rows in run.csv."}));
  const nlohmann::json table = browser().run(R"(
    const table = Array.from(document.querySelectorAll('#tables table')).find((one) => one.caption.textContent.startsWith('All bodies'));
    return Array.from(table.tBodies[0].rows).map((row) => Array.from(row.cells).map((cell) => cell.textContent).join('|'));)");
  EXPECT_EQ(table, nlohmann::json({"1|body 1|1|OK 1|700|yes", "2|body 2|1|OK 1|625|no",
                                   "3|body 3|1|OPEN_EDGE_WET 1|–|no", "5|body 5|1|OK 1|9|yes",
                                   "6|body 6|0|–|–|no"}));
  EXPECT_EQ(browser().run("return Array.from(buoyancy_report.scene.bodies.keys())"), nlohmann::json({1, 5}));
}

TEST(ReportProgram, ExitsWith2OnInvalidArguments) {
  const TempDir directory;
  const std::string scene = directory.write("box.toml", kOneBoxScene);
  const std::string run =
      directory.write("run.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n");
  const FinishedProcess no_scene = report({run, directory.path("page.html")});
  EXPECT_EQ(no_scene.exit_code, 2);
  EXPECT_TRUE(contains(no_scene.standard_error, "--scene is required"));
  EXPECT_EQ(report({"--scene", scene, run, run}).exit_code, 2) << "RUN would be overwritten";
  EXPECT_EQ(report({"--scene", scene, "--bodies", "2", run, directory.path("page.html")}).exit_code, 2);
  EXPECT_EQ(report({"--scene", scene, directory.path("no.csv"), directory.path("page.html")}).exit_code, 2);
}

TEST(ReportProgram, ExitsWith1IfPageCannotBeWritten) {
  const TempDir directory;
  const std::string scene = directory.write("box.toml", kOneBoxScene);
  const std::string run =
      directory.write("run.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n");
  const FinishedProcess full = report({"--scene", scene, run, "/dev/full"});
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_TRUE(contains(full.standard_error, "/dev/full"));
  const FinishedProcess no_three =
      report({"--scene", scene, "--three", directory.path("none.js"), run, directory.path("page.html")});
  EXPECT_EQ(no_three.exit_code, 1);
  EXPECT_TRUE(contains(no_three.standard_error, "libjs-three"));
}

TEST(ReportProgram, WritesPageOfPartlyInvalidRunAndExitsWith1) {
  const TempDir directory;
  const std::string scene = directory.write("box.toml", kOneBoxScene);
  const std::string run =
      directory.write("run.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n</script>,1\n");
  const FinishedProcess finished = report({"--scene", scene, run, directory.path("page.html")});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "line 3"));
  EXPECT_TRUE(contains(read_file(directory.path("page.html")), "line 3"));
}

}  // namespace
}  // namespace buoyancy::view
