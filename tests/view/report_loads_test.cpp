// The plots of loads in the page of buoyancy-report, in a real browser.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "messages/conversions.h"
#include "tests/support/byte_vector.h"
#include "tests/support/contains.h"
#include "tests/support/csv.h"
#include "tests/support/scene_of.h"
#include "tests/view/moving_bodies.h"
#include "tests/view/report_page_test.h"

namespace buoyancy::view {
namespace {

constexpr double kMass = 1200.0;                // [kg], of body 1
const Vec3 kCenterToReference(0.5, 0.4, -0.2);  // [m], B: reference point - centre of mass of body 1
constexpr double kFloatRounding = 1e-7;         // of the page's numbers, relative
constexpr std::size_t kRowsBetweenChecks = 100;
constexpr double kHalfStep = 1.0;  // [N, N m], what drag changes in half a step of the client

class ReportPageOfLoads : public ReportPageTest {
 protected:
  // A run of buoyancy-client, which simulates body 1. Its rows are few enough to be in the page all.
  void open_simulation() {
    const std::string scene = directory_.write("moving.toml", moving_bodies());
    const std::string run = directory_.path("run.csv");
    const FinishedProcess simulated =
        run_program("buoyancy-client", {"--scene", scene, "--embedded", "--duration", "3", "--csv", run});
    ASSERT_EQ(simulated.exit_code, 0) << simulated.standard_error;
    open_run(scene, run);
  }

  static void select_axis(const std::string& value) {
    browser().run(
        "const choice = document.getElementById('load_axis'); choice.value = arguments[0];"
        "choice.dispatchEvent(new Event('change'));",
        value);
  }
  // The values that are drawn of a part: all rows.
  static std::vector<double> drawn(const std::string& part) {
    return browser()
        .run(
            "return Array.from(buoyancy_report.plots.loads.stack.series.find((one) => one.part === "
            "arguments[0]).values)",
            part)
        .get<std::vector<double>>();
  }
  static nlohmann::json drawn_parts() {
    return browser().run("return buoyancy_report.plots.loads.stack.series.map((one) => one.name)");
  }
};

struct Row {
  WrenchRequest request;
  std::array<double, 6> wrench{};
};

// The rows of buoyancy-client's CSV file.
std::vector<Row> read_rows(const std::string& path) {
  std::vector<Row> rows;
  for (const CsvRow& fields : csv_rows(read_file(path))) {
    if (fields[0] == "utime") continue;
    const std::vector<double> cells = numbers_of(fields);
    Row& row = rows.emplace_back();
    const auto seq = static_cast<std::int64_t>(rows.size());
    row.request.id = {.utime = static_cast<std::int64_t>(cells[0]), .session_id = 1, .seq = seq};
    BodyState& state = row.request.bodies.emplace_back();
    state.body_id = static_cast<std::int32_t>(cells[1]);
    std::copy_n(&cells[2], 3, state.position.begin());
    std::copy_n(&cells[5], 4, state.quaternion_wxyz.begin());
    std::copy_n(&cells[9], 3, state.linear_velocity.begin());
    std::copy_n(&cells[12], 3, state.angular_velocity.begin());
    std::copy_n(&cells[16], 6, row.wrench.begin());
  }
  return rows;
}

BodyLoads loads_of(RequestHandler& handler, const WrenchRequest& request) {
  handler.handle(encoded(request));
  return decoded<BodiesLoads>(handler.last_loads()).bodies.at(0);
}

TEST_F(ReportPageOfLoads, StacksComputedLoadsAlongEveryAxis) {
  ASSERT_NO_FATAL_FAILURE(open_simulation());
  const std::vector<Row> rows = read_rows(directory_.path("run.csv"));
  const Scene scene = scene_of(moving_bodies());
  RequestHandler handler(scene);
  EXPECT_EQ(drawn_parts(), nlohmann::json({"buoyancy", "drag", "added mass", "weight", "sum"}));
  constexpr std::array kAxes{2, 0, 1};  // the options: up, x, y
  for (std::size_t option = 0; option < 6; ++option) {
    const bool torque = option >= 3;
    const auto axis = static_cast<std::size_t>(kAxes[option % 3]);
    select_axis((torque ? "t" : "f") + std::to_string(option % 3));
    const std::vector<double> buoyancy = drawn("buoyancy");
    const std::vector<double> drag = drawn("drag");
    const std::vector<double> added_mass = drawn("added_mass");
    const std::vector<double> weight = drawn("weight");
    const std::vector<double> sum = drawn("sum");
    ASSERT_EQ(sum.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); i += kRowsBetweenChecks) {
      SCOPED_TRACE(testing::Message() << "option " << option << ", row " << i);
      const BodyLoads loads = loads_of(handler, rows[i].request);
      const auto& [w, x, y, z] = rows[i].request.bodies[0].quaternion_wxyz;
      const Vec3 weight_W(0.0, 0.0, -kMass * kGravity);
      const Vec3 arm_W = Eigen::Quaterniond(w, x, y, z).normalized() * -kCenterToReference;
      const double expected_weight = torque ? arm_W.cross(weight_W)[static_cast<Eigen::Index>(axis)]
                                            : weight_W[static_cast<Eigen::Index>(axis)];
      const double total = rows[i].wrench[torque ? axis + 3 : axis] + expected_weight;
      const double allowed = kFloatRounding * 2e4;
      EXPECT_NEAR(buoyancy[i], (torque ? loads.buoyancy_torque : loads.buoyancy_force)[axis], allowed);
      EXPECT_NEAR(drag[i], (torque ? loads.drag_torque : loads.drag_force)[axis], allowed);
      EXPECT_NEAR(added_mass[i], (torque ? loads.added_mass_torque : loads.added_mass_force)[axis], allowed);
      EXPECT_NEAR(weight[i], expected_weight, allowed);
      EXPECT_NEAR(sum[i], buoyancy[i] + drag[i] + added_mass[i] + weight[i], 1e-9);
      EXPECT_NEAR(sum[i], total, kHalfStep) << "the client's wrench, which its velocity lags, and the weight";
    }
  }
  const std::vector<double> immersion =
      browser()
          .run("return Array.from(buoyancy_report.plots.loads.immersion.series[0].values)")
          .get<std::vector<double>>();
  for (std::size_t i = 0; i < rows.size(); i += kRowsBetweenChecks) {
    EXPECT_NEAR(immersion[i], 100.0 * loads_of(handler, rows[i].request).immersion, 1e-4) << "row " << i;
  }
}

TEST_F(ReportPageOfLoads, DrawsAreasBetweenTheirEdges) {
  ASSERT_NO_FATAL_FAILURE(open_simulation());
  select_axis("f1");
  // Values by their height in the picture, from two labels of the axis; then the corners of the areas.
  const nlohmann::json result = browser().run(R"(
    const stack = buoyancy_report.plots.loads.stack;
    const labels = [...stack.svg.querySelectorAll('text[text-anchor="end"]')].map(
      (label) => [Number(label.getAttribute('y')) - 4, Number(label.textContent)]);
    const [[y0, v0], [y1, v1]] = [labels[0], labels[labels.length - 1]];
    const value = (y) => v0 + (y - y0) * (v1 - v0) / (y1 - y0);
    const corners = (path) => path.getAttribute('d').split(/[MLZ]/).filter((text) => text).map((text) => text.split(' ').map(Number));
    const extremes = (selector) => [...stack.svg.querySelectorAll(selector)].flatMap(corners).reduce(
      ([low, high], [, y]) => [Math.min(low, value(y)), Math.max(high, value(y))], [Infinity, -Infinity]);
    return { pixel: Math.abs((v1 - v0) / (y1 - y0)), areas: extremes('.area'), sum: extremes('.sum'), parts: [...new Set([...stack.svg.querySelectorAll('.area')].map((path) => path.classList[1]))] };)");
  std::vector<double> low(drawn("sum").size());
  std::vector<double> high = low;
  for (const char* part : {"buoyancy", "drag", "added_mass", "weight"}) {
    const std::vector<double> values = drawn(part);
    for (std::size_t i = 0; i < values.size(); ++i) (values[i] > 0.0 ? high : low)[i] += values[i];
  }
  const double pixel = result["pixel"].get<double>();  // [N]
  EXPECT_LT(pixel, 0.02 * (*std::ranges::max_element(high) - *std::ranges::min_element(low)));
  EXPECT_NEAR(result["areas"][0].get<double>(), *std::ranges::min_element(low), pixel);
  EXPECT_NEAR(result["areas"][1].get<double>(), *std::ranges::max_element(high), pixel);
  EXPECT_NEAR(result["sum"][0].get<double>(), std::ranges::min(drawn("sum")), pixel);
  EXPECT_NEAR(result["sum"][1].get<double>(), std::ranges::max(drawn("sum")), pixel);
  EXPECT_EQ(result["parts"], nlohmann::json({"drag", "added_mass"})) << "along x";
  EXPECT_TRUE(
      browser()
          .run("return buoyancy_report.plots.loads.stack.svg.getAttribute('aria-label')")
          .get<std::string>()
          .starts_with(
              "Force along x in N over time from 0 to 3 s: buoyancy from 0 to 0, at the end 0; drag"));
}

TEST_F(ReportPageOfLoads, ShowsDragAndAddedMassOnly) {
  ASSERT_NO_FATAL_FAILURE(open_simulation());
  browser().click("#loads_of_motion");
  EXPECT_EQ(drawn_parts(), nlohmann::json({"drag", "added mass", "sum"}));
  const std::vector<double> drag = drawn("drag");
  const std::vector<double> added_mass = drawn("added_mass");
  const std::vector<double> sum = drawn("sum");
  for (std::size_t i = 0; i < sum.size(); ++i) ASSERT_EQ(sum[i], drag[i] + added_mass[i]) << i;
  browser().click("#loads_of_motion");
  EXPECT_EQ(drawn_parts().size(), 5U);
}

TEST_F(ReportPageOfLoads, SaysWhatForcesAndTitlesMean) {
  ASSERT_NO_FATAL_FAILURE(open_simulation());
  const nlohmann::json titles =
      browser().run("const { force, energy } = buoyancy_report.plots; return [force.title, energy.title];");
  EXPECT_EQ(titles, nlohmann::json({"Force of the water", "Mechanical energy, not conserved"}));
  EXPECT_TRUE(contains(text_of("#tables"), "Current: [0.5, -0.25, 0.125] m/s."));
  EXPECT_EQ(browser().run("return buoyancy_report.plots.loads.note.textContent"),
            "The loads were computed from the scene.");
  EXPECT_EQ(
      browser().run(
          "return [...document.querySelectorAll('#legend li')].slice(-2).map((item) => item.textContent)"),
      nlohmann::json({"drag, 5 times as long as other forces",
                      "velocity of the water, half the body's diagonal per m/s"}));
}

TEST_F(ReportPageOfLoads, ComputesEnergyThatClientRecords) {
  ASSERT_NO_FATAL_FAILURE(open_simulation());
  const auto energies = [] {
    return browser()
        .run("return Array.from(buoyancy_report.plots.energy.series[0].values)")
        .get<std::vector<double>>();
  };
  const std::vector<double> recorded = energies();
  std::ifstream file(directory_.path("run.csv"));
  std::string without_energy;
  for (std::string line; std::getline(file, line);) without_energy += line.substr(0, line.rfind(',')) + '\n';
  ASSERT_NO_FATAL_FAILURE(
      open_run(directory_.path("moving.toml"), directory_.write("without_energy.csv", without_energy)));
  const std::vector<double> computed = energies();
  ASSERT_EQ(computed.size(), recorded.size());
  for (std::size_t i = 0; i < recorded.size(); i += kRowsBetweenChecks) {
    EXPECT_NEAR(computed[i], recorded[i], 1e-6) << "row " << i;
  }
}

TEST_F(ReportPageOfLoads, ShowsLoadsOfSelectedBody) {
  std::string run = "utime,body_id,px,py,pz,qw,qx,qy,qz\n";
  for (int i = 0; i < 10; ++i) {
    for (const int id : {1, 2, 3, 4}) {
      run += std::to_string(1'000 * i) + ',' + std::to_string(id) + ",0,0," + std::to_string(0.1 * i) +
             ",1,0,0,0\n";
    }
  }
  ASSERT_NO_FATAL_FAILURE(
      open_run(directory_.write("moving.toml", moving_bodies()), directory_.write("poses.csv", run)));
  const auto shown = [](int id) {
    return browser().run(
        "buoyancy_report.select(arguments[0]); const { loads, force } = buoyancy_report.plots;"
        "return [loads.box.hidden, loads.motion_label.hidden, force.title, loads.note.textContent];",
        id);
  };
  const std::string resting =
      "The loads were computed from the scene. Where the run holds no velocities, they are those of a body "
      "at rest.";
  EXPECT_EQ(shown(2), nlohmann::json({false, false, "Force of the water", resting}));
  EXPECT_EQ(drawn_parts(), nlohmann::json({"buoyancy", "drag", "sum"}));
  EXPECT_EQ(shown(3),
            nlohmann::json({false, true, "Buoyant force", "The loads were computed from the scene."}));
  EXPECT_EQ(drawn_parts(), nlohmann::json({"buoyancy", "sum"}));
  EXPECT_EQ(shown(4)[0], true);
  EXPECT_EQ(shown(4)[2], "Buoyant force");
  EXPECT_EQ(shown(1)[0], false);
}

TEST_F(ReportPageOfLoads, FitsPhoneScreen) {
  ASSERT_NO_FATAL_FAILURE(open_simulation());
  browser().resize(kPhone);
  EXPECT_LE(browser().run("return document.documentElement.scrollWidth"), kPhone.width);
  EXPECT_GT(browser().run("return buoyancy_report.plots.loads.stack.svg.getBoundingClientRect().width"), 300);
}

}  // namespace
}  // namespace buoyancy::view
