#include "scene/scene_report.h"

#include <filesystem>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "base/format.h"
#include "tests/geometry/mesh_files.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kThreeBodies = R"(
[water]
level = 1.5
density = 1000
[[body]]
id = 4
name = "crate"
shape = { type = "box", size = [1, 2, 3] }
method = "fast_surface"
tolerance = 0.25
reference_point = [1, 2, 3]
outputs = ["wrench", "hydrostatics"]
[body.client]
density = 300
[[body]]
id = 5
name = "ball"
shape = { type = "sphere", segments = 20 }
[[body]]
id = 6
name = "chest"
shape = { type = "box", size = [1, 2, 3] }
[body.client]
mass = 3000
)";

TEST(SceneReport, WritesWaterAndBodiesAsJson) {
  const Json report = parse_json(scene_report_json(prepared(kThreeBodies)));
  EXPECT_EQ(report["scene"], "pool.toml");
  EXPECT_EQ(report["water"]["level"], 1.5);
  EXPECT_EQ(report["water"]["density"], 1000.0);
  EXPECT_EQ(report["water"]["gravity"], 9.80665);
  EXPECT_EQ(report["water"]["up"], Json({0.0, 0.0, 1.0}));
  ASSERT_EQ(report["bodies"].size(), 3U);
  const Json& crate = report["bodies"][0];
  EXPECT_EQ(crate["id"], 4);
  EXPECT_EQ(crate["name"], "crate");
  EXPECT_EQ(crate["mesh"], 0);
  EXPECT_EQ(crate["method"], "fast_surface");
  EXPECT_EQ(crate["tolerance"], 0.25);
  EXPECT_EQ(crate["reference_point"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(crate["outputs"], Json({"wrench", "hydrostatics"}));
  EXPECT_EQ(report["bodies"][1]["outputs"], Json({"wrench"}));

  EXPECT_EQ(report["bodies"][1]["mesh"], 1);
  EXPECT_EQ(report["bodies"][2]["mesh"], 0);
}

TEST(SceneReport, WritesMassUsedBySimulator) {
  const Json report = parse_json(scene_report_json(prepared(kThreeBodies)));
  EXPECT_NEAR(report["bodies"][0]["mass"], 1800.0, 1e-11);
  EXPECT_EQ(report["bodies"][0]["density"], 300.0);
  EXPECT_EQ(report["bodies"][1]["density"], 500.0);
  EXPECT_NEAR(report["bodies"][1]["mass"], 500.0 * report["meshes"][1]["volume"].get<double>(), 1e-10);
  EXPECT_EQ(report["bodies"][2]["mass"], 3000.0);
  EXPECT_NEAR(report["bodies"][2]["density"], 500.0, 1e-11);
}

TEST(SceneReport, WritesMeshesWithTheirBodiesAsJson) {
  const Scene scene = prepared(kThreeBodies);
  const Json report = parse_json(scene_report_json(scene));
  ASSERT_EQ(report["meshes"].size(), 2U);
  const Json& box = report["meshes"][0];
  EXPECT_EQ(box["name"], "box");
  EXPECT_EQ(box["source"]["format"], "generated");
  EXPECT_EQ(box["bodies"], Json({4, 6}));
  EXPECT_EQ(box["triangles"], 12);
  EXPECT_EQ(box["vertices_stored"], 8);
  EXPECT_EQ(box["vertices_welded"], 8);
  EXPECT_EQ(box["weld"], "exact");
  EXPECT_EQ(box["box"]["min"], Json({-0.5, -1.0, -1.5}));
  EXPECT_EQ(box["box"]["max"], Json({0.5, 1.0, 1.5}));
  EXPECT_EQ(box["area"], scene.meshes()[0]->report.area);
  EXPECT_NEAR(box["volume"], 6.0, 1e-14);
  EXPECT_EQ(box["closed"], true);
  EXPECT_EQ(box["boundary_edges"], 0);
  EXPECT_EQ(box["intersecting_pairs"], nullptr);
  ASSERT_EQ(box["components"].size(), 1U);
  EXPECT_EQ(box["components"][0]["triangles"], 12);
  EXPECT_EQ(box["components"][0]["closed"], true);
  EXPECT_EQ(box["holes"], Json::array());
  EXPECT_EQ(box["turned"], false);
  EXPECT_EQ(report["meshes"][1]["bodies"], Json({5}));
}

TEST(SceneReport, WritesUnknownMassForOpenMeshes) {
  const TempDir directory;
  const std::string mesh = directory.write("open.obj", kOpenObj);
  const Scene scene = prepared("[[body]]\nid = 1\nmesh = \"" + mesh + "\"\nopen = \"dry_boundary\"\n");
  const Json report = parse_json(scene_report_json(scene));
  EXPECT_EQ(report["bodies"][0]["mass"], nullptr);
  EXPECT_EQ(report["meshes"][0]["closed"], false);
  EXPECT_EQ(report["meshes"][0]["holes"][0]["edges"], 3);
  EXPECT_THAT(scene_report_text(scene), HasSubstr("mass          unknown: the mesh is open"));
}

TEST(SceneReport, SaysThatAMassIsTheDefault) {
  const std::string line = "  mass          512.5 kg, 512.5 kg/m^3";
  const std::string by_default =
      scene_report_text(prepared("[[body]]\nid = 1\nshape = { type = \"box\" }\n"));
  EXPECT_TRUE(contains(by_default, line + " (default: half the water's density)\n"));
  EXPECT_TRUE(
      contains(scene_report_text(prepared("[[body]]\nid = 1\nshape = { type = \"box\" }\n[body.client]\n"
                                          "density = 512.5\n")),
               line + "\n"));
}

TEST(SceneReport, FormatsBodiesAndMeshesAsText) {
  const std::string text = scene_report_text(prepared(kThreeBodies));
  for (const char* expected :
       {"pool.toml\n", "up . x < 1.5 m", "1000 kg/m^3", "body 4  crate\n", "body 5  ball\n",
        "body 6  chest\n", "fast_surface, tolerance 0.25", "[1, 2, 3] m",
        "outputs       wrench, hydrostatics\n", "outputs       wrench\n", "1800 kg, 300 kg/m^3",
        "3000 kg, 500 kg/m^3", "mesh box\n", "mesh sphere\n", "used by       body 4, 6\n",
        "used by       body 5\n"}) {
    EXPECT_THAT(text, HasSubstr(expected));
  }
  EXPECT_EQ(text.back(), '\n');
}

TEST(SceneReport, WritesNullForNonFiniteNumbers) {
  // The density of 1e300 kg in 1e-27 m^3 overflows.
  const Scene scene = prepared(
      "[[body]]\nid = 1\nshape = { type = \"box\", size = [1e-9, 1e-9, 1e-9] }\n[body.client]\nmass = "
      "1e300\n");
  const Json body = parse_json(scene_report_json(scene))["bodies"][0];
  EXPECT_EQ(body["mass"], 1e300);
  EXPECT_EQ(body["density"], nullptr);
}

constexpr const char* kSea = R"(
[water]
depth = 40
wave_pressure = "hydrostatic"
time_origin = 1772000000000001
ramp = 15
[[water.waves]]
type = "jonswap"
significant_wave_height = 2
peak_period = 8
spreading = 10
direction = 30
[[water.waves]]
type = "regular"
height = 1
period = 12.5
phase = 0.1
[[water.waves]]
type = "components"
components = [{ amplitude = 0.2, angular_frequency = 0.7 }, { amplitude = 0.1, angular_frequency = 0.9 }]
[[body]]
id = 4
shape = { type = "box" }
)";

TEST(SceneReport, WritesTheSeaAsJson) {
  const Scene scene = prepared(kSea);
  const Json sea = parse_json(scene_report_json(scene))["sea"];
  EXPECT_EQ(sea["depth"], 40.0);
  EXPECT_EQ(sea["wave_pressure"], "hydrostatic");
  EXPECT_EQ(sea["time_origin"], 1'772'000'000'000'001);
  EXPECT_EQ(sea["ramp"], 15.0);
  EXPECT_EQ(sea["significant_wave_height"], scene.sea()->significant_wave_height());
  EXPECT_EQ(sea["shortest_wavelength"], 2.0 * std::numbers::pi / scene.sea()->max_wave_number());
  EXPECT_EQ(sea["extreme_steepness"], scene.sea()->extreme_steepness());
  ASSERT_EQ(sea["systems"].size(), 3U);
  const Json& jonswap = sea["systems"][0];
  EXPECT_EQ(jonswap["type"], "jonswap");
  EXPECT_EQ(jonswap["components"], 200);
  EXPECT_NEAR(jonswap["height"], 2.0, 1e-14);
  EXPECT_NEAR(jonswap["significant_wave_height"], 2.0, 1e-14);
  EXPECT_EQ(jonswap["peak_period"], 8.0);
  EXPECT_NEAR(jonswap["steepness"].get<double>() * jonswap["peak_wavelength"].get<double>(), 2.0, 1e-14);
  EXPECT_EQ(jonswap["gamma"], scene.wave_systems()[0].gamma);
  EXPECT_EQ(jonswap["gamma_is_default"], true);
  EXPECT_EQ(jonswap["m0"], scene.wave_systems()[0].m0);
  EXPECT_EQ(jonswap["m1"], scene.wave_systems()[0].m1);
  EXPECT_EQ(jonswap["m2"], scene.wave_systems()[0].m2);
  EXPECT_EQ(jonswap["zero_crossing_period"], *scene.wave_systems()[0].zero_crossing_period);
  EXPECT_EQ(jonswap["breaking_ratio"],
            scene.wave_systems()[0].breaking->height / scene.wave_systems()[0].breaking->limit);
  EXPECT_EQ(jonswap["repeat_time"], nullptr);
  EXPECT_NEAR(sea["systems"][1]["repeat_time"].get<double>(), 12.5, 1e-12);
  EXPECT_EQ(sea["together"]["components"], 203);
  EXPECT_EQ(sea["together"]["m0"], report_components(*scene.sea()).m0);
  EXPECT_EQ(sea["together"]["repeat_time"], nullptr);
  EXPECT_EQ(sea["systems"][1]["type"], "regular");
  EXPECT_EQ(sea["systems"][1]["height"], 1.0);
  EXPECT_EQ(sea["systems"][1]["gamma"], nullptr);
  EXPECT_EQ(sea["systems"][2]["components"], 2);
  EXPECT_EQ(sea["components"].size(), 203U);
}

TEST(SceneReport, WritesNullForDeepWaterAndWaterAtRest) {
  const Json at_rest = parse_json(scene_report_json(prepared(kThreeBodies)));
  EXPECT_TRUE(at_rest.contains("sea"));
  EXPECT_EQ(at_rest["sea"], nullptr);
  const Json deep = parse_json(scene_report_json(
      prepared(scene_with_crate("[water.waves]\ntype = \"components\"\ncomponents = [{ amplitude = 0.2, "
                                "angular_frequency = 0.7 }, { amplitude = 0, angular_frequency = 9 }]"))));
  EXPECT_EQ(deep["sea"]["depth"], nullptr);
  EXPECT_EQ(deep["sea"]["components"].size(), 2U) << "with those without an amplitude";
}

// Returns a scene like kSea whose only wave system has these keys.
Scene with_components(const std::string& keys, const std::filesystem::path& directory) {
  const std::string text =
      "[water]\ndepth = 40\n[water.waves]\ntype = \"components\"\n" + keys + "\n" + scene_with_crate();
  Expected<Scene> scene = Scene::prepare(parse_scene(text, "again.toml", directory).value());
  return *std::move(scene);
}

void expect_same_sea(const Sea& sea, const Sea& expected) {
  const PreparedComponents& components = sea.prepared();
  const PreparedComponents& expected_components = expected.prepared();
  EXPECT_EQ(components.amplitude, expected_components.amplitude);
  EXPECT_EQ(components.angular_frequency, expected_components.angular_frequency);
  EXPECT_EQ(components.wave_number, expected_components.wave_number);
  EXPECT_EQ(components.k1, expected_components.k1);
  EXPECT_EQ(components.k1_rest, expected_components.k1_rest);
  EXPECT_EQ(components.k2, expected_components.k2);
  EXPECT_EQ(components.k2_rest, expected_components.k2_rest);
  EXPECT_EQ(components.phase, expected_components.phase);
}

TEST(SceneReport, ComponentsReadAgainGiveTheSameSea) {
  const TempDir directory;
  const Scene scene = prepared(kSea);
  std::string csv = "amplitude,angular_frequency,direction,phase\n";
  std::string toml = "components = [";
  const Json report = parse_json(scene_report_json(scene));
  for (const Json& component : report["sea"]["components"]) {
    std::string fields;
    for (const char* key : {"amplitude", "angular_frequency", "direction", "phase"}) {
      const std::string number = format_number(component[key].get<double>(), 17);
      csv += (fields.empty() ? "" : ",") + number;
      fields += (fields.empty() ? "" : ", ") + std::string(key) + " = " + number;
    }
    csv += "\n";
    toml += "{ " + fields + " },\n";
  }
  directory.write("sea.csv", csv);
  expect_same_sea(*with_components("file = \"sea.csv\"", directory.path()).sea(), *scene.sea());
  expect_same_sea(*with_components(toml + "]", directory.path()).sea(), *scene.sea());
}

TEST(SceneReport, FormatsTheSeaAsText) {
  const std::string text = scene_report_text(prepared(kSea));
  for (const char* expected :
       {"\nsea  3 wave systems\n", "  system 1      jonswap, 200 components, Hs 2 m, peak period 8 s, Tz ",
        " % of breaking), gamma 1 (from Hs and peak period), ",
        "  system 2      regular, 1 component, height 1 m, period 12.5 s, Tz 12.5 s, steepness ",
        "does not repeat within 5000 mean periods\n", "repeats after 12.5 s\n",
        "  system 3      2 components, Hs 0.6325 m, peak period ", " s (calculated), Tz ",
        "  together      203 components, Hs ", "shortest wave ", "  depth         40 m\n",
        "  pressure      hydrostatic\n", "  time          t = 0 at utime 1772000000000001 us, ramp of 15 s\n",
        "  components    listed by --check --json\n"}) {
    EXPECT_THAT(text, HasSubstr(expected));
  }
  EXPECT_FALSE(contains(scene_report_text(prepared(kThreeBodies)), "sea"));
  const std::string regular = scene_report_text(
      prepared(scene_with_crate("[water.waves]\ntype = \"regular\"\nheight = 1\nperiod = 8\n")));
  EXPECT_THAT(regular, AllOf(HasSubstr("  depth         inf: deep water\n"), HasSubstr("no ramp\n")));
}

TEST(SceneReport, WarnsAboutASeaTooSteepForLinearTheory) {
  const auto warnings = [](double height) {  // period 2 s: k = 1.006 rad/m
    return scene_warnings(prepared(scene_with_crate(
        "[water.waves]\ntype = \"regular\"\nperiod = 2\nheight = " + format_shortest(height) + "\n")));
  };
  EXPECT_TRUE(scene_warnings(prepared(kThreeBodies)).empty());
  EXPECT_TRUE(warnings(0.85).empty());
  ASSERT_EQ(warnings(1.95).size(), 1U);
  EXPECT_EQ(warnings(1.95)[0].subject, "pool.toml: wave system 1") << "breaks";
  ASSERT_EQ(warnings(2.05).size(), 2U);
  EXPECT_EQ(warnings(2.05)[0].message().rfind("pool.toml: the sea: a steepness of 1.032 ", 0), 0U)
      << warnings(2.05)[0].message();
}

}  // namespace
}  // namespace buoyancy
