#include "scene/body_flotation.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "scene/scene_report.h"
#include "scene/start_pose.h"
#include "tests/geometry/mesh_files.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/json.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

std::string bar(int id, const std::string& client) {
  return "[[body]]\nid = " + std::to_string(id) +
         "\nname = \"bar\"\nshape = { type = \"box\", size = [4, 1, 1] }\n[body.client]\n" + client;
}
const std::string kWater = "[water]\ndensity = 1000\n";

std::vector<std::string> warnings_of(const Scene& scene) {
  return messages_of(flotation_warnings(scene, scene_flotation(scene)));
}

TEST(SceneFlotation, FindsAllAttitudesAndMarksTheOneReached) {
  const Scene scene = scene_of(kWater + bar(1, "density = 500\norientation = [0.98, -0.1, 0, 0]\n"));
  const BodyFlotation flotation = *scene_flotation(scene).at(0).flotation;
  EXPECT_EQ(flotation.outcome, FlotationOutcome::kFloats);
  ASSERT_EQ(flotation.attitudes.size(), 4U);
  ASSERT_TRUE(flotation.reached);
  const Equilibrium& reached = flotation.attitudes[*flotation.reached];
  const Vec3 up_B = reached.pose.q_WB.conjugate() * Vec3::UnitZ();
  EXPECT_LE((up_B - Vec3(0, -std::sqrt(0.5), std::sqrt(0.5))).norm(), 1e-9);
  EXPECT_NEAR(flotation.turn, 0.25 * std::numbers::pi - 2.0 * std::atan(0.1 / 0.98), 1e-9);
  EXPECT_FALSE(flotation.starts_unstable) << "it turns at once";
  EXPECT_TRUE(warnings_of(scene).empty());
}

TEST(SceneFlotation, WarnsOfBodiesThatCapsizeSinkOrStartUnstable) {
  const std::string capsizes = "density = 100\ncenter_of_mass = [0, 0, 3]\norientation = [1, 0.01, 0, 0]\n";
  const Scene scene =
      scene_of(kWater + bar(1, "density = 500\n") + bar(2, capsizes) + bar(3, "density = 2000\n") +
               bar(4, "density = 100\n") + bar(5, "density = 2000\n"));
  EXPECT_THAT(
      warnings_of(scene),
      ElementsAre(
          HasSubstr("body 1: at its orientation it is in balance but not stable, and turns by 45 degrees"),
          AllOf(HasSubstr("body 2: turns by 178.9 degrees"), HasSubstr("the body capsizes")),
          HasSubstr("body 3 and 1 other: a mass of 8000 kg; expected less than the 4000 kg")));
}

TEST(SceneFlotation, DoesNotWarnOfAnUnstableOrientationThatIsNotTheStart) {
  EXPECT_TRUE(warnings_of(scene_of(kWater + bar(1, "density = 500\nstart = \"equilibrium\"\n"))).empty());
}

TEST(SceneFlotation, TakesASphereAsItIsPlaced) {
  const Scene scene = scene_of("[[body]]\nid = 1\nshape = { type = \"sphere\" }\n[body.client]\n");
  const BodyFlotation flotation = *scene_flotation(scene).at(0).flotation;
  EXPECT_EQ(flotation.attitudes.size(), 1U);
  EXPECT_EQ(flotation.turn, 0.0);
  EXPECT_TRUE(warnings_of(scene).empty());
}

TEST(SceneFlotation, WarnsOfOpenMeshesThatTakeInWater) {
  const TempDir directory;
  const std::string mesh = directory.write("open.obj", kOpenObj);
  const Scene scene = scene_of("[[body]]\nid = 1\nmesh = \"" + mesh +
                               "\"\nopen = \"dry_boundary\"\n[body.client]\nmass = 1e4\ncenter_of_mass = [0, "
                               "0, 0]\ninertia = [1, 1, 1]\n");
  EXPECT_EQ(scene_flotation(scene).at(0).flotation->outcome, FlotationOutcome::kTakesInWater);
  EXPECT_THAT(warnings_of(scene), ElementsAre(HasSubstr("takes in water")));
}

TEST(SceneFlotation, WarnsOfWhatTheClientRefuses) {
  const TempDir directory;
  const std::string mesh =
      directory.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const std::string open = "[[body]]\nid = 1\nmesh = \"" + mesh +
                           "\"\nopen = \"dry_boundary\"\n[body.client]\nstart = \"equilibrium\"\n";
  const std::string neutral = "density = 1000\nstart = \"equilibrium\"\n";
  for (const std::string& text :
       {open, open + "mass = 1\n", open + "mass = 1\ncenter_of_mass = [0, 0, 0]\n", kWater + bar(1, neutral),
        kWater + bar(1, "density = 2000\n" + neutral.substr(15))}) {
    const Scene scene = scene_of(text);
    const auto start = StartFinder(scene).start_of(scene.bodies().front());
    ASSERT_FALSE(start) << text;
    EXPECT_THAT(warnings_of(scene), ElementsAre(HasSubstr(start.error().actual)));
    const std::vector<FlotationOfBody> flotation = scene_flotation(scene);
    EXPECT_THAT(scene_report_text(scene, {.flotation = &flotation}), Not(HasSubstr("at equilibrium")))
        << text;
  }
  EXPECT_THAT(warnings_of(scene_of(open + "mass = 1\n")),
              ElementsAre(HasSubstr("without center_of_mass, inertia;")));
}

TEST(SceneFlotation, SharesEqualBodiesAndLeavesOutThoseBeyondTheLimit) {
  const std::string tank =
      "[[body.tank]]\nshape = { type = \"box\", size = [1, 1, 0.5] }\nposition = [0, 0, -0.25]\nfill = ";
  const auto with_tank = [&](int id, const std::string& fill) {
    return "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = [4, 1, 1] }\n" +
           tank + fill + "\n[body.client]\ndensity = 100\n";
  };
  const Scene scene = scene_of(kWater + with_tank(1, "0.5") + with_tank(2, "0.6") + with_tank(3, "0.5") +
                               "[[body]]\nid = 4\nshape = { type = \"box\" }\n");
  const std::vector<FlotationOfBody> all = scene_flotation(scene);
  EXPECT_EQ(all[0].flotation, all[2].flotation);
  EXPECT_GT(all[1].flotation->attitudes[0].draft, all[0].flotation->attitudes[0].draft);
  EXPECT_EQ(all[3].flotation, nullptr) << "no [body.client]";
  const std::vector<FlotationOfBody> first = scene_flotation(scene, 1);
  EXPECT_NE(first[0].flotation, nullptr);
  EXPECT_TRUE(first[1].left_out);
  EXPECT_EQ(first[2].flotation, first[0].flotation);
  EXPECT_THAT(scene_report_text(scene, {.flotation = &first}), HasSubstr("  attitudes     left out"));
}

TEST(SceneFlotation, IsReportedAsText) {
  const Scene scene =
      scene_of(kWater + bar(1, "density = 500\norientation = [0.98, -0.1, 0, 0]\nstart = \"equilibrium\"\n"));
  const std::vector<FlotationOfBody> flotation = scene_flotation(scene);
  const std::string text = scene_report_text(scene, {.flotation = &flotation});
  for (const char* expected :
       {"  start         at equilibrium, from its orientation\n",
        "  attitudes     4 stable attitudes, heel and trim 0 with the body's z axis up; * is where it turns "
        "to from its orientation\n",
        "              * draft 0.7071 m, heel -45 deg, trim 0 deg, GM 0.2357 and 3.536 m, energy 4623 J\n",
        "                draft 0.7071 m, heel 135 deg, trim 0 deg, GM"}) {
    EXPECT_THAT(text, HasSubstr(expected));
  }
}

TEST(SceneFlotation, IsReportedAsJson) {
  const Scene scene =
      scene_of(kWater + bar(1, "density = 500\nposition = [5, 6, 7]\norientation = [0.98, -0.1, 0, 0]\n") +
               bar(2, "density = 3000\n") + scene_with_crate());
  const std::vector<FlotationOfBody> flotation = scene_flotation(scene);
  const Json report = parse_json(scene_report_json(scene, {.flotation = &flotation}));
  const Json& floats = report["bodies"][0]["flotation"];
  EXPECT_EQ(floats["outcome"], "floats");
  EXPECT_EQ(floats["start"], "pose");
  EXPECT_EQ(floats["mass"], 2000.0);
  EXPECT_EQ(floats["truncated"], false);
  ASSERT_EQ(floats["attitudes"].size(), 4U);
  int reached = 0;
  for (const Json& attitude : floats["attitudes"]) {
    if (attitude["reached"] != true) continue;
    ++reached;
    EXPECT_NEAR(attitude["heel"].get<double>(), -45.0, 1e-6);
    EXPECT_NEAR(attitude["draft"].get<double>(), std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(attitude["position"][0].get<double>(), 5.0, 1e-12);
    EXPECT_NEAR(attitude["position"][2].get<double>(), 0.0, 1e-12);
    EXPECT_EQ(attitude["metacentric_heights"].size(), 2U);
    EXPECT_EQ(attitude["family"], "none");
  }
  EXPECT_EQ(reached, 1);
  EXPECT_EQ(report["bodies"][1]["flotation"]["outcome"], "sinks");
  EXPECT_TRUE(report["bodies"][1]["flotation"]["turn"].is_null());
  EXPECT_FALSE(report["bodies"][2].contains("flotation"));
}

// A cuboid of 4 x 2 x 1 m that lies with its y axis up, in a world whose z axis points down, and a wedge of
// triangular sections whose edge is its keel: no mass is needed.
TEST(SceneFlotation, ReportsUprightHullsAtDrafts) {
  const TempDir directory;
  const std::string wedge = directory.write("wedge.obj",
                                            "v -3 0 0\nv 3 0 0\nv -3 1 2\nv 3 1 2\nv -3 -1 2\nv 3 -1 2\n"
                                            "f 1 2 4 3\nf 2 1 5 6\nf 3 4 6 5\nf 1 3 5\nf 2 6 4\n");
  const Scene scene = scene_of(
      "[world]\nup = [0, 0, -1]\n[water]\ndensity = 1000\n"
      "[[body]]\nid = 1\nup = \"y\"\nshape = { type = \"box\", size = [4, 2, 1] }\n"
      "[[body]]\nid = 2\nup = \"z\"\nmesh = \"" +
      wedge +
      "\"\n"
      "[[body]]\nid = 3\nshape = { type = \"box\", size = [4, 2, 1] }\n");
  const Json report = parse_json(scene_report_json(scene, {.drafts = {0.5, 1.5}}));
  const auto row = [&](std::size_t body, std::size_t i) { return report["bodies"][body]["upright"][i]; };
  const auto expect = [](const Json& one, double volume, double kb, double bm_t, double bm_l) {
    EXPECT_NEAR(one["volume"].get<double>(), volume, 1e-12);
    EXPECT_NEAR(one["mass"].get<double>(), 1000.0 * volume, 1e-9);
    EXPECT_NEAR(one["kb"].get<double>(), kb, 1e-12);
    EXPECT_NEAR(one["bm_t"].get<double>(), bm_t, 1e-12);
    EXPECT_NEAR(one["bm_l"].get<double>(), bm_l, 1e-11);
    EXPECT_NEAR(one["lcf"].get<double>(), 0.0, 1e-12);
  };
  expect(row(0, 0), 2.0, 0.25, 4.0 * 1.0 / 12.0 / 2.0, 64.0 / 12.0 / 2.0);
  expect(row(0, 1), 6.0, 0.75, 4.0 * 1.0 / 12.0 / 6.0, 64.0 / 12.0 / 6.0);
  // At a draft T the section is a triangle of width and area T.
  expect(row(1, 0), 6.0 * 0.125, 1.0 / 3.0, 6.0 * 0.125 / 12.0 / 0.75, 0.5 * 216.0 / 12.0 / 0.75);
  expect(row(2, 0), 4.0, 0.25, 4.0 * 8.0 / 12.0 / 4.0, 2.0 * 64.0 / 12.0 / 4.0);
  EXPECT_THAT(scene_report_text(scene, {.drafts = {0.5}}),
              HasSubstr("  upright       -z up; KB over the lowest point, LCF forward of the middle\n"
                        "                draft 0.5 m, displaces 4 m^3, 4000 kg, KB 0.25 m, BM 0.6667 m, and "
                        "lengthwise 2.667 m, LCF 0 m\n"));
  EXPECT_EQ(parse_json(scene_report_json(scene))["bodies"][0].count("upright"), 0U);
}

// Of the same hull with another axis up, heel and trim are about its own axes.
TEST(SceneFlotation, HasHeelsAboutTheBodysOwnUpAxis) {
  const auto heels = [](const std::string& world, const std::string& up, const std::string& z) {
    const Scene scene = scene_of(world + "[[body]]\nid = 1\n" + up +
                                 "shape = { type = \"box\", size = [4, 4, 0.5] }\n[body.client]\ndensity = "
                                 "500\ncenter_of_mass = [0, 0, " +
                                 z + "]\n");
    const std::vector<FlotationOfBody> flotation = scene_flotation(scene);
    const Json report = parse_json(scene_report_json(scene, {.flotation = &flotation}));
    std::vector<double> found;
    for (const Json& at : report["bodies"][0]["flotation"]["attitudes"]) {
      found.push_back(std::abs(at["heel"].get<double>()));
    }
    return found;
  };
  using ::testing::DoubleNear;
  EXPECT_THAT(heels("", "", "-0.1"), ElementsAre(DoubleNear(0.0, 1e-6), DoubleNear(180.0, 1e-6)));
  EXPECT_THAT(heels("[world]\nup = [0, 0, -1]\n", "", "0.1"),
              ElementsAre(DoubleNear(0.0, 1e-6), DoubleNear(180.0, 1e-6)));
  EXPECT_THAT(heels("", "up = \"y\"\n", "0"), ElementsAre(DoubleNear(90.0, 1e-6), DoubleNear(90.0, 1e-6)));
}

TEST(SubdivisionReport, ListsPartsCompartmentsAndTanks) {
  const Scene scene = scene_of(
      "[[body]]\nid = 1\n[[body.part]]\nname = \"left\"\nshape = { type = \"box\", size = [4, 1, 1] }\n"
      "[[body.part]]\nname = \"right\"\nshape = { type = \"box\", size = [4, 1, 1] }\nposition = [0, 2, 0]\n"
      "[[body.compartment]]\nname = \"bow\"\nshape = { type = \"box\", size = [1, 1, 1] }\n"
      "permeability = 0.8\nflooded = 0.25\n"
      "[[body.tank]]\nname = \"fuel\"\nshape = { type = \"box\", size = [1, 1, 1] }\nfill = 0.75\n"
      "density = 850\n");
  const std::string text = scene_report_text(scene);
  for (const char* expected :
       {"  part          'left', 4 m^3\n", "  compartment   'bow', 1 m^3, permeability 0.8, flooded 0.25\n",
        "  tank          'fuel', 1 m^3, holds 0.75 m^3, fill 0.75, 850 kg/m^3, 637.5 kg\n",
        "  used by       part 'right' of body 1\n", "  used by       body 1\n",
        "  used by       compartment 'bow' of body 1; tank 'fuel' of body 1\n"}) {
    EXPECT_THAT(text, HasSubstr(expected));
  }
  const Json report = parse_json(scene_report_json(scene));
  const Json& body = report["bodies"][0];
  EXPECT_EQ(body["parts"][1]["name"], "right");
  EXPECT_NEAR(body["parts"][1]["volume"].get<double>(), 4.0, 1e-13);
  EXPECT_EQ(body["compartments"][0]["permeability"], 0.8);
  EXPECT_EQ(body["compartments"][0]["flooded"], 0.25);
  EXPECT_NEAR(body["tanks"][0]["capacity"].get<double>(), 1.0, 1e-14);
  EXPECT_NEAR(body["tanks"][0]["liquid_volume"].get<double>(), 0.75, 1e-14);
  EXPECT_NEAR(body["tanks"][0]["liquid_mass"].get<double>(), 637.5, 1e-11);
  EXPECT_EQ(body["tanks"][0]["mesh"], body["compartments"][0]["mesh"]);
  const Json& sections = report["meshes"][body["tanks"][0]["mesh"].get<std::size_t>()]["sections"];
  EXPECT_EQ(sections[1], Json({{"body", 1}, {"section", "tank"}, {"index", 0}, {"name", "fuel"}}));
}

TEST(SubdivisionReport, StaysTheSameWithoutThem) {
  const std::string report = scene_report_json(scene_of(scene_with_crate()));
  for (const char* word : {"\"parts\"", "\"compartments\"", "\"tanks\"", "\"sections\""})
    EXPECT_THAT(report, Not(HasSubstr(word)));
}

}  // namespace
}  // namespace buoyancy
