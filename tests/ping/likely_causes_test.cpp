#include "client/ping/likely_causes.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/ping/two_scenes.h"
#include "tests/support/contains.h"

namespace buoyancy::ping {
namespace {

// The causes that are named for two scenes that differ in one respect.
std::string causes(const SceneText& here, const SceneText& of_service) {
  const Scene scene = here.scene();
  const ResponseChecks checks = compare_scenes(scene, of_service.scene());
  EXPECT_FALSE(checks.all_passed());
  return joined(causes_of_differences(scene, checks));
}

template <typename Change>
SceneText changed(SceneText text, const Change& change) {
  change(text);
  return text;
}

TEST(LikelyCauses, NameTheOneDifferenceOfTwoScenes) {
  const SceneText plain;
  const SceneText waves = changed(plain, [](SceneText& t) { t.water = kWaves, t.tolerance = "0.001"; });
  const SceneText drag = changed(plain, [](SceneText& t) { t.body = kDrag; });
  const SceneText loads = changed(drag, [](SceneText& t) { t.outputs = kWithLoads; });
  const SceneText tilted =
      changed(plain, [](SceneText& t) { t.up = "[0.36, 0.48, 0.8]", t.level = "3", t.gravity = "1.62"; });
  struct Case {
    const SceneText& here;
    std::function<void(SceneText&)> change;
    std::string expected;
  };
  const std::vector<Case> cases{
      {plain, [](SceneText& t) { t.density = "1000"; }, "density of 1000 instead of 1025 kg/m^3"},
      {plain, [](SceneText& t) { t.gravity = "9.81"; }, "gravity of 9.81 instead of 9.80665 m/s^2"},
      {plain, [](SceneText& t) { t.level = "0.1"; }, "another water level: 0.1 m instead of 0 m"},
      {plain, [](SceneText& t) { t.level = "-0.2"; }, "another water level: -0.2 m instead of 0 m"},
      {tilted, [](SceneText& t) { t.density = "998"; }, "density of 998 instead of 1025 kg/m^3"},
      {tilted, [](SceneText& t) { t.level = "3.25"; }, "another water level: 3.25 m instead of 3 m"},
      {tilted, [](SceneText& t) { t.level = "2.6"; }, "another water level: 2.6 m instead of 3 m"},
      {tilted, [](SceneText& t) { t.up = "[0, 0, 1]"; }, "another up: its forces point along (0, 0, 1)"},
      {plain, [](SceneText& t) { t.up = "[0, 0.6, 0.8]"; },
       "another up: its forces point along (0, 0.6, 0.8)"},
      {plain, [](SceneText& t) { t.reference = "[0.1, 0.1, 0]"; }, "another reference_point for body 1:"},
      {plain, [](SceneText& t) { t.id = "2"; }, "its scene has no body 1"},
      {plain, [](SceneText& t) { t.shape = R"(type = "box", size = [1, 1, 0.6], segments = [4, 4, 4])"; },
       "for body 1: fully submerged it displaces 0.6 m^3 instead of 0.5 m^3"},
      {plain, [](SceneText& t) { t.body = kDrag; }, "that this scene lacks for body 1"},
      {plain, [](SceneText& t) { t.water = kWaves, t.tolerance = "0.001"; },
       "the service has waves, and this scene has none"},
      {drag, [](SceneText& t) { t.body = "[body.drag]\nlinear = [20, 61, 60, 5, 5, 8]\n"; },
       "other drag, added mass or current for body 1"},
      {drag, [](SceneText& t) { t.water = "current = { velocity = [0.5, 0, 0] }"; },
       "other drag, added mass or current for body 1"},
      {drag, [](SceneText& t) { t.density = "1000"; }, "density of 1000 instead of 1025 kg/m^3"},
      {loads, [](SceneText& t) { t.body = "[body.drag]\nlinear = [20, 61, 60, 5, 5, 8]\n"; },
       "current: its buoyancy agrees (body 1)"},
      {loads, [](SceneText& t) { t.density = "1000"; }, "density of 1000 instead of 1025 kg/m^3"},
      {waves, [](SceneText& t) { t.density = "1000"; }, "density of 1000 instead of 1025 kg/m^3"},
      {waves, [](SceneText& t) { t.level = "0.2"; }, "surface of the service's water is elsewhere"},
      {waves, [](SceneText& t) { t.water = ""; }, "surface of the service's water is elsewhere"},
      {waves, [](SceneText& t) { t.water = "waves = \"received\""; }, "it has received no sea"}};
  for (const Case& now : cases) {
    const std::string found = causes(now.here, changed(now.here, now.change));
    EXPECT_TRUE(contains(found, now.expected));
  }
}

// What differs in two respects must not be explained by one of them.
TEST(LikelyCauses, NameNoNumberThatSamplesDisagreeAbout) {
  const std::string found = causes({}, changed(SceneText{}, [](SceneText& t) {
                                     t.level = "0.1";
                                     t.shape = R"(type = "box", size = [1.2, 1, 0.5], segments = [4, 4, 4])";
                                   }));
  EXPECT_FALSE(contains(found, "water level: "));
  EXPECT_FALSE(contains(found, "density of"));
}

}  // namespace
}  // namespace buoyancy::ping
