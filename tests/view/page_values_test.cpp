// What the modules of view/page compute and draw, with the water tilted and all off-centre: every function by
// values, the sea and its surface against src/waves, bodies, markers and camera against the scene.
#include "tests/view/page_values.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "scene/scene.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"
#include "tests/view/page_test.h"
#include "view/common/scene_model.h"
#include "view/common/sea_json.h"
#include "waves/sea_snapshot.h"

namespace buoyancy::view {
namespace {

using nlohmann::json;

constexpr double kFloat = 1e-6;  // relative, of what the page holds as float32
constexpr int kWidth = 640;      // of the picture [pixels]
constexpr int kHeight = 400;

class PageValues : public PageTest {
 protected:
  void SetUp() override {
    PageTest::SetUp();
    browser().open_file(directory_.write(
        "page.html", page_of_scripts({"format.js", "sea.js", "water_materials.js", "wave_surface.js",
                                      "water_scene.js", "plots.js", "loads.js", "subdivision.js",
                                      "report_tables.js", "hydrostatics_tables.js"})));
  }

  TempDir directory_;
};

// ---- Functions

struct Value {
  const char* expression;
  const char* expected;  // JSON
};

const std::vector<Value> kValues{
    {"[0, 3.2e-9, 4.5e-5, 0.0123, 9.994e-4, 1, 75.25, NaN].map(seconds_text)",
     R"(["0.00 ns", "3.20 ns", "45.0 µs", "12.3 ms", "999 µs", "1.00 s", "75.3 s", "–"])"},
    {"[0, 1, 5].map((status) => status_text([['OK', ''], ['ODD', 'not even']], status))",
     R"(["OK", "ODD: not even", "status 5: defined by a later version"])"},
    {"[0, 1, 2, 12345].map((count) => plural(count, 'row', 'rows'))",
     R"(["0 rows", "1 row", "2 rows", "12,345 rows"])"},
    {"[1234567, 999999, 0.001, 0.00099994, -0, 1 / 3, -2.5e7, 1e6, -Infinity].map(format_number)",
     R"(["1.235e+6", "999,999", "0.001", "9.999e-4", "0", "0.3333", "-2.500e+7", "1.000e+6", "–"])"},
    {"round_ticks(0, 1, 4)", R"({"ticks": [0, 0.5, 1], "digits": 1})"},
    {"round_ticks(-3.3, 47, 5)", R"({"ticks": [0, 20, 40], "digits": 0})"},
    {"round_ticks(-250, 130, 5)", R"({"ticks": [-200, -100, 0, 100], "digits": 0})"},
    {"round_ticks(7, 9.1, 11).ticks.length", "11"},
    {"round_ticks(1.2e-4, 1.31e-4, 3).digits", "6"},
    {"[-1, 0, 0.5, 1, 1.5, 2, 9].map((time) => row_at([0, 1, 1, 2], time))", "[0, 0, 0, 2, 2, 3, 3]"},
    {"row_at([], 3)", "0"},
    {"new Set(Array.from({ length: 16 }, (_, i) => Plot.colour(i) + Plot.dashes(i))).size", "16"},
    {"[[1, 0, 0], [0, -1, 0], [0, 0, 1], [0.6, 0, -0.8]].map(axis_text)",
     R"x(["x", "-y", "z", "(0.6, 0, -0.8)"])x"},
    {"cross_product([1, 2, 3], [-4, 5, 7])", "[-1, -19, 13]"},
    {"dot_product([1, 2, 3], [-4, 5, 7]) + 100 * dot([1, 2, 3], [-4, 5, 7])", "2727"},
    {"[undefined, { drag_center: null, added_mass: false }, { drag_center: [0, 0, 0], added_mass: false },"
     " { drag_center: null, added_mass: true }].map((loads) => has_hydrodynamics({ loads }))",
     "[false, false, true, true]"},
    {"[[3, 4, 5, 9], [7], [2, 4]].map((ids) => id_range(ids.map((id) => ({ id }))))", R"(["3-5", "7", "2"])"},
    {"id_range(Array.from({ length: 1500 }, (_, i) => ({ id: i + 1 })))", R"("1-1000")"},
    {"[1, 2, 5].map((shown) => shown_text({ bodies: [3, 0, 7, 1].map((recorded) => ({ recorded })) },"
     " new Array(shown)))",
     R"(["1 of 3 bodies", "2 of 3 bodies", "3 bodies"])"},
    {"[{ loads: { current: [0.5, -0.25, 1e-4] } }, { loads: { current: [0, 0, 0] } }, {}].map(current_text)",
     R"(["Current: [0.5, -0.25, 1.000e-4] m/s. ", "", ""])"},
    {"mesh_findings({ closed: true })", R"("closed")"},
    {"mesh_findings({ closed: false, boundary_edges: 1, non_manifold_edges: 2, misoriented_edges: 3,"
     " degenerate_faces: 4, dropped_faces: 5, duplicate_faces: 6, intersecting_pairs: 7, turned: true })",
     R"("open: 1 boundary edge; 2 non-manifold edges; 3 misoriented edges; 4 faces without area; 5 faces )"
     R"(dropped; 6 duplicate faces; 7 pairs of faces intersect; was inside out: the winding of all faces )"
     R"(was reversed")"},
    {"[null, -12.34567].map(degrees_text)", R"(["–", "-12.3457°"])"},
    // The range ends where the arm vanishes, or where water comes in before, on each side.
    {"heel_rows({ vanishing_starboard: 70, vanishing_port: -60, max_starboard: { heel: 41 }, max_port: null,"
     " deck_edge: { starboard: { heel: 20 }, port: { heel: -21 } },"
     " downflooding: { starboard: { heel: 50 }, port: { heel: -65 } },"
     " crossings: [{ heel: 12, returns: true }, { heel: -13, returns: false }] })",
     R"([["range of stability ends", "50.0000°", "-60.0000°"], ["largest righting arm", "41.0000°", "–"],
         ["deck edge goes under water", "20.0000°", "-21.0000°"], ["downflooding", "50.0000°", "-65.0000°"],
         ["GZ vanishes, and the body returns to this heel", "12.0000°", "–"],
         ["GZ vanishes, and the body turns away from this heel", "–", "-13.0000°"]])"},
    {"heel_rows({ vanishing_starboard: null, vanishing_port: null, max_starboard: null, max_port: null,"
     " deck_edge: null, downflooding: { starboard: null, port: { heel: -30 } }, crossings: [] })",
     R"([["range of stability ends", "–", "-30.0000°"], ["largest righting arm", "–", "–"],
         ["downflooding", "–", "-30.0000°"]])"},
    {"criteria_rows({ values: [{ name: 'a', value: 1, required: 2, unit: 'm', met: false },"
     " { name: 'b', value: 3, required: 2, unit: 's', met: true }] })",
     R"([["a", 1, 2, "m", "NOT met"], ["b", 3, 2, "s", "met"]])"},
    {"attitude_rows({ attitudes: [{ stable: true, heel: 1, trim: 2, draft: 3, metacentric_heights: [4, 5],"
     " energy: 6, residual_force: 7, force_bound: 14, residual_torque: 9, torque_bound: 36, family: 'curve' "
     "},"
     " { stable: false, heel: 1, trim: 2, draft: 3, metacentric_heights: [4, 5], energy: 6,"
     " residual_force: 7, force_bound: 14, residual_torque: 9, torque_bound: 36, reason: 'why' }] })",
     R"([[1, "stable", 1, 2, 3, 4, 5, 6, 0.5, 0.25, "one of a curve of attitudes of equal energy"],
         [2, "unstable", 1, 2, 3, 4, 5, 6, 0.5, 0.25, "why"]])"},
    // Cells of a table as texts; which columns are of numbers.
    {"(() => { const [table] = table_of('caption', ['a', 'b', 'c'], [[1234.5, null, 'x'], [-1, 0.25, '']])"
     ".children; return [[...table.rows].map((row) => [...row.cells].map((cell) => cell.textContent)),"
     " [...table.rows].map((row) => [...row.cells].map((cell) => cell.className === 'number'))]; })()",
     R"([[["a", "b", "c"], ["1,235", "–", "x"], ["-1", "0.25", ""]],
         [[true, true, false], [true, true, false], [true, true, false]]])"},
    {"decode_numbers(btoa(String.fromCharCode(0, 0, 128, 63, 0, 0, 0, 192)), Float32Array)[1]", "-2"},
    {"[[[1, 2, 3], [1, 0, 0, 0]], [[1, NaN, 3], [1, 0, 0, 0]], [[1, 2, 3], [0, 0, 0, 0]],"
     " [[1, 2, 3], [1, 0, Infinity, 0]], [[1, 2, 3], [0, 1.1, 0, 0]], [[1, 2, 3], [0, 0.6, 0, -0.8004]]]"
     ".map(([p, q]) => is_valid_pose(p, q))",
     "[true, false, false, false, false, true]"},
};

TEST_F(PageValues, OfFunctionsAreThoseExpected) {
  for (const auto& [expression, expected] : kValues) {
    EXPECT_TRUE(agrees(browser().run(std::string("return ") + expression), parse_json(expected)))
        << expression;
  }
}

TEST_F(PageValues, OfTurnedVectorsAreThoseOfEigen) {
  const Eigen::Quaterniond q(0.3, -0.9, 0.4, 1.7);  // of any length
  const Vec3 v(1.5, -2.5, 0.75);
  EXPECT_TRUE(agrees(browser().run("return turned([0.3, -0.9, 0.4, 1.7], [1.5, -2.5, 0.75])"),
                     json_of(q.normalized() * v)));
}

// ---- Plots

// The points of a path: its starts and its lines, in pixels.
json points_of(Browser& browser, const std::string& selector) {
  return browser.run(
      "return [...document.querySelector(arguments[0]).getAttribute('d').matchAll(/([ML])([^MLhZ]*)/g)]"
      ".map(([, command, point]) => [command, ...point.split(' ').map(Number)])",
      selector);
}

constexpr double kPixel = 0.051;  // of tenths that are drawn

TEST_F(PageValues, OfPlotsAreDrawnAtTheirPlaces) {
  browser().run(R"(
    window.sought = [];
    window.plot = new Plot(document.getElementById('plots'), {
      title: 'Title', unit: 'N', on_seek: (time) => sought.push(time), across: { name: 'heel', unit: '°' },
      series: [{ name: 'one', times: [-2, 0, 1, 5, 8], values: [3, -1, NaN, 7, NaN] },
               { name: 'two', times: [-2, 8], values: [12, NaN] }],
      marks: [{ time: -1.5, text: 'first' }, { time: -1.4, text: 'second' }, { time: -1.3, text: 'third' }, { time: 9, text: 'beyond' }],
    });)");
  const auto width = browser().run("return Math.max(160, plot.figure.clientWidth)").get<double>();
  const auto x = [&](double time) { return 58.0 + (time + 2.0) / 10.0 * (width - 58.0 - 16.0); };
  // From -1 to 12, with 8 % of half of that beyond.
  const double high = 5.5 + 1.08 * 6.5;
  const auto y = [&](double value) {
    return 6.0 + (high - value) / (2.0 * 1.08 * 6.5) * (104.0 - 6.0 - 20.0);
  };
  const auto point = [&](const char* command, double time, double value) {
    return json::array({command, x(time), y(value)});
  };
  EXPECT_TRUE(agrees(points_of(browser(), "#plots path:nth-of-type(1)"),
                     json::array({point("M", -2, 3), point("L", 0, -1), point("M", 5, 7)}), kPixel));
  EXPECT_TRUE(agrees(points_of(browser(), "#plots path.lone"), json::array({point("M", 5, 7)}), kPixel));
  const json labels = browser().run(
      "return [...plot.svg.querySelectorAll('text[text-anchor=\"end\"]:not([transform])')].map((text) =>"
      " [text.textContent, Number(text.getAttribute('y')) - 4])");
  EXPECT_TRUE(agrees(labels, json::array({{"0", y(0)}, {"5", y(5)}, {"10", y(10)}}), 1e-9));
  const json ticks = browser().run(
      "return [...plot.svg.querySelectorAll('text[text-anchor=\"middle\"]')].map((text) =>"
      " [text.textContent, Number(text.getAttribute('x'))])");
  ASSERT_GT(ticks.size(), 2U);
  for (const json& tick : ticks) {
    EXPECT_NEAR(tick[1].get<double>(), x(std::stod(tick[0].get<std::string>())), 1e-6) << tick;
  }
  EXPECT_TRUE(agrees(
      browser().run("return [...plot.svg.querySelectorAll('line.mark')].map((line) =>"
                    " [line.textContent, Number(line.getAttribute('x1')), Number(line.getAttribute('x2'))])"),
      json::array({{"first", x(-1.5), x(-1.5)}, {"second", x(-1.4), x(-1.4)}, {"third", x(-1.3), x(-1.3)}})));
  EXPECT_EQ(browser().run("return [...plot.svg.querySelectorAll('text[transform]')].map((text) =>"
                          " text.textContent)"),
            json({"first", "second"}))
      << "no room for the third";
  const auto readings_at = [&](double time) {
    return browser().run(
        "plot.show(arguments[0]); const now = plot.svg.querySelector('.now');"
        "return [Number(now.getAttribute('x1')), Number(now.getAttribute('x2')),"
        "        ...plot.readings.map((one) => one.textContent)]",
        time);
  };
  EXPECT_TRUE(agrees(readings_at(0.5), json::array({x(0.5), x(0.5), "one -1.000", "two 12.00"})));
  EXPECT_TRUE(agrees(readings_at(1), json::array({x(1), x(1), "one –", "two 12.00"})));
  EXPECT_TRUE(agrees(readings_at(8), json::array({x(8), x(8), "one –", "two –"})));
  EXPECT_EQ(browser().run("return plot.svg.getAttribute('aria-label')"),
            "Title in N over heel from -2 to 8°: one from -1 to 7, at the end 7; two from 12 to 12, at the "
            "end 12; first at -1.5°; second at -1.4°; third at -1.3°; beyond at 9°");
  const json sought = browser().run(
      "plot.svg.dispatchEvent(new PointerEvent('pointerdown', { clientX:"
      " plot.svg.getBoundingClientRect().left + arguments[0] })); return sought",
      x(4.25));
  EXPECT_TRUE(agrees(sought, json::array({4.25}), 0.02));

  // Again, with other series: fewer of them, and constant.
  browser().run("plot.update([{ name: 'flat', times: [1, 2], values: [4, 4] }], 'Other', 'm')");
  EXPECT_EQ(browser().run("return plot.caption.textContent"), "Other, mflat 4.000");
  const json flat = points_of(browser(), "#plots path");
  ASSERT_EQ(flat.size(), 2U);
  EXPECT_NEAR(flat[0][2].get<double>(), 6.0 + 0.5 * 78.0, kPixel) << "in the middle";
  EXPECT_NEAR(flat[1][1].get<double>(), width - 16.0, kPixel);
  browser().run("plot.update([{ name: 'none', times: [1], values: [NaN] }])");
  EXPECT_EQ(browser().run("return [plot.figure.className, plot.caption.textContent]"),
            json({"empty", "Other, mnot recorded"}));
}

TEST_F(PageValues, OfStackedLoadsAreDrawnAtTheirPlaces) {
  // The values of three parts over four rows, of which the third is not known.
  const json drawn = browser().run(R"(
    const times = [0, 1, 2, 3];
    const stack = new StackPlot(document.getElementById('plots'), { title: 'Loads', unit: 'N', series: [
      { part: 'buoyancy', name: 'a', times, values: [4, -2, NaN, 3] }, { part: 'drag', name: 'b', times, values: [1, -1, NaN, 2] },
      { part: 'weight', name: 'c', times, values: [-6, 5, NaN, -1] }, { part: 'sum', name: 'sum', times, values: [-1, 2, NaN, 4] }] });
    const { low, high } = stack.range();
    return { low, high, bands: stack.bands().map(({ positive, negative }) => [...positive, ...negative].map((edge) => [...edge])),
             areas: [...stack.svg.querySelectorAll('.area')].map((path) => [path.getAttribute('class'), path.getAttribute('d')]) };)");
  EXPECT_EQ(drawn["low"], -6);
  EXPECT_EQ(drawn["high"], 5);
  const json none = std::nan("");
  EXPECT_TRUE(
      agrees(drawn["bands"],
             json::array({json::array({{0, 0, 0, 0}, {4, 0, 0, 3}, {0, -2, none, 0}, {0, 0, 0, 0}}),
                          json::array({{4, 0, 0, 3}, {5, 0, 0, 5}, {0, -3, none, 0}, {0, -2, none, 0}}),
                          json::array({{5, 0, 0, 5}, {5, 5, 0, 5}, {-6, -3, none, -1}, {0, -3, none, 0}})})));
  const auto width =
      browser().run("return document.querySelector('#plots figure').clientWidth").get<double>();
  const auto y = [](double value) {
    return 6.0 + (-0.5 + 1.08 * 5.5 - value) / (2.0 * 1.08 * 5.5) * (190.0 - 26.0);
  };
  // The second part: above zero in rows 0 and 1 and in row 3, along its upper and back along its lower
  // edge.
  const json points = points_of(browser(), ".area.drag.positive");
  ASSERT_EQ(points.size(), 6U);
  const std::array<std::array<double, 2>, 6> expected{{{0, 5}, {1, 0}, {1, 0}, {0, 4}, {3, 5}, {3, 3}}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(points[i][1].get<double>(), 58.0 + expected[i][0] / 3.0 * (width - 74.0), kPixel) << i;
    EXPECT_NEAR(points[i][2].get<double>(), y(expected[i][1]), kPixel) << i;
  }
}

// ---- The sea

const std::string kTilted = "[world]\nup = [0.36, 0.48, 0.8]\ngravity = 9.7\n";
const Vec3 kUp(0.36, 0.48, 0.8);

// Waves from short beside the lines of a grid to long, across the axes, in a sea of finite depth.
const std::string kWaves = R"([water]
density = 1012
level = 1.75
depth = 40
ramp = 20.0
[[water.waves]]
type = "regular"
height = 0.3
period = 1.3
direction = 20.0
phase = 30.0
[[water.waves]]
type = "regular"
height = 0.7
period = 2.9
direction = -70.0
[[water.waves]]
type = "regular"
height = 0.5
period = 3.4
direction = 160.0
phase = -50.0
[[water.waves]]
type = "regular"
height = 1.1
period = 7.0
direction = 35.0
[[water.waves]]
type = "regular"
height = 0.9
period = 9.0
direction = -110.0
phase = 75.0
)";
const std::string kBodies = R"(
[[body]]
id = 4
shape = { type = "box", size = [2, 3, 5], segments = [2, 2, 2] }
reference_point = [0.5, -0.25, 1]
outputs = ["wrench", "loads"]
[body.drag]
quadratic = [18, 22, 37, 1.5, 1.5, 1.5]
center = [0.4, -0.3, 0.7]
[body.client]
mass = 9000
center_of_mass = [0.3, -0.2, 0.9]
[[body]]
id = 9
shape = { type = "rock", frequency = 2 }
)";

// What a grid of lines draws of a wave, by its wave number times their distance.
double shown_share(double radians) {
  const double x = std::clamp((2.0 * std::numbers::pi / radians - 2.5) / 1.5, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

TEST_F(PageValues, OfTheSeaAreThoseOfTheService) {
  const Scene scene = scene_of(kTilted + kWaves + kBodies);
  const Sea& sea = *scene.sea();
  browser().run("window.sea = new Sea(arguments[0])", json(sea_json(sea)));
  std::vector<std::array<double, 3>> places;  // and times
  json elevations = json::array();
  for (const double t : {-1.0, 0.0, 7.5, 19.99, 20.0, 1234.5}) {
    SeaSnapshot snapshot(sea, static_cast<std::int64_t>(std::llround(1e6 * t)));
    for (const auto& [x1, x2] : {std::pair{0.0, 0.0}, {37.25, -81.5}, {-4e4, 9e3}}) {
      places.push_back({x1, x2, t});
      elevations.push_back(snapshot.elevation(x1, x2));
    }
  }
  EXPECT_TRUE(
      agrees(browser().run("return arguments[0].map(([x1, x2, t]) => sea.elevation(x1, x2, t))", places),
             elevations, 1e-7));
  EXPECT_TRUE(agrees(browser().run("return sea.significant_wave_height()"), sea.significant_wave_height()));
  // The energies are as 0.09, 0.49, 0.25, 1.21 and 0.81: the shortest waves hold more than 2 % of it.
  EXPECT_TRUE(agrees(browser().run("return sea.largest_relevant_wave_number()"), sea.max_wave_number()));
  EXPECT_TRUE(agrees(
      browser().run("return new Sea({ ...arguments[0], amplitude: [0.02, 0.5, 1], wave_number: [9, 3, 1] })"
                    ".largest_relevant_wave_number()",
                    json(sea_json(sea))),
      3));

  // A grid of unequal lines about an anchor.
  const std::vector<double> lines{-9, -4, -1.5, 0, 1.5, 4, 9};
  constexpr double kAnchor1 = 13.5;
  constexpr double kAnchor2 = -410.25;
  constexpr double kTime = 12.0;
  SeaSnapshot snapshot(sea, 12'000'000);
  const auto gap = [&](std::size_t m) {
    return std::max(m > 0 ? lines[m] - lines[m - 1] : 0.0,
                    m + 1 < lines.size() ? lines[m + 1] - lines[m] : 0.0);
  };
  json expected = json::array();
  std::vector<double> phases;
  int partly = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    for (std::size_t m = 0; m < lines.size(); ++m) {
      snapshot.phases_at(kAnchor1 + lines[m], kAnchor2 + lines[n], phases);
      double sum = 0.0;
      for (std::size_t i = 0; i < phases.size(); ++i) {
        const double k = sea.prepared().wave_number[i];
        const double share = shown_share(k * gap(m)) * shown_share(k * gap(n));
        partly += share > 0.01 && share < 0.99 ? 1 : 0;
        sum += share * sea.prepared().amplitude[i] * std::cos(phases[i]);
      }
      expected.push_back(snapshot.amplitude_factor() * sum);
    }
  }
  ASSERT_GT(partly, 10);
  EXPECT_TRUE(agrees(browser().run("window.grid = new SeaGrid(sea, arguments[0].length);"
                                   "grid.place_lines(arguments[0]);"
                                   "grid.evaluate(arguments[1], arguments[2], arguments[3]);"
                                   "return [...grid.elevation];",
                                   lines, kAnchor1, kAnchor2, kTime),
                     expected, kFloat));
}

// Between the lines, the surface consists of triangles.
TEST_F(PageValues, OfElevationsBetweenTheLinesAreThoseDrawn) {
  const std::vector<double> lines{-9, -4, -1.5, 0, 1.5, 4, 9};
  const std::size_t count = lines.size();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<double> heights(count * count);
  for (double& height : heights) height = number(random);
  std::vector<std::array<double, 2>> places{{-30.0, 2.0}, {2.0, 30.0}, {0.0, 0.0}, {9.0, -9.0}};
  for (int i = 0; i < 200; ++i) places.push_back({9.0 * number(random), 9.0 * number(random)});
  json expected = json::array();
  for (const auto& [u, v] : places) {
    const auto line = [&](double at) {
      std::size_t m = 0;
      while (m + 2 < count && lines[m + 1] <= at) ++m;
      return m;
    };
    const std::size_t m = line(u);
    const std::size_t n = line(v);
    const auto corner = [&](std::size_t i, std::size_t k) {
      return Vec3(lines[m + i], lines[n + k], heights[(n + k) * count + m + i]);
    };
    const double a = (std::clamp(u, -9.0, 9.0) - lines[m]) / (lines[m + 1] - lines[m]);
    const double b = (std::clamp(v, -9.0, 9.0) - lines[n]) / (lines[n + 1] - lines[n]);
    const Vec3 origin = a + b <= 1.0 ? corner(0, 0) : corner(1, 1);
    const Vec3 normal = (corner(1, 0) - origin).cross(corner(0, 1) - origin);
    const double du = std::clamp(u, -9.0, 9.0) - origin.x();
    const double dv = std::clamp(v, -9.0, 9.0) - origin.y();
    expected.push_back(origin.z() - (normal.x() * du + normal.y() * dv) / normal.z());
  }
  EXPECT_TRUE(agrees(browser().run("const still = { amplitude: [], apparent_frequency: [], wave_number: "
                                   "[], k1: [], k2: [], phase: [] };"
                                   "const grid = new SeaGrid(new Sea(still), arguments[0].length);"
                                   "grid.place_lines(arguments[0]); grid.elevation.set(arguments[1]);"
                                   "return arguments[2].map(([u, v]) => grid.drawn_elevation(u, v))",
                                   lines, heights, places),
                     expected, kFloat));
}

// ---- The picture

class PictureValues : public PageValues {
 protected:
  void SetUp() override {
    PageValues::SetUp();
    browser().run("window.scene = make_water_scene(document.getElementById('canvas'), arguments[0])",
                  json(scene_model(scene_)));
  }
  // Shows the bodies, looks at one, and draws.
  void show(const json& states, const json& followed, const json& sea_time = nullptr) {
    browser().run(
        "scene.show(arguments[0], arguments[2] === null ? NaN : arguments[2]); "
        "scene.follow(arguments[1]);"
        "scene.render(640, 400); scene.scene.updateMatrixWorld(true);",
        states, followed, sea_time);
  }
  static json state(std::int32_t id, const Pose& pose) {
    const Eigen::Quaterniond& q = pose.q_WB;
    return {{"id", id},
            {"status", 0},
            {"p", json_of(pose.p_WB)},
            {"q", {q.w(), q.x(), q.y(), q.z()}},
            {"f", json_of(kForce)},
            {"b", json_of(kBuoyancyAt)},
            {"m", {json_of(kMetacentre), json_of(Vec3::Zero())}},
            {"loads",
             {{"immersion", 0.25},
              {"buoyancy", {9e4, -7e4, 8e4, 1, 2, 3}},
              {"drag", {2e4, 3e4, -1e4, 4, 5, 6}},
              {"added_mass", {1e6, 1e6, 1e6, 7, 8, 9}},
              {"water_velocity", json_of(kVelocity)}}}};
  }
  static json vertices(std::int32_t id) { return vertices_in_W(browser(), id); }
  static json marker(std::int32_t id, const std::string& name) { return marker_in_W(browser(), id, name); }

  static inline const Vec3 kForce{1e5, -5e4, 6e4};
  static inline const Vec3 kBuoyancyAt{0.4, -0.7, -1.1};
  static inline const Vec3 kMetacentre{-0.3, 0.2, 1.3};
  static inline const Vec3 kVelocity{0.6, 0.9, -0.4};
  const Scene scene_ = scene_of(kTilted + "[water]\ndensity = 1012\nlevel = 1.75\n" + kBodies);
  const Pose first_{Vec3(3200.5, -1700.25, -417.0), Eigen::Quaterniond(0.5, -0.1, 0.7, 0.5).normalized()};
  const Pose second_{Vec3(3190.0, -1695.0, -416.0), Eigen::Quaterniond(-0.2, 0.4, 0.1, 0.9).normalized()};
};

TEST_F(PictureValues, OfBodiesAndMarkersAreThoseOfTheStates) {
  constexpr double kPlaces = 1e-8;  // relative, beside kilometres: a few micrometres
  const Body& body = scene_.bodies()[0];
  const double size = body.solver.mesh().diagonal;
  const double weight_of_water = 1012.0 * 9.7 * body.solver.mesh().volume;
  const auto expect_drawn = [&](const Pose& pose, const Pose& other) {
    show({state(4, pose), state(9, other)}, 4);
    for (const auto& [index, at] : {std::pair{std::size_t{0}, pose}, {std::size_t{1}, other}}) {
      const HydrostaticMesh& mesh = scene_.bodies()[index].solver.mesh();
      json expected = json::array();
      for (std::size_t i = 0; i < mesh.surface.vertex_count(); ++i) {
        const Vec3 in_B = mesh.center_B + mesh.vertex(static_cast<std::int32_t>(i));
        expected.push_back(json_of(at.p_WB + at.q_WB * in_B));
      }
      EXPECT_TRUE(agrees(vertices(scene_.bodies()[index].id), expected, kPlaces)) << index;
    }
    const auto arrow = [](const Vec3& from, const Vec3& along) {
      return json::array({json_of(from), json_of(from + along)});
    };
    const double per_newton = 0.9 * size / weight_of_water;
    const Vec3 mass_at = pose.p_WB + pose.q_WB * Vec3(0.3, -0.2, 0.9);
    EXPECT_TRUE(agrees(marker(4, "centre_of_buoyancy"), json_of(pose.p_WB + kBuoyancyAt), kPlaces));
    EXPECT_TRUE(agrees(marker(4, "metacentre"), json_of(pose.p_WB + kMetacentre), kPlaces));
    EXPECT_TRUE(agrees(marker(4, "centre_of_mass"), json_of(mass_at), kPlaces));
    EXPECT_TRUE(agrees(marker(4, "force"), arrow(pose.p_WB + kBuoyancyAt, per_newton * Vec3(9e4, -7e4, 8e4)),
                       kPlaces));
    EXPECT_TRUE(agrees(marker(4, "weight"), arrow(mass_at, -per_newton * 9000.0 * 9.7 * kUp), kPlaces));
    EXPECT_TRUE(
        agrees(marker(4, "drag"),
               arrow(pose.p_WB + pose.q_WB * Vec3(0.4, -0.3, 0.7), 5.0 * per_newton * Vec3(2e4, 3e4, -1e4)),
               kPlaces));
    EXPECT_TRUE(agrees(marker(4, "water_velocity"),
                       arrow(pose.p_WB + 0.6 * size * kUp, 0.5 * size * kVelocity), kPlaces));
    EXPECT_EQ(marker(9, "centre_of_mass"), nullptr) << "not known of body 9";
  };
  expect_drawn(first_, second_);
  expect_drawn(second_, first_);  // about the origin of the first time

  // Without parts of the force the arrow is that of the whole, at the origin where its centre is not
  // known.
  json plain = state(4, first_);
  plain.erase("loads");
  plain["b"] = nullptr;
  show(json::array({plain}), 4);
  EXPECT_TRUE(agrees(
      marker(4, "force"),
      json::array({json_of(first_.p_WB), json_of(first_.p_WB + 0.9 * size / weight_of_water * kForce)}),
      kPlaces));
  for (const char* name : {"centre_of_buoyancy", "drag", "water_velocity"})
    EXPECT_EQ(marker(4, name), nullptr) << name;
  plain["status"] = 6;
  show(json::array({plain}), 4);
  EXPECT_EQ(marker(4, "force"), nullptr);
  plain["q"] = {0, 0, 0, 0};
  show(json::array({plain}), 4);
  for (const char* name : {"force", "weight", "centre_of_mass", "metacentre"})
    EXPECT_EQ(marker(4, name), nullptr) << name;
  show(json::array({state(4, first_)}), 4);
  EXPECT_NE(marker(4, "weight"), nullptr) << "again, after an invalid pose";
}

TEST_F(PictureValues, OfTheCameraProjectPointsToTheirPixels) {
  show({state(4, first_), state(9, second_)}, 4);
  const double size = scene_.bodies()[0].solver.mesh().diagonal;
  const HorizontalAxes axes = horizontal_axes(kUp);
  const Vec3 on_water = first_.p_WB - (kUp.dot(first_.p_WB) - 1.75) * kUp;
  constexpr double kAzimuth = -0.7;
  constexpr double kElevation = 0.4;
  browser().run("scene.azimuth = arguments[0]; scene.elevation = arguments[1]; scene.render()", kAzimuth,
                kElevation);
  const Vec3 back = std::cos(kElevation) * (std::cos(kAzimuth) * axes.e1_W + std::sin(kAzimuth) * axes.e2_W) +
                    std::sin(kElevation) * kUp;
  const double distance = 2.5 * size;
  const Vec3 camera = on_water + distance * back;
  const Vec3 right = (-back).cross(kUp).normalized();
  const double slope = std::tan(20.0 * std::numbers::pi / 180.0);  // of half the picture's height
  std::vector<json> points;
  json expected = json::array();
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(1.5, -0.5, 2), Vec3(-2, 1, -1), Vec3(0.5, 3, 0.25)}) {
    const Vec3 from_camera = first_.p_WB + offset - camera;
    const double depth = -from_camera.dot(back);
    const double scale = 0.5 * kHeight / (slope * depth);
    points.emplace_back(json_of(first_.p_WB + offset));
    expected.push_back({0.5 * kWidth + scale * from_camera.dot(right),
                        0.5 * kHeight - scale * from_camera.dot(right.cross(-back))});
  }
  EXPECT_TRUE(agrees(browser().run("return arguments[0].map((point) => scene.project(point))", points),
                     expected, 1e-4));
  EXPECT_TRUE(agrees(browser().run("return scene.distance"), distance, kFloat));
  const double depth = (camera - first_.p_WB - kBuoyancyAt).dot(back);
  EXPECT_TRUE(agrees(browser().run("return scene.bodies.get(4).markers.centre_of_buoyancy.scale.x"),
                     std::min(0.01 * size, 2.0 * slope / kHeight * depth), kFloat));
  // The cells of the grid on the water, which stay in place when the camera moves.
  const double cell = std::pow(10.0, std::round(std::log10(0.3 * size)));
  EXPECT_TRUE(agrees(browser().run("return scene.grid_cell.value"), cell));
  EXPECT_TRUE(
      agrees(browser().run("const { water, level_x, level_y, up } = scene; return [level_x, level_y, up].map("
                           "(axis) => water.position.dot(axis) / scene.grid_cell.value)"),
             browser().run("const { target, level_x, level_y } = scene; return [...[level_x, level_y].map("
                           "(axis) => Math.round(target.dot(axis) / scene.grid_cell.value)), 0]"),
             1e-6));
  // All: the middle of both, and far enough for the outer one.
  show({state(4, first_), state(9, second_)}, nullptr);
  const Vec3 middle = 0.5 * (first_.p_WB + second_.p_WB);
  EXPECT_TRUE(agrees(browser().run("return scene.target.toArray().map((x, k) => x + scene.origin[k])"),
                     json_of(middle - (kUp.dot(middle) - 1.75) * kUp), 1e-8));
  // Limits.
  const json limits = browser().run(R"(
    const of = (change, name) => { change(); return scene[name]; };
    return [of(() => scene.rotate(0.25, 9), 'elevation'), of(() => scene.rotate(0, -9), 'elevation'),
            of(() => scene.zoom(1e-9), 'distance') / scene.subject, of(() => scene.zoom(1e9), 'distance') / scene.size, scene.azimuth];)");
  EXPECT_TRUE(agrees(limits, {1.5, -1.2, 0.3, 500.0, kAzimuth + 0.25}));
  // From then on, the zoom is relative to the subject.
  const auto zoomed = browser().run("return scene.distance / scene.subject").get<double>();
  show({state(4, first_), state(9, second_)}, 9);
  EXPECT_TRUE(agrees(browser().run("return scene.distance / scene.subject"), zoomed, kFloat));
}

TEST_F(PictureValues, OfWavesAreThoseOfTheSeaAtTheVertices) {
  constexpr double kTime = 12.5;
  // Of long waves only, which the grid shows all.
  const std::string long_waves =
      kWaves.substr(0, kWaves.find("[[water.waves]]")) +
      kWaves.substr(kWaves.find("[[water.waves]]\ntype = \"regular\"\nheight = 1.1"));
  const Scene scene = scene_of(kTilted + long_waves + kBodies);
  SeaSnapshot snapshot(*scene.sea(), static_cast<std::int64_t>(1e6 * kTime));
  browser().run("scene.use_sea(new Sea(arguments[0]))", json(sea_json(*scene.sea())));
  // Half submerged, where the water is.
  Pose pose = first_;
  pose.p_WB -= (kUp.dot(pose.p_WB) - 1.75) * kUp;
  show(json::array({state(4, pose)}), 4);
  EXPECT_EQ(browser().run("return [scene.waves.surface.visible, scene.water.visible]"), json({false, true}))
      << "at an unknown time";
  for (const Vec3& moved : {Vec3(0, 0, 0), Vec3(7.25, -3.5, 1.0)}) {
    pose.p_WB += moved;
    show(json::array({state(4, pose)}), 4, kTime);
    const json drawn = browser().run(R"(
      const { surface, grid } = scene.waves, { position, water } = surface.geometry.attributes, { lines } = grid;
      const near = [];
      for (let n = 1; n + 1 < lines; n += 1) {
        for (let m = 1; m + 1 < lines; m += 1) {
          const at = n * lines + m;
          if (Math.max(Math.abs(position.getX(at)), Math.abs(position.getY(at))) > 4) continue;
          const vertex = surface.localToWorld(new THREE.Vector3(position.getX(at), position.getY(at), water.getX(at)));
          near.push([...vertex.toArray().map((x, i) => x + scene.origin[i]), water.getY(at), water.getZ(at)]);
        }
      }
      const { drawn } = scene.bodies.get(4), { height_over_water } = drawn.geometry.attributes;
      return { near, heights: [...height_over_water.array], spacing: scene.waves.spacing };)");
    ASSERT_GT(drawn["near"].size(), 50U);
    const auto elevation = [&](const Vec3& at) {
      const HorizontalAxes& axes = scene.sea()->axes();
      return snapshot.elevation(axes.e1_W.dot(at), axes.e2_W.dot(at));
    };
    constexpr double kStep = 0.01;
    for (const json& vertex : drawn["near"]) {
      const Vec3 at(vertex[0].get<double>(), vertex[1].get<double>(), vertex[2].get<double>());
      ASSERT_NEAR(kUp.dot(at) - 1.75, elevation(at), 1e-3);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const Vec3 step = kStep * (axis == 0 ? scene.sea()->axes().e1_W : scene.sea()->axes().e2_W);
        ASSERT_NEAR(vertex[3 + axis].get<double>(),
                    (elevation(at + step) - elevation(at - step)) / (2 * kStep), 2e-3);
      }
    }
    // The heights of the hull's vertices, from which its shader takes what is wet.
    const json hull = vertices(4);
    ASSERT_EQ(hull.size(), drawn["heights"].size());
    double lowest = 0.0;
    double highest = 0.0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vec3 at(hull[i][0].get<double>(), hull[i][1].get<double>(), hull[i][2].get<double>());
      const auto height = drawn["heights"][i].get<double>();
      ASSERT_NEAR(height, kUp.dot(at) - 1.75 - elevation(at), 2e-3) << i;
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    EXPECT_LT(lowest, -0.5);
    EXPECT_GT(highest, 0.5);
  }
  browser().run("scene.use_sea(null); scene.render()");
  EXPECT_EQ(browser().run("return [scene.water.visible, scene.bodies.get(4).drawn.geometry ==="
                          " scene.geometries[0]]"),
            json({true, true}));
}

TEST_F(PictureValues, OfLoadsAreTheirPartsAlongEveryAxis) {
  const json shown = state(4, first_);
  json loads = shown["loads"];
  loads["q"] = shown["q"];
  browser().run(
      "window.loads = new LoadPlots(document.getElementById('plots'), null, arguments[0]);"
      "loads.update(arguments[0].bodies[0], [0, 1], (n) => (n === 0 ? arguments[1] : null))",
      json(scene_model(scene_)), loads);
  const HorizontalAxes axes = horizontal_axes(kUp);
  const Vec3 weight = -9000.0 * 9.7 * kUp;
  const Vec3 arm = first_.q_WB * (Vec3(0.3, -0.2, 0.9) - Vec3(0.5, -0.25, 1.0));
  const Vec3 of_weight = arm.cross(weight);
  const auto part = [&](const char* name, std::size_t first, const Vec3& axis) {
    return Vec3(loads[name][first].get<double>(), loads[name][first + 1].get<double>(),
                loads[name][first + 2].get<double>())
        .dot(axis);
  };
  for (int option = 0; option < 6; ++option) {
    const Vec3 axis = std::array{kUp, axes.e1_W, axes.e2_W}.at(static_cast<std::size_t>(option % 3));
    const std::size_t first = option < 3 ? 0 : 3;
    const double buoyancy = part("buoyancy", first, axis);
    const double drag = part("drag", first, axis);
    const double down = (option < 3 ? weight : of_weight).dot(axis);
    const json series = browser().run(
        "loads.choice.selectedIndex = arguments[0]; loads.choice.dispatchEvent(new Event('change'));"
        "return loads.stack.series.map(({ name, values }) => [name, ...values])",
        option);
    EXPECT_TRUE(agrees(series,
                       json::array({{"buoyancy", buoyancy, std::nan("")},
                                    {"drag", drag, std::nan("")},
                                    {"weight", down, std::nan("")},
                                    {"sum", buoyancy + drag + down, std::nan("")}}),
                       1e-9))
        << option;
  }
  EXPECT_EQ(browser().run("return [loads.stack.unit, loads.immersion.series[0].values[0]]"),
            json({"N m", 25.0}));
  EXPECT_EQ(
      browser().run("const { range } = loads.immersion; const { low, high } = range.call(loads.immersion);"
                    "return [low, high]"),
      json({0, 100}));
}

TEST_F(PictureValues, OfRefinedHullsEncloseTheSameVolume) {
  const json refined = browser().run(R"(
    const { position } = scene.geometries[0].attributes, { array: index } = scene.geometries[0].index;
    const volume = (p, indices) => {
      let sum = 0;
      for (let at = 0; at < indices.length; at += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => new THREE.Vector3(...p.slice(3 * indices[at + k], 3 * indices[at + k] + 3)));
        sum += a.dot(b.cross(c)) / 6;
      }
      return sum;
    };
    const longest = (p, indices) => {
      let edge = 0;
      for (let at = 0; at < indices.length; at += 3) {
        const corner = (k) => Array.from(p.slice(3 * indices[at + k % 3], 3 * indices[at + k % 3] + 3));
        for (const k of [0, 1, 2]) edge = Math.max(edge, distance_of(corner(k), corner(k + 1)));
      }
      return edge;
    };
    return [[0.5, 1e6], [0.5, 500], [99, 1e6]].map(([edge, added]) => {
      const { positions, indices } = refined_triangles(position.array, index, edge, added);
      return [volume(positions, indices), longest(positions, indices), indices.length / 3];
    });)");
  const auto triangles = static_cast<double>(scene_.bodies()[0].solver.mesh().surface.triangles.size());
  for (const json& one : refined) EXPECT_TRUE(agrees(one[0], 30.0, kFloat));
  EXPECT_LE(refined[0][1].get<double>(), 0.5 + kFloat);
  EXPECT_GT(refined[0][1].get<double>(), 0.2);
  EXPECT_LE(refined[1][2].get<double>(), triangles + 500.0);
  EXPECT_GT(refined[1][2].get<double>(), triangles + 100.0);
  EXPECT_EQ(refined[2][2].get<double>(), triangles) << "as they are";
  // Gaps that grow by a factor reach as far as asked.
  const auto growth = browser().run("return growth_to_reach(300, 12)").get<double>();
  double reach = 0.0;
  for (int i = 1; i <= 12; ++i) reach += std::pow(growth, i);
  EXPECT_NEAR(reach, 300.0, 1e-6);
}

}  // namespace
}  // namespace buoyancy::view
