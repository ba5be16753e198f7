// [[water.layer]] and [[water.current.profile]] of scene files.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene.h"
#include "scene/scene_report.h"
#include "tests/scene/scene_texts.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

std::string layer(const std::string& below, const std::string& density) {
  return "[[water.layer]]\nbelow = " + below + "\ndensity = " + density + "\n";
}

std::string point(const std::string& height, const std::string& velocity) {
  return "[[water.current.profile]]\nheight = " + height + "\nvelocity = " + velocity + "\n";
}

std::string layers(const std::string& sections, const std::string& water = "") {
  return "[water]\n" + water + sections + scene_with_crate();
}

std::string many(int count, std::string (*section)(const std::string&, const std::string&),
                 const std::string& value) {
  std::string text;
  for (int i = 1; i <= count; ++i) text += section("-" + std::to_string(i), value);
  return text;
}

TEST(WaterToml, ReadsLayersFromTheTopDown) {
  const SceneDescription scene =
      parsed(layers(layer("-2.0", "1010"), "density = 1000\nlevel = 1.5\n") + layer("-7", "1028.5"));
  EXPECT_EQ(scene.water.density, 1000.0);
  EXPECT_EQ(scene.water.level, 1.5);
  EXPECT_EQ(scene.water.layers, (std::vector<WaterLayer>{{-2.0, 1010.0}, {-7.0, 1028.5}}));
  EXPECT_EQ(Scene::prepare(scene)->water().layers, scene.water.layers);
  EXPECT_EQ(parsed(layers(many(16, layer, "1025"))).water.layers.size(), kMaxWaterLayers);
  EXPECT_TRUE(parsed(layers("layer = []\n")).water.layers.empty());
}

TEST(WaterToml, ReadsTheProfileOfACurrent) {
  const SceneDescription scene = parsed(layers(point("1", "[0.8, 0, 0]") + point("-3", "[0, 0.4, -0.1]")));
  EXPECT_EQ(scene.current_profile, (CurrentProfile{{1.0, {0.8, 0.0, 0.0}}, {-3.0, {0.0, 0.4, -0.1}}}));
  EXPECT_LE((scene.sea.current_W - Vec3(0.6, 0.1, -0.025)).norm(), 1e-15);
  const Scene prepared_scene = Scene::prepare(scene).value();
  EXPECT_EQ(prepared_scene.current().profile, scene.current_profile);
  EXPECT_EQ(prepared_scene.current_W(), scene.sea.current_W);
  EXPECT_EQ(parsed(layers(many(16, point, "[1, 0, 0]"))).current_profile.size(), kMaxCurrentPoints);
  EXPECT_TRUE(parsed(layers("current = { velocity = [1, 2, 3] }\n")).current_profile.empty());
}

TEST(WaterToml, RejectsWrongInputWithFileAndLine) {
  const std::string both = "[water.current]\nvelocity = [1, 0, 0]\n" + point("0", "[1, 0, 0]");
  expect_parse_errors({
      {layers(layer("-2", "1020")),
       "pool.toml:4: [[water.layer]] number 1: density = 1020; expected at least "
       "1025 kg/m^3, the density of the water above it"},
      {layers(layer("-2", "1030") + layer("-3", "1029")), "number 2: density = 1029; expected at least 1030"},
      {layers(layer("0", "1030")), "number 1: below = 0; expected less than 0 m, the level of the water"},
      {layers(layer("3", "1030"), "level = 2\n"), "expected less than 2 m, the level of the water"},
      {layers(layer("-2", "1030") + layer("-2", "1040")),
       "number 2: below = -2; expected less than -2 m, that of the layer above it"},
      {layers(layer("-2", "1e9")), "density = 1e+09; expected a number above 0, at most 1e+05"},
      {layers(layer("-2", "nan")), "density"},
      {layers(layer("inf", "1030")), "below"},
      {layers(layer("-2", "\"1030\"")), "density"},
      {layers("[[water.layer]]\nbelow = -2\n"), "no key 'density'"},
      {layers("[[water.layer]]\ndensity = 1030\n"), "no key 'below'"},
      {layers("[[water.layer]]\nbelo = -2\ndensity = 1030\n"), "nearest known key is 'below'"},
      {layers("[water.layer]\nbelow = -2\ndensity = 1030\n"), "[[water.layer]] in double brackets"},
      {layers("layer = 3\n"), "a list of tables"},
      {layers("layer = [1, { below = -2, density = 1030 }]\n"), "a list of tables"},
      {layers(layer("-2", "1030"), "density = 0\n"), "density = 0 over layers"},
      {layers(many(17, layer, "1030")), "17 sections [[water.layer]]; expected at most 16"},
      {layers(many(17, point, "[1, 0, 0]")), "17 sections [[water.current.profile]]; expected at most 16"},
      {layers(point("0", "[1, 0, 0]") + point("0", "[2, 0, 0]")),
       "pool.toml:6: [[water.current.profile]] number 2: height = 0; expected less than 0 m"},
      {layers(point("0", "[1, 0]")), "velocity"},
      {layers(point("0", "[1, 0, inf]")), "velocity"},
      {layers(point("1e6", "[1, 0, 0]")), "height = 1e+06; expected a number from -1e+05 to 1e+05"},
      {layers("[[water.current.profile]]\nvelocity = [1, 0, 0]\n"), "no key 'height'"},
      {layers("[[water.current.profile]]\nheight = 0\n"), "no key 'velocity'"},
      {layers(both), "both 'velocity' and sections [[water.current.profile]]"},
      {layers("[water.current]\nprofile = []\n"), "no key 'velocity'"},
  });
}

TEST(WaterToml, TheReportListsThem) {
  const Scene scene = prepared(layers(layer("-2", "1030"), "density = 1000\n") + point("0", "[0.8, 0, 0]") +
                               point("-3", "[0, 0.4, 0]"));
  const std::string text = scene_report_text(scene);
  EXPECT_THAT(text, HasSubstr("up . x < -2 m, 1030 kg/m^3"));
  EXPECT_THAT(text, HasSubstr("[0, 0.4, 0] m/s at a height of -3 m"));
  const std::string json = scene_report_json(scene);
  EXPECT_THAT(json, HasSubstr("\"layers\""));
  EXPECT_THAT(json, HasSubstr("\"current_profile\""));
  const std::string without = scene_report_json(prepared(scene_with_crate()));
  EXPECT_THAT(without, ::testing::Not(HasSubstr("layers")));
  EXPECT_THAT(without, ::testing::Not(HasSubstr("current_profile")));
}

}  // namespace
}  // namespace buoyancy
