#include "scene/scene_report.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/geometry/mesh_files.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/json.h"

namespace buoyancy {
namespace {

using Json = nlohmann::json;

Scene prepared(const std::string& text) {
  Expected<Scene> scene = Scene::prepare(parse(text).value());
  return *std::move(scene);
}

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
  const std::string mesh =
      directory.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const Scene scene = prepared("[[body]]\nid = 1\nmesh = \"" + mesh + "\"\nopen = \"dry_boundary\"\n");
  const Json report = parse_json(scene_report_json(scene));
  EXPECT_EQ(report["bodies"][0]["mass"], nullptr);
  EXPECT_EQ(report["meshes"][0]["closed"], false);
  EXPECT_EQ(report["meshes"][0]["holes"][0]["edges"], 3);
  EXPECT_NE(scene_report_text(scene).find("mass          unknown: the mesh is open"), std::string::npos);
}

TEST(SceneReport, FormatsBodiesAndMeshesAsText) {
  const std::string text = scene_report_text(prepared(kThreeBodies));
  for (const char* expected :
       {"pool.toml\n", "up . x < 1.5 m", "1000 kg/m^3", "body 4  crate\n", "body 5  ball\n",
        "body 6  chest\n", "fast_surface, tolerance 0.25", "[1, 2, 3] m",
        "outputs       wrench, hydrostatics\n", "outputs       wrench\n", "1800 kg, 300 kg/m^3",
        "3000 kg, 500 kg/m^3", "mesh box\n", "mesh sphere\n", "used by       body 4, 6\n",
        "used by       body 5\n"}) {
    EXPECT_NE(text.find(expected), std::string::npos) << "missing: " << expected << "\n" << text;
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

}  // namespace
}  // namespace buoyancy
