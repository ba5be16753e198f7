#include <string>

#include <gtest/gtest.h>

#include "scene/body_motions.h"
#include "scene/scene_report.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr SceneReportOptions kWithMotions{.motions = true};

TEST(MotionReport, FormatsDragAddedMassAndMotionsAsText) {
  const std::string text = scene_report_text(prepared(kVehicleScene), kWithMotions);
  for (const char* expected :
       {"  current       [0.5, 0, 0] m/s\n", "  outputs       wrench, loads\n",
        "  drag          linear [4, 6.2, 5.2, 0.07, 0.07, 0.07]\n"
        "                quadratic [18.2, 21.7, 37, 1.5, 1.5, 1.5]\n"
        "                about [0, 0, 0.01] m, immersion \"volume\"\n",
        "  added mass    [5.5, 12.7, 60, 0.12, 0.12, 0.12]\n"
        "                about [0, 0, 0] m, immersion \"wetted_area\"\n",
        "  balance       floats at a draft of 0.2195 m\n", "  terminal      rises at 1.0",
        " m/s, fully submerged\n", "  heave         period ", " s, damping ratio ",
        " at an amplitude of 0.03", " m\n", "  roll          period ", " at an amplitude of 0.1 rad\n",
        "  pitch         period ", "                of small motions about its orientation, afloat\n",
        "  explicit step below ",
        "  mass ratio    added mass up to 1.705 times the mass: as an explicit force it diverges"}) {
    EXPECT_THAT(text, HasSubstr(expected));
  }
}

TEST(MotionReport, WritesAFullMatrixRowByRow) {
  const Scene scene = prepared(scene_with_crate(
      "[body.drag]\nlinear = [1, 0.1, 0, 0, 0, 0, 0.2, 2, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, "
      "0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 6]\n"));
  const std::string text = scene_report_text(scene);
  EXPECT_THAT(text, HasSubstr("linear 36 numbers, diagonal [1, 2, 3, 4, 5, 6]\n"));
  const Json report = parse_json(scene_report_json(scene));
  const Json& linear = report["bodies"][0]["drag"]["linear"];
  ASSERT_EQ(linear.size(), 36U);
  EXPECT_EQ(linear[1], 0.1);
  EXPECT_EQ(linear[6], 0.2);
  EXPECT_EQ(linear[35], 6.0);
}

TEST(MotionReport, FormatsWhatDoesNotApplyAsText) {
  const auto report = [](const std::string& client) {
    return scene_report_text(prepared(scene_with_crate(client)), kWithMotions);
  };
  EXPECT_THAT(report("[body.client]\ndensity = 2500\n"),
              AllOf(HasSubstr("  balance       sinks: heavier than the water that it displaces\n"),
                    HasSubstr("  heave         nothing restores it\n"), Not(HasSubstr("terminal"))))
      << "without drag there is no terminal velocity";
  EXPECT_THAT(report("[body.client]\ndensity = 1025\n"), HasSubstr("  balance       neutrally buoyant\n"));
  EXPECT_THAT(
      report("[body.client]\ncenter_of_mass = [0.1, 0, 0]\nmass = 100\ninertia = [9, 9, 9]\n"),
      HasSubstr(" m at its orientation, from which it turns: buoyancy acts 0.1 m beside the centre of "
                "mass\n"));
  EXPECT_THAT(report("[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\n"),
              HasSubstr("  motions       unknown: no mass in [body.client]\n"));
}

TEST(MotionReport, WritesDragAddedMassAndMotionsAsJson) {
  const Scene scene = prepared(kVehicleScene);
  const Json report = parse_json(scene_report_json(scene, kWithMotions));
  EXPECT_EQ(report["water"]["current"], Json({0.5, 0.0, 0.0}));
  const Json& body = report["bodies"][0];
  EXPECT_EQ(body["outputs"], Json({"wrench", "loads"}));
  EXPECT_EQ(body["drag"]["linear"], Json({4.0, 6.2, 5.2, 0.07, 0.07, 0.07}));
  EXPECT_EQ(body["drag"]["quadratic"][2], 37.0);
  EXPECT_EQ(body["drag"]["center"], Json({0.0, 0.0, 0.01}));
  EXPECT_EQ(body["drag"]["immersion"], "volume");
  EXPECT_EQ(body["added_mass"]["matrix"][0], 5.5);
  EXPECT_EQ(body["added_mass"]["immersion"], "wetted_area");
  const BodyMotions expected = *scene_motions(scene)[0].motions;
  const Json& motions = body["motions"];
  EXPECT_EQ(motions["balance"], "floats");
  EXPECT_EQ(motions["draft"], *expected.draft);
  EXPECT_EQ(motions["turning_lever"], expected.turning_lever);
  EXPECT_EQ(motions["terminal_velocity"], *expected.terminal_velocity);
  EXPECT_EQ(motions["heave"]["period"], expected.natural->heave.period());
  EXPECT_EQ(motions["roll"]["damping_ratio"], expected.natural->roll.damping_ratio);
  EXPECT_EQ(motions["pitch"]["amplitude"], 0.1);
  EXPECT_EQ(motions["pitch"]["damping_ratio_at_amplitude"],
            expected.natural->pitch.damping_ratio_at_amplitude);
  EXPECT_EQ(motions["max_explicit_step"], expected.max_explicit_step);
  EXPECT_TRUE(motions["step_limit"].is_string());
  EXPECT_EQ(motions["added_mass_ratio"], expected.added_mass_ratio);
}

TEST(MotionReport, WritesNullForMotionsThatDoNotApply) {
  const Json report = parse_json(
      scene_report_json(prepared(scene_with_crate("[body.client]\ndensity = 1025\n")), kWithMotions));
  const Json& motions = report["bodies"][0]["motions"];
  EXPECT_EQ(motions["balance"], "neutrally buoyant");
  for (const char* key : {"draft", "heave", "roll", "pitch", "max_explicit_step"}) {
    EXPECT_TRUE(motions[key].is_null()) << key;
  }
  EXPECT_EQ(motions["terminal_velocity"], 0.0);
}

TEST(MotionReport, StaysTheSameWithoutAMassAndTables) {
  const Scene scene = prepared(scene_with_crate());
  EXPECT_EQ(scene_report_text(scene, kWithMotions), scene_report_text(scene));
  EXPECT_EQ(scene_report_json(scene, kWithMotions), scene_report_json(scene));
  for (const char* word : {"current", "drag", "added", "motions"}) {
    EXPECT_FALSE(contains(scene_report_json(scene, kWithMotions), word)) << word;
  }
}

}  // namespace
}  // namespace buoyancy
