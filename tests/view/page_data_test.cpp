// What the pages of runs, of the bus, of hydrostatics and of meshes show of their data, number by number: the
// data are made here, with the water tilted, and no two numbers equal.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "hydrostatics/hydrostatics.h"
#include "scene/scene.h"
#include "tests/support/contains.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"
#include "tests/view/page_test.h"
#include "tests/view/page_values.h"
#include "view/common/scene_model.h"
#include "view/live/live_page.h"
#include "view/page/base64.h"
#include "view/report/report_page.h"

namespace buoyancy::view {
namespace {

using nlohmann::json;

const Vec3 kUp(0.36, 0.48, 0.8);
const std::string kScene = R"([world]
up = [0.36, 0.48, 0.8]
gravity = 9.7
[water]
density = 1012
level = 1.75
[[body]]
id = 4
name = "hull"
shape = { type = "box", size = [2, 3, 5], segments = [2, 2, 2] }
outputs = ["wrench", "hydrostatics"]
[body.client]
mass = 9000
center_of_mass = [0.3, -0.2, 0.9]
[[body]]
id = 9
name = "rock"
shape = { type = "rock", frequency = 2 }
)";

class PageData : public PageTest {
 protected:
  void open(const std::string& page, const std::string& ready) {
    browser().open_file(directory_.write("page.html", page));
    browser().wait_until(ready);
  }

  TempDir directory_;
};

// ---- A recorded run

class ReportData : public PageData {
 protected:
  static constexpr std::size_t kRows = 5;
  static constexpr std::array<double, kRows> kTimes{0.0, 0.5, 2.0, 2.25, 4.0};
  static constexpr std::size_t kFailed = 3;  // a row whose response is not OK

  // Any two quaternions in succession are of opposite sign.
  static Eigen::Quaterniond attitude_of(std::size_t row) {
    const auto t = static_cast<double>(row);
    const Eigen::Quaterniond q(1.0 - 0.1 * t, 0.3 + 0.05 * t, -0.2 + 0.15 * t, 0.4 - 0.02 * t);
    return Eigen::Quaterniond((row % 2 == 0 ? 1.0 : -1.0) * q.normalized().coeffs());
  }
  static Vec3 place_of(std::size_t row) {
    const auto t = static_cast<double>(row);
    return (1.75 + 0.3 * t) * kUp + Vec3(0.8, -0.6, 0.0) * (3.0 + t * t);
  }
  static RunRow row_of(std::size_t row) {
    RunRow values{};
    for (std::size_t column = 0; column < kColumnCount; ++column) {
      values[column] = 1000.0 * static_cast<double>(column + 1) + 7.0 * static_cast<double>(row);
    }
    const Eigen::Quaterniond q = attitude_of(row);
    const Vec3 p = place_of(row);
    std::ranges::copy(std::array{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}, values.begin() + kPx);
    values[kTime] = kTimes[row];
    values[kStatus] = row == kFailed ? 6.0 : 0.0;
    values[kRoundTrip] = 1e-3 * static_cast<double>(row + 1);
    return values;
  }
  RecordedRun run() const {
    RecordedRun run;
    run.bodies.resize(2);
    BodyRun& body = run.bodies[0];
    body.recorded = 12;
    body.shown = true;
    body.statuses[0] = 7;
    body.statuses[6] = 3;
    body.statuses[kBodyStatusCount] = 1;
    body.max_force = 1234.5;
    for (std::size_t row = 0; row < kRows; ++row) body.rows.push_back(row_of(row));
    BodyRun& other = run.bodies[1];
    other.recorded = 1;
    other.shown = true;
    other.rows = {row_of(2)};
    other.rows[0][kTime] = 0.0;
    run.sessions = 3;
    run.computed = 2;
    run.unknown_bodies = 21;
    run.warnings = {"line 8"};
    run.suppressed_warnings = 31;
    ServiceStatus status;
    status.version = "9.8.7";
    status.uptime = 1234.5;
    status.counters.requests = 1001;
    status.counters.computed = 1002;
    status.counters.retries = 1003;
    status.counters.superseded = 1004;
    status.counters.rejected_count = 1005;
    status.counters.bodies_dry = 1006;
    status.counters.bodies_wet = 1007;
    status.counters.bodies_crossing = 1008;
    status.counters.bodies_unchanged = 1009;
    status.latency = {.p50 = 1e-5, .p99 = 2e-5, .p999 = 3e-5, .max = 4e-5};
    run.status = status;
    return run;
  }
  void SetUp() override {
    PageTest::SetUp();
    json data = parse_json(report_data(scene_, run(), {.file = "run.csv", .version = "1"}));
    data["bodies"][0]["evaluations"] = {{"unchanged", 10}, {"dry", 20},       {"wet", 30},
                                        {"crossing", 40},  {"rejected", 100}, {"bounds_ns", 50},
                                        {"query_ns", 2000}};
    open(report_page(data.dump(), three_js().value()), "window.buoyancy_report !== undefined");
    browser().run("window.scene = buoyancy_report.scene");
  }

  const Scene scene_ = scene_of(kScene);
};

TEST_F(ReportData, IsInterpolatedBetweenTheRows) {
  const Body& body = scene_.bodies()[0];
  for (const double when : {-1.0, 0.0, 0.2, 0.5, 1.1, 1.99, 2.0, 2.2, 3.0, 3.7, 4.0, 9.0}) {
    SCOPED_TRACE(when);
    std::size_t row = 0;
    while (row + 1 < kRows && kTimes[row + 1] <= when) ++row;
    const std::size_t next = std::min(row + 1, kRows - 1);
    const double span = kTimes[next] - kTimes[row];
    const double share = span > 0.0 ? std::clamp((when - kTimes[row]) / span, 0.0, 1.0) : 0.0;
    const Vec3 p = (1.0 - share) * place_of(row) + share * place_of(next);
    // q and -q are the same rotation: the shorter way round.
    const Eigen::Vector4d from = attitude_of(row).coeffs();
    const Eigen::Vector4d to = attitude_of(next).coeffs();
    const Eigen::Quaterniond q(
        Eigen::Vector4d((1.0 - share) * from + (from.dot(to) < 0.0 ? -share : share) * to).normalized());
    const RunRow values = row_of(row);
    const auto part = [&](RunColumn first) {
      return json({values[first], values[first + 1], values[first + 2]});
    };
    const json shown = browser().run(
        "const { body_at, bodies } = buoyancy_report; buoyancy_report.seek(arguments[0]);"
        "const { p, q, f, t, b, m, status, id } = body_at(bodies[0], arguments[0]);"
        "const norm = Math.hypot(...q); return [p, q.map((x) => x / norm), f, t, b, m, status, id];",
        when);
    EXPECT_TRUE(agrees(shown[0], json_of(p)));
    const Eigen::Quaterniond turned(shown[1][0].get<double>(), shown[1][1].get<double>(),
                                    shown[1][2].get<double>(), shown[1][3].get<double>());
    EXPECT_NEAR(std::abs(turned.dot(q)), 1.0, 1e-12);
    EXPECT_TRUE(agrees(shown[2], part(kFx)));
    EXPECT_TRUE(agrees(shown[3], part(kTx)));
    EXPECT_TRUE(agrees(shown[4], part(kBx)));
    EXPECT_EQ(shown[6], values[kStatus]);
    EXPECT_EQ(shown[7], 4);
    const Pose pose{place_of(row), attitude_of(row)};
    const Hydrostatics floats = row == kFailed ? Hydrostatics{}
                                               : hydrostatics(body.solver.mesh(), pose, scene_.water(),
                                                              body.reference_B, body.center_of_mass_B)
                                                     .value();
    EXPECT_TRUE(agrees(shown[5], {json_of(floats.metacenters_W[0]), json_of(floats.metacenters_W[1])}, 1e-6));
    // What is drawn of it, at the time that is shown: the run's end.
    const json centre = browser().run(
        "const { group } = scene.bodies.get(4); return group.position.toArray().map((x, k) => x + "
        "scene.origin[k])");
    EXPECT_TRUE(agrees(centre, json_of(p), 1e-9));
    const json corner = vertices_in_W(browser(), 4)[0];
    const HydrostaticMesh& mesh = body.solver.mesh();
    EXPECT_TRUE(agrees(corner, json_of(p + q * (mesh.center_B + mesh.vertex(0))), 1e-6));
    std::array<char, 16> clock{};
    std::snprintf(clock.data(), clock.size(), "%.3f s", std::clamp(when, 0.0, 4.0));
    EXPECT_EQ(text_of("#clock"), clock.data());
    EXPECT_EQ(text_of("#status"), row == kFailed
                                      ? "Body 4 hull: OPEN_EDGE_WET: the mesh is open and its boundary "
                                        "is not entirely dry"
                                      : "Body 4 hull: OK");
  }
}

TEST_F(ReportData, IsPlottedColumnByColumn) {
  struct Series {
    const char* plot;
    const char* name;
    RunColumn column;
    bool of_responses;  // which have no meaning unless their status is OK
    double scale = 1.0;
  };
  for (const Series& one : {Series{"heave", "height of the body's origin above the water", kHeave, false},
                            {"angles", "roll", kRoll, false},
                            {"angles", "pitch", kPitch, false},
                            {"force", "x", kFx, true},
                            {"force", "y", kFy, true},
                            {"force", "z", kFz, true},
                            {"torque", "x", kTx, true},
                            {"torque", "y", kTy, true},
                            {"torque", "z", kTz, true},
                            {"energy", "energy", kEnergy, true},
                            {"round_trip", "request to response", kRoundTrip, false, 1e3}}) {
    json expected = json::array();
    for (std::size_t row = 0; row < kRows; ++row) {
      expected.push_back(one.of_responses && row == kFailed ? std::nan("")
                                                            : one.scale * row_of(row)[one.column]);
    }
    EXPECT_TRUE(
        agrees(browser().run("return [...buoyancy_report.plots[arguments[0]].series.find((one) => one.name"
                             " === arguments[1]).values]",
                             std::string(one.plot), std::string(one.name)),
               expected))
        << one.plot << ' ' << one.name;
  }
  // Steps by row, from a time between two, and by hundredths of the run.
  const auto after = [](const char* key, bool shift, double from) {
    browser().run(
        "buoyancy_report.seek(arguments[2]); document.dispatchEvent(new KeyboardEvent('keydown',"
        " { key: arguments[0], shiftKey: arguments[1] }))",
        std::string(key), shift, from);
    return browser().run("return buoyancy_report.state().time").get<double>();
  };
  EXPECT_EQ(after("ArrowRight", true, 0.7), 2.0);
  EXPECT_EQ(after("ArrowLeft", true, 0.7), 0.0);
  EXPECT_EQ(after("ArrowRight", true, 4.0), 4.0);
  EXPECT_NEAR(after("ArrowRight", false, 0.7), 0.74, 1e-12);
  EXPECT_NEAR(after("ArrowLeft", false, 0.7), 0.66, 1e-12);
}

TEST_F(ReportData, IsThatOfTheSelectedBody) {
  browser().run("buoyancy_report.select(9)");
  EXPECT_TRUE(contains(text_of("#status"), "Body 9 rock: OK"));
  EXPECT_TRUE(agrees(browser().run("return [...buoyancy_report.plots.energy.series[0].values]"),
                     json::array({row_of(2)[kEnergy]})));
  const Vec3 p = place_of(2);
  EXPECT_TRUE(agrees(browser().run("return scene.target.toArray().map((x, k) => x + scene.origin[k])"),
                     json_of(p - (kUp.dot(p) - 1.75) * kUp), 1e-9));
  browser().run("document.dispatchEvent(new KeyboardEvent('keydown', { key: 'n' }))");
  EXPECT_EQ(browser().run("return [buoyancy_report.state().body, document.getElementById('body').value]"),
            json({4, "4"}));
}

TEST_F(ReportData, IsListedCellByCell) {
  EXPECT_EQ(cells_of(browser(), "#tables"), parse_json(R"([
    [["4", "hull", "12", "OK 7, OPEN_EDGE_WET 3, defined by a later version 1, no response recorded 1", "1,235", "yes"],
     ["9", "rock", "1", "no response recorded 1", "–", "yes"]],
    [["4 hull", "partially submerged: computed", "40", "20.0 %", "2.00 µs", "–"],
     ["4 hull", "dry: from the bounds", "20", "10.0 %", "50.0 ns", "39.0 µs"],
     ["4 hull", "fully submerged: from bounds and constants", "30", "15.0 %", "50.0 ns", "58.5 µs"],
     ["4 hull", "unchanged pose: cached result", "10", "5.0 %", "50.0 ns", "19.5 µs"],
     ["4 hull", "invalid pose: rejected", "100", "50.0 %", "–", "–"]],
    [["4 hull", "OK", "4", "80.0 %"],
     ["4 hull", "OPEN_EDGE_WET: the mesh is open and its boundary is not entirely dry", "1", "20.0 %"]],
    [["version", "9.8.7"], ["uptime", "1,235 s"], ["requests", "1,001"], ["computed", "1,002"], ["retries", "1,003"],
     ["superseded", "1,004"], ["rejected", "1,005"],
     ["bodies dry, fully submerged, partially submerged, unchanged", "1,006, 1,007, 1,008, 1,009"],
     ["latency, median, 99 %, maximum", "10.0 µs, 20.0 µs, 40.0 µs"]],
    [["4", "hull", "box", "hierarchical", "0", "9,000", "300"],
     ["9", "rock", "rock", "hierarchical", "0", "1,850", "506"]],
    [["box", "48", "48", "30", "62", "6.164", "1", "closed"],
     ["rock", "80", "80", "3.656", "11.74", "3.515", "1", "closed"]]])"));
  EXPECT_TRUE(contains(text_of("#tables"), "total 117 µs saved, 83.0 µs spent"));
  EXPECT_TRUE(
      contains(text_of("#tables"), "level 1.75 m along [0.36, 0.48, 0.8], 1,012 kg/m³, gravity 9.7 m/s²"));
  EXPECT_EQ(text_of("#subtitle"), "2 bodies, 4 s");
  EXPECT_EQ(
      browser().run("return [...document.querySelectorAll('#notices p')].map((line) => line.textContent)"),
      parse_json(R"([
    "Decimated: the page contains 6 rows of 13. They are unmodified and include the minimum and maximum heave, roll, pitch, force, torque, energy and round trip of every time interval.",
    "2 rows have no recorded response; force and torque were computed from the scene.",
    "The run contains 3 sessions; after a restart of the clock, time continues after the previous rows.",
    "21 rows about bodies that are not in the scene.", "Input error: line 8.", "31 more input errors not shown."])"));
}

// ---- What buoyancy-view sends

class LiveData : public PageData {
 protected:
  void SetUp() override {
    PageTest::SetUp();
    const std::vector<StaticResource> resources = live_page(scene_, "1.2.3", kThreeJs).value();
    const auto resource = [&](const std::string& path) {
      return std::ranges::find(resources, path, &StaticResource::path)->body;
    };
    std::string page = resource("/");
    const std::string server = "window.fetch = async () => ({ ok: true, text: async () => " +
                               json(resource("/model")).dump() +
                               " });"
                               "window.EventSource = class extends EventTarget { constructor() { super(); "
                               "window.events = this; } };";
    for (const auto& [element, script] :
         {std::pair<std::string, std::string>{"<script src=\"three.js\"></script>", resource("/three.js")},
          {"<script src=\"page.js\"></script>", server + resource("/page.js")},
          {"<link rel=\"stylesheet\" href=\"style.css\">", ""},
          {"<link rel=\"stylesheet\" href=\"live.css\">", ""}}) {
      page.replace(page.find(element), element.size(),
                   script.empty() ? "" : "<script>" + script + "</script>");
    }
    open(page, "window.events !== undefined && buoyancyView.scene !== undefined");
    browser().run("window.scene = buoyancyView.scene");
  }

  // A snapshot at a time [s] in which body 4 has this height over the water [m].
  static json snapshot(double listening, double height) {
    return {{"number", 1},
            {"listening", listening},
            {"bodies",
             {{{"id", 4},
               {"status", 0},
               {"p", json_of((1.75 + height) * kUp + Vec3(80, -60, 0))},
               {"q", {0.5, -0.5, 0.5, 0.5}},
               {"f", json_of(1000.0 * height * kUp + Vec3(8, -6, 0))},
               {"t", {21, 22, 23}},
               {"b", {0.4, -0.7, -1.1}},
               {"m", {{-0.3, 0.2, 1.3}, {0, 0, 2}}},
               {"gm", {24, nullptr}},
               {"volume", 25},
               {"force_bound", 26},
               {"torque_bound", 27},
               {"age", 28}}}},
            {"service", "answering"},
            {"services", {"77"}},
            {"status", nullptr},
            {"status_age", 29},
            {"response_age", 30},
            {"request_age", 31},
            {"second", nullptr},
            {"latency", {{"p50", 1}, {"p99", 2}, {"p999", 3}, {"max", 4}}},
            {"counts",
             {{"requests", 101},
              {"requests_repeated", 102},
              {"responses", 103},
              {"responses_repeated", 104},
              {"responses_without_request", 105},
              {"unanswered", 106},
              {"requests_missed", 107},
              {"sessions", 108},
              {"malformed", {{"length", 109}}},
              {"packets_dropped", 110},
              {"fragments_dropped", 111},
              {"services_started", 112},
              {"seas_rejected", 113},
              {"bodies_not_in_scene", 0}}}};
  }
  static json status() {
    json fields{{"version", "9.8.7"},
                {"instance_id", "77"},
                {"mode", "lockstep"},
                {"uptime", 32},
                {"scene", "/some/where/test scene"},
                {"scene_bodies", 2},
                {"injected_faults", ""},
                {"bodies", {{"OK", 201}, {"UNKNOWN_BODY", 202}}},
                {"queue_wait", 0.203},
                {"latency", {{"p50", 0.204}, {"p99", 0.205}, {"p999", 0.206}, {"max", 0.207}}}};
    int number = 300;
    for (const char* name : kCounters) fields[name] = ++number;
    return fields;
  }
  // In the order in which the page lists them.
  static constexpr std::array<const char*, 33> kCounters{"requests",
                                                         "computed",
                                                         "retries",
                                                         "conflicting_retries",
                                                         "stale",
                                                         "superseded",
                                                         "rejected",
                                                         "send_failures",
                                                         "seas_received",
                                                         "seas_rejected",
                                                         "packets_dropped",
                                                         "fragments_dropped",
                                                         "partial_messages_evicted",
                                                         "requests_sliced",
                                                         "outputs_too_large",
                                                         "retained_bytes",
                                                         "replies_evicted",
                                                         "motions_contradicting",
                                                         "quaternions_xyzw",
                                                         "sessions",
                                                         "sessions_evicted",
                                                         "reloads",
                                                         "reloads_failed",
                                                         "bodies_dry",
                                                         "bodies_wet",
                                                         "bodies_unchanged",
                                                         "bodies_crossing",
                                                         "bodies_work_capped",
                                                         "bodies_sea_too_steep",
                                                         "bodies_below_bed",
                                                         "wave_patches",
                                                         "quaternions_normalised",
                                                         "hydrostatics"};

  // Sends snapshots as buoyancy-view does, and shows the last one at once.
  static void send(const std::vector<json>& snapshots) {
    browser().run(
        "for (const one of arguments[0]) events.dispatchEvent(new MessageEvent('message', { data:"
        " JSON.stringify(one) })); buoyancyView.select(buoyancyView.selected)",
        snapshots);
  }
  // What the i-th plot says of its values.
  static std::string label(int plot) {
    return browser()
        .run("return document.querySelectorAll('#plots svg')[arguments[0]].getAttribute('aria-label')", plot)
        .get<std::string>();
  }

  const Scene scene_ = scene_of(kScene);
};

TEST_F(LiveData, IsTrackedUntilTheClockGoesBack) {
  // The force is that along the water's up, the height that over its level. A point comes every 0.1 s.
  send({snapshot(10.0, 0.5), snapshot(10.05, 9.0), snapshot(10.2, 0.25), snapshot(40.0, -1.5),
        snapshot(70.1, 0.75)});
  EXPECT_EQ(label(2),
            "Heave of the body in m over time from -59.9 to 0 s: height of the body's origin above the still "
            "water level from -1.5 to 0.75, "
            "at the end 0.75")
      << "a minute";
  EXPECT_EQ(label(3),
            "Buoyant force on the body in N over time from -59.9 to 0 s: upwards from -1,500 to 750, at the "
            "end 750");
  json failed = snapshot(71.0, 2.0);
  failed["bodies"][0]["status"] = 6;
  send({failed});
  EXPECT_EQ(label(2),
            "Heave of the body in m over time from -31 to 0 s: height of the body's origin above the still "
            "water level from -1.5 to 2, at the "
            "end 2");
  EXPECT_EQ(label(3),
            "Buoyant force on the body in N over time from -31 to 0 s: upwards from -1,500 to 750, at the "
            "end 750")
      << "a status other than OK carries zeros";
  // buoyancy-view starts again, twice.
  for (int start = 0; start < 2; ++start) {
    send({snapshot(3.0, 0.5), snapshot(5.0, 0.125)});
    EXPECT_EQ(label(2),
              "Heave of the body in m over time from -2 to 0 s: height of the body's origin above the still "
              "water level from 0.125 to 0.5, at "
              "the end 0.125");
  }
  // A body that appears later has no points before.
  json more = snapshot(6.0, 0.25);
  more["bodies"].push_back(more["bodies"][0]);
  more["bodies"][1]["id"] = 9;
  send({more});
  browser().run("buoyancyView.select(9)");
  EXPECT_EQ(label(2),
            "Heave of the body in m over time from -3 to 0 s: height of the body's origin above the still "
            "water level from 0.25 to 0.25, at "
            "the end 0.25");
}

TEST_F(LiveData, CountsSecondsUntilTheyStartOver) {
  const auto second = [](int number) {
    return json{{"number", number},           {"requests", 1000 + number},
                {"responses", 2000 + number}, {"unanswered", 3000 + number},
                {"p50", 1e-3 * number},       {"p99", 2e-3 * number},
                {"max", 3e-3 * number}};
  };
  browser().run("events.dispatchEvent(new MessageEvent('history', { data: JSON.stringify(arguments[0]) }))",
                std::vector<json>{second(1), second(2)});
  const auto send_seconds = [&](int from, int to) {
    std::vector<json> snapshots;
    for (int number = from; number <= to; ++number) {
      snapshots.push_back(snapshot(number, 0.5));
      snapshots.back()["second"] = second(number);
    }
    send(snapshots);
    return browser().run("return buoyancyView.history.map(({ number }) => number)");
  };
  EXPECT_EQ(send_seconds(2, 4), json({1, 2, 3, 4})) << "each once";
  EXPECT_EQ(label(0),
            "Request to response in ms over time from -3 to 0 s: median from 1 to 4, at the end 4; 99 % from "
            "2 to 8, at the end 8");
  EXPECT_EQ(label(1),
            "Messages in 1/s over time from -3 to 0 s: requests from 1,001 to 1,004, at the end 1,004; "
            "responses from 2,001 to 2,004, at the end 2,004; unanswered from 3,001 to 3,004, at the end "
            "3,004");
  EXPECT_EQ(send_seconds(5, 63).size(), 60U);
  EXPECT_EQ(browser().run("return buoyancyView.history[0].number"), 4);
  EXPECT_EQ(send_seconds(2, 3), json({2, 3})) << "buoyancy-view has restarted";
  EXPECT_EQ(send_seconds(1, 1), json({1})) << "and again";
}

TEST_F(LiveData, IsListedCellByCell) {
  json now = snapshot(10.0, 0.5);
  now["status"] = status();
  now["second"] = {{"number", 1},  {"requests", 1041}, {"responses", 1042}, {"unanswered", 1043},
                   {"p50", 0.044}, {"p99", 0.045},     {"max", 0.046}};
  send({now});
  EXPECT_EQ(
      browser().run("return [...document.querySelectorAll('#strip li')].map((item) => item.textContent)"),
      parse_json(
          R"(["requests 1,041 per second", "responses 1,042 per second", "median 44.0 ms", "99 % 45.0 ms",
    "slowest 46.0 ms", "unanswered 106", "missed by this view 107", "packets dropped 110", "service 9.8.7", "mode lockstep",
    "uptime 32.0 s", "status 29.0 s ago", "rejected 307", "send failures 308"])"));
  EXPECT_EQ(cells_of(browser(), "#body_facts"), parse_json(R"([[["status", "OK"],
    ["position, m", "80.81, -58.92, 1.8"], ["quaternion w, x, y, z", "0.5, -0.5, 0.5, 0.5"],
    ["force, N", "188, 234, 400"], ["torque, N m", "21, 22, 23"], ["error bounds, N and N m", "26, 27"],
    ["submerged volume, m³", "25"], ["metacentric heights, m", "24, –"], ["latest request", "28.0 s ago"]]])"));
  EXPECT_EQ(cells_of(browser(), "#counters"), parse_json(R"([
    [["requests", "101"], ["retries", "102"], ["responses", "103"], ["duplicate responses", "104"],
     ["responses without a request", "105"], ["unanswered", "106"], ["requests missed by this view", "107"],
     ["sessions", "108"], ["malformed: length", "109"], ["packets dropped by the kernel", "110"],
     ["fragments of incomplete messages", "111"], ["services started", "112"], ["seas rejected", "113"]],
    [["requests", "301"], ["computed", "302"], ["retries", "303"], ["conflicting retries", "304"], ["stale", "305"],
     ["superseded", "306"], ["rejected", "307"], ["send failures", "308"], ["seas received", "309"],
     ["seas rejected", "310"], ["packets dropped", "311"], ["fragments dropped", "312"],
     ["incomplete messages evicted", "313"], ["requests in several slices", "314"],
     ["outputs too large to send", "315"], ["bytes retained", "316"], ["stored replies evicted", "317"],
     ["contradicting motions", "318"], ["quaternions in the order x, y, z, w", "319"],
     ["sessions", "320"],
     ["sessions evicted", "321"], ["reloads", "322"], ["reloads failed", "323"]],
    [["skipped: dry", "324"], ["skipped: fully submerged", "325"], ["skipped: unchanged", "326"],
     ["computed: partially submerged", "327"], ["OK", "201"], ["UNKNOWN_BODY", "202"], ["waves: work capped", "328"],
     ["waves: too steep for linear theory", "329"], ["waves: below the sea bed", "330"], ["waves: patches", "331"],
     ["quaternions normalised", "332"], ["hydrostatics", "333"]],
    [["median", "204"], ["99 %", "205"], ["99.9 %", "206"], ["slowest", "207"],
     ["maximum queue wait, last second", "203"]]])"));
  EXPECT_EQ(text_of("#subtitle"), "test scene, instance 77");
  EXPECT_TRUE(agrees(marker_in_W(browser(), 4, "centre_of_buoyancy"),
                     json_of(2.25 * kUp + Vec3(80.4, -60.7, -1.1)), 1e-6));
  // What is not known has no number.
  for (const char* name : {"status", "f", "t", "volume", "force_bound", "torque_bound", "gm"}) {
    now["bodies"][0][name] = nullptr;
  }
  now["status"] = now["second"] = nullptr;
  send({now});
  EXPECT_EQ(cells_of(browser(), "#body_facts"), parse_json(R"([[["status", "requested, no response yet"],
    ["position, m", "80.81, -58.92, 1.8"], ["quaternion w, x, y, z", "0.5, -0.5, 0.5, 0.5"], ["force, N", "–"],
    ["torque, N m", "–"], ["error bounds, N and N m", "–"], ["submerged volume, m³", "–"],
    ["latest request", "28.0 s ago"]]])"));
  EXPECT_EQ(cells_of(browser(), "#counters").size(), 1U);
  EXPECT_EQ(marker_in_W(browser(), 4, "force"), nullptr);
}

TEST_F(LiveData, SaysWhatIsWrong) {
  const auto notices_of = [](const json& change) {
    json now = snapshot(10.0, 0.5);
    now["status"] = status();
    now.merge_patch(change);
    send({now});
    return browser().run(
        "return [...document.querySelectorAll('#notices p')].map((line) => line.textContent)");
  };
  EXPECT_EQ(notices_of(json::object()), json::array()) << "the folder of the scene is ignored";
  const std::vector<std::pair<json, const char*>> cases{
      {{{"services", {"5", "6"}}},
       "2 services are on this bus (5, 6). If they use the same channels, each of them responds to every "
       "request: stop "
       "all but one, or configure separate channels."},
      {{{"service", "offline"}},
       "No message from the service: its last status arrived 29.0 s ago. The page shows the last state "
       "received."},
      {{{"service", "offline"}, {"status", nullptr}},
       "No message from the service since this view was started."},
      {{{"service", "not answering"}}, "Requests are on the bus; the last response arrived 30.0 s ago."},
      {{{"counts", {{"bodies_not_in_scene", 3}}}},
       "3 bodies in requests not found in test scene: the service may use a different scene."},
      {{{"status", {{"scene_bodies", 5}}}}, "The service's scene has 5 bodies, the scene shown here has 2."},
      {{{"status", {{"scene", "/a/b.toml"}}}},
       "The service's scene is b.toml, the scene shown here is test scene."},
      {{{"status", {{"injected_faults", "drop=1"}}}}, "The service injects faults on purpose: drop=1."},
  };
  for (const auto& [change, text] : cases) EXPECT_EQ(notices_of(change), json::array({text}));
}

// ---- Hydrostatics

TEST_F(PageData, OfHydrostaticsIsPlacedRowByRow) {
  const Scene scene = scene_of(kScene);
  json model = scene_model(scene);
  model["bodies"] = {{{"id", 1}, {"mesh", 0}, {"mass", 9000}, {"center_of_mass", {0, 0, 0}}}};
  constexpr std::size_t kState = 19;
  std::vector<double> states;
  std::vector<Eigen::Quaterniond> attitudes;
  for (std::size_t row = 0; row < 4; ++row) {  // three rows, and an attitude at rest
    const auto t = static_cast<double>(row);
    attitudes.push_back(Eigen::Quaterniond(1.0, 0.3 * t, -0.2, 0.1 + 0.2 * t).normalized());
    const Eigen::Quaterniond& q = attitudes.back();
    const std::array<double, kState> state{3 + t,   4 - t,   5 + t,   q.w(),   q.x(),   q.y(), q.z(),
                                           1e5 + t, 2e5,     3e5 - t, 0.1 + t, 0.2 - t, 0.3,   1.1 + t,
                                           1.2,     1.3 - t, 0.5 + t, 0.6,     -0.7};
    states.insert(states.end(), state.begin(), state.end());
  }
  const std::span<const double> numbers(states);
  const std::vector<double> values{-20, 0, 25, 0.3, 0, -0.4, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  json columns = json::array();
  for (const auto& [name, title, unit] : std::vector<std::array<const char*, 3>>{{"heel", "Heel", "°"},
                                                                                 {"gz", "GZ, arm", "m"},
                                                                                 {"kn", "KN", "m"},
                                                                                 {"area", "Area", "m rad"},
                                                                                 {"trim", "Trim", "°"},
                                                                                 {"draft", "Draft", "m"}}) {
    columns.push_back({{"name", name}, {"title", title}, {"unit", unit}});
  }
  const json data{{"version", "1"},
                  {"name", "hull"},
                  {"command", "gz"},
                  {"mass", 9000},
                  {"total_mass", 9100},
                  {"center_of_mass", {0.3, -0.2, 0.9}},
                  {"model", model},
                  {"columns", columns},
                  {"values", base64_of<double>(values)},
                  {"rows", 3},
                  {"all_rows", 3},
                  {"group_rows", 3},
                  {"states", base64_of<double>(numbers.first(3 * kState))},
                  {"rests",
                   {{{"heel", 12.5},
                     {"trim", -1.25},
                     {"draft", 3.5},
                     {"state", std::vector<double>(states.end() - kState, states.end())}}}},
                  {"outcome_text", ""},
                  {"results",
                   {{"crossings", {{{"heel", 12.5}, {"returns", true}}}},
                    {"deck_edge", nullptr},
                    {"downflooding", nullptr},
                    {"max_starboard", {{"heel", 10}}},
                    {"max_port", nullptr},
                    {"vanishing_starboard", nullptr},
                    {"vanishing_port", nullptr},
                    {"criteria", {{"source", "code"}, {"values", json::array()}}}}}};
  std::string page = self_contained_page("hydrostatics.html", three_js().value());
  insert_data(page, data.dump());
  open(page, "window.buoyancy_hydrostatics !== undefined");
  browser().run("window.scene = buoyancy_hydrostatics.scene");
  const HydrostaticMesh& mesh = scene.bodies()[0].solver.mesh();
  const auto expect_placed = [&](std::size_t at) {
    SCOPED_TRACE(at);
    const auto part = [&](std::size_t from) {
      return Vec3(states[at * kState + from], states[at * kState + from + 1], states[at * kState + from + 2]);
    };
    const Vec3 p = part(0);
    EXPECT_TRUE(agrees(marker_in_W(browser(), 1, "centre_of_buoyancy"), json_of(p + part(10)), 1e-9));
    EXPECT_TRUE(agrees(marker_in_W(browser(), 1, "metacentre"), json_of(p + part(13)), 1e-9));
    EXPECT_TRUE(
        agrees(marker_in_W(browser(), 1, "centre_of_mass"), json_of(p + attitudes[at] * part(16)), 1e-9));
    const json force = marker_in_W(browser(), 1, "force");
    const double per_newton = 0.9 * mesh.diagonal / (1012.0 * 9.7 * 30.0);
    EXPECT_TRUE(agrees(force[1], json_of(p + part(10) + per_newton * part(7)), 1e-6));
    EXPECT_TRUE(agrees(vertices_in_W(browser(), 1)[3],
                       json_of(p + attitudes[at] * (mesh.center_B + mesh.vertex(3))), 1e-6));
  };
  EXPECT_EQ(text_of("#status"), "heel 0°, trim 8°, draft 11 m") << "upright at first";
  for (const std::size_t row : {0U, 1U, 2U}) {
    browser().run("buoyancy_hydrostatics.show_row(arguments[0])", row);
    expect_placed(row);
    EXPECT_EQ(text_of("#position"), (std::array{"-20°", "0°", "25°"})[row]);
  }
  browser().run("buoyancy_hydrostatics.show_rest(buoyancy_hydrostatics.rests[0])");
  expect_placed(3);
  EXPECT_EQ(text_of("#status"), "at rest: heel 12.5°, trim -1.25°, draft 3.5 m");
  EXPECT_TRUE(agrees(
      browser().run("return buoyancy_hydrostatics.plots.gz.marks"),
      {{{"time", 10}, {"text", "largest arm at 10.00°"}}, {{"time", 12.5}, {"text", "rests at 12.50°"}}}));
  for (std::size_t column = 1; column < 6; ++column) {
    EXPECT_TRUE(agrees(browser().run("return [...buoyancy_hydrostatics.plots[arguments[0]].series[0].values]",
                                     columns[column]["name"]),
                       std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(3 * column),
                                           values.begin() + static_cast<std::ptrdiff_t>(3 * column + 3))));
  }
  EXPECT_EQ(cells_of(browser(), "#tables"), parse_json(R"([
    [["range of stability ends", "–", "–"], ["largest righting arm", "10.0000°", "–"],
     ["GZ vanishes, and the body returns to this heel", "12.5000°", "–"]],
    [["-20", "0.3", "1", "4", "7", "10"], ["0", "0", "2", "5", "8", "11"], ["25", "-0.4", "3", "6", "9", "12"]],
    [["hull", "9,000", "9,100", "0.3, -0.2, 0.9", "30", "48", "48"]]])"));
}

// ---- Meshes

TEST_F(PageData, OfMeshesIsProjectedAndShaded) {
  // A face seen from outside and one seen from inside, and an open edge.
  const std::vector<float> positions{1, 2, 3, 4, 2, 3.5, 1.5, 6, 3, 0, 0, 7};
  const std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
  const std::vector<float> edges{1, 2, 3, 4, 2, 3.5};
  const json mesh{{"parts",
                   {{{"positions", base64_of<float>(positions)},
                     {"indices", base64_of<std::uint32_t>(indices)},
                     {"colour", "kept"}}}},
                  {"edges", base64_of<float>(edges)}};
  std::string page = self_contained_page("mesh.html", "");
  insert_data(page, json{{"version", "1"},
                         {"name", "mesh"},
                         {"summary", "s"},
                         {"report", "r"},
                         {"before", mesh},
                         {"after", nullptr},
                         {"centre", {1, 2, 3}},
                         {"size", 10}}
                        .dump());
  open(page, "window.buoyancy_mesh !== undefined");
  constexpr double kAzimuth = 0.3;
  constexpr double kElevation = -0.5;
  const json drawn = browser().run(R"(
    const { view, pictures: [picture] } = buoyancy_mesh;
    Object.assign(view, { azimuth: arguments[0], elevation: arguments[1] });
    const list = [];
    picture.triangles(picture.parts[0], 7, 640, 400, list);
    return { points: [...picture.project(picture.parts[0].positions, 7, 640, 400)], ends: [...picture.project(picture.edges, 7, 640, 400)], list };)",
                                   kAzimuth, kElevation);
  // The direction towards the camera, and those to the right and up in the picture.
  const Vec3 towards(std::cos(kElevation) * std::cos(kAzimuth), std::cos(kElevation) * std::sin(kAzimuth),
                     std::sin(kElevation));
  const Vec3 right(-std::sin(kAzimuth), std::cos(kAzimuth), 0.0);
  const Vec3 up = towards.cross(right);
  std::vector<Vec3> corners;
  json expected = json::array();
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    const Vec3 v(positions[i] - 1.0, positions[i + 1] - 2.0, positions[i + 2] - 3.0);
    corners.push_back(v);
    for (const double x : {320.0 + 7.0 * right.dot(v), 200.0 - 7.0 * up.dot(v), 7.0 * towards.dot(v)}) {
      expected.push_back(x);
    }
  }
  EXPECT_TRUE(agrees(drawn["points"], expected, 1e-5));
  EXPECT_TRUE(agrees(drawn["ends"], std::vector<json>(expected.begin(), expected.begin() + 6), 1e-5));
  ASSERT_EQ(drawn["list"].size(), 2U);
  for (std::size_t face = 0; face < 2; ++face) {
    const std::array<Vec3, 3> at{corners[indices[3 * face]], corners[indices[3 * face + 1]],
                                 corners[indices[3 * face + 2]]};
    const double facing = (at[1] - at[0]).cross(at[2] - at[0]).normalized().dot(towards);
    const json& one = drawn["list"][face];
    EXPECT_EQ(one["inside"], facing < 0.0) << face;
    EXPECT_NEAR(one["depth"].get<double>(), 7.0 * towards.dot(at[0] + at[1] + at[2]), 1e-4);
    const double shade = (facing > 0.0 ? 1.0 : 0.45) * (0.35 + 0.65 * std::abs(facing));
    std::array<char, 32> colour{};
    std::snprintf(colour.data(), colour.size(), "rgb(%d,%d,%d)", static_cast<int>(std::lround(86 * shade)),
                  static_cast<int>(std::lround(140 * shade)), static_cast<int>(std::lround(180 * shade)));
    EXPECT_EQ(one["colour"], colour.data());
  }
  EXPECT_NE(drawn["list"][0]["inside"], drawn["list"][1]["inside"]);
  // Keys turn and zoom, up to their limits.
  const auto after = [](const std::string& key, int times) {
    return browser().run(
        "const { view, pictures: [{ canvas }] } = buoyancy_mesh;"
        "for (let i = 0; i < arguments[1]; i += 1) canvas.dispatchEvent(new KeyboardEvent('keydown', { key: "
        "arguments[0] }));"
        "return [view.azimuth, view.elevation, view.zoom]",
        key, times);
  };
  EXPECT_TRUE(agrees(after("ArrowLeft", 2), {kAzimuth + 0.2, kElevation, 1.2}));
  EXPECT_TRUE(agrees(after("ArrowRight", 1), {kAzimuth + 0.1, kElevation, 1.2}));
  EXPECT_TRUE(agrees(after("ArrowUp", 1), {kAzimuth + 0.1, kElevation + 0.1, 1.2}));
  EXPECT_TRUE(agrees(after("ArrowDown", 40), {kAzimuth + 0.1, -1.57, 1.2}));
  EXPECT_TRUE(agrees(after("+", 1), {kAzimuth + 0.1, -1.57, 1.44}));
  EXPECT_TRUE(agrees(after("+", 40), {kAzimuth + 0.1, -1.57, 50.0}));
  EXPECT_TRUE(agrees(after("-", 80), {kAzimuth + 0.1, -1.57, 0.2}));
}

}  // namespace
}  // namespace buoyancy::view
