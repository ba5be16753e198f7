// Runs buoyancy-hydrostatics as a program.
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/format.h"
#include "geometry/shapes.h"
#include "service/hydrostatics/hydrostatics_options.h"
#include "service/hydrostatics/hydrostatics_page.h"
#include "tests/geometry/mesh_files.h"
#include "tests/support/child_process.h"
#include "tests/support/contains.h"
#include "tests/support/csv.h"
#include "tests/support/temp_dir.h"

namespace buoyancy::service {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

FinishedProcess run(std::vector<std::string> arguments) {
  return run_program("buoyancy-hydrostatics", std::move(arguments));
}

// Beam 20, depth 12, draught 6, KG 8 [m], with B's origin in the middle.
class HydrostaticsProgram : public testing::Test {
 protected:
  std::string scene(const std::string& client, const std::string& more = "") const {
    return dir_.write("scene.toml", R"([[body]]
id = 3
name = "ship"
shape = { type = "box", size = [80, 20, 12], segments = [2, 2, 2] }
[body.client]
)" + client + more);
  }
  // 4 x 2 x 1 m, its corner in B's origin.
  std::string box() const {
    return dir_.write("box.obj",
                      "v 0 0 0\nv 4 0 0\nv 4 2 0\nv 0 2 0\nv 0 0 1\nv 4 0 1\nv 4 2 1\nv 0 2 1\n"
                      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  }
  std::string ship() const { return scene("density = 512.5\ncenter_of_mass = [0, 0, 2]\n"); }

  TempDir dir_;
};

TEST_F(HydrostaticsProgram, WritesRightingArmsAsCsv) {
  const FinishedProcess result =
      run({"gz", "--scene", ship(), "--heel", "-30:90:15", "--csv", dir_.path("gz.csv")});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto rows = csv_rows(read_file(dir_.path("gz.csv")));
  EXPECT_EQ(rows.at(0), (CsvRow{"heel", "trim", "draft", "gz", "kn", "area"}));
  ASSERT_EQ(rows.size(), 10U);
  const std::vector<double> at_thirty = numbers_of(rows[5]);
  EXPECT_NEAR(at_thirty[0], 30.0, 1e-12);
  EXPECT_NEAR(at_thirty[3], 0.740740741, 1e-9);
  EXPECT_NEAR(at_thirty[4], 0.740740741 + 8.0 * std::sin(30 * kDegree), 1e-9);
  EXPECT_NEAR(at_thirty[5], 0.132002392797, 1e-12);
  EXPECT_NEAR(std::stod(rows[1][3]), -at_thirty[3], 1e-12);
  EXPECT_NEAR(std::stod(rows[9][3]), -2.0, 1e-9);
  EXPECT_TRUE(contains(result.standard_output, "largest arm to starboard"));
  EXPECT_TRUE(contains(result.standard_output, "not a class approval"));
}

TEST_F(HydrostaticsProgram, PrintsRightingArmsAsJson) {
  const FinishedProcess result =
      run({"--scene", ship(), "--json", "gz", "--fixed-trim", "--heel", "-180:180:10"});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto json = nlohmann::json::parse(result.standard_output);
  EXPECT_EQ(json.at("points").size(), 37U);
  EXPECT_GT(json.at("vanishing_starboard").get<double>(), 60.0);
  EXPECT_EQ(json.at("criteria").at("values").size(), 6U);
  EXPECT_NEAR(json.at("criteria").at("values").at(0).at("value").get<double>(), 0.132002392797, 1e-12);
  EXPECT_NEAR(json.at("criteria").at("values").at(5).at("value").get<double>(), 3.0 + 400.0 / 72.0 - 8.0,
              1e-7);
}

// 2008 IS Code, part A, 2.2: the figures of the code, and which of them the box meets.
TEST_F(HydrostaticsProgram, ComparesArmsWithTheGeneralCriteriaAsData) {
  const auto criteria_at = [&](const std::string& height_of_mass) {
    const std::string at = scene("density = 512.5\ncenter_of_mass = [0, 0, " + height_of_mass + "]\n");
    const FinishedProcess result = run({"gz", "--scene", at, "--heel", "0:90:30", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return nlohmann::json::parse(result.standard_output).at("criteria");
  };
  const auto criteria = criteria_at("2");
  EXPECT_EQ(criteria.at("source"), "2008 IS Code A 2.2, to starboard; not a class approval");
  const auto& values = criteria.at("values");
  ASSERT_EQ(values.size(), 6U);
  const std::array<double, 6> required{0.055, 0.090, 0.030, 0.20, 25.0, 0.15};
  const std::array<double, 3> areas{0.132002392797, 0.132002392797 + 0.16178627, 0.16178627};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(values[i].at("required").get<double>(), required[i]);
    EXPECT_EQ(values[i].at("met"), true);
    if (i < 3) {
      EXPECT_NEAR(values[i].at("value").get<double>(), areas[i], 1e-8);
    }
  }
  EXPECT_GT(values[3].at("value").get<double>(), 0.972596655);  // the arm at 40 degrees is not the largest
  EXPECT_GT(values[4].at("value").get<double>(), 30.0);
  EXPECT_LT(values[4].at("value").get<double>(), 50.0);
  // KG 8.5 m: GM is 0.056 m.
  const auto high = criteria_at("2.5").at("values");
  EXPECT_NEAR(high[5].at("value").get<double>(), 3.0 + 400.0 / 72.0 - 8.5, 1e-7);
  EXPECT_EQ(high[5].at("met"), false);
  EXPECT_EQ(high[4].at("met"), true);
}

TEST_F(HydrostaticsProgram, WritesTableAsCsv) {
  const FinishedProcess result = run(
      {"table", "--scene", ship(), "--draft", "1:6:2.5", "--trim", "-1:1:1", "--csv", dir_.path("t.csv")});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const std::string csv = read_file(dir_.path("t.csv"));
  const auto rows = csv_rows(csv);
  EXPECT_TRUE(csv.starts_with(
      "draft,trim,displacement_volume,displacement_mass,lcb,tcb,kb,lcf,waterplane_area,bm_t,bm_l,km_t,km_l"))
      << csv;
  ASSERT_EQ(rows.size(), 10U);
  const std::vector<double> design = numbers_of(rows[6]);
  EXPECT_EQ(design[0], 6.0);
  EXPECT_EQ(design[1], 0.0);
  EXPECT_NEAR(design[2], 9600.0, 1e-9);
  EXPECT_NEAR(design[3], 9840.0, 1e-9);  // t
  EXPECT_NEAR(design[6], 3.0, 1e-12);
  EXPECT_NEAR(design[9], 400.0 / 72.0, 1e-12);
  EXPECT_NEAR(design[11], 3.0 + 400.0 / 72.0, 1e-12);
}

TEST_F(HydrostaticsProgram, PrintsEquilibriaAsJsonLowestEnergyFirst) {
  const FinishedProcess result = run({"equilibrium", "--scene", ship(), "--json", "--unstable"});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto json = nlohmann::json::parse(result.standard_output);
  EXPECT_EQ(json.at("outcome"), "floats");
  double energy = -std::numeric_limits<double>::infinity();
  bool unstable = false;
  for (const auto& at : json.at("attitudes")) {
    EXPECT_GE(at.at("energy").get<double>(), energy);
    energy = at.at("energy").get<double>();
    EXPECT_LE(at.at("residual_force").get<double>(), at.at("force_bound").get<double>());
    EXPECT_LE(at.at("residual_torque").get<double>(), at.at("torque_bound").get<double>());
    EXPECT_EQ(at.at("position").size(), 3U);
    EXPECT_EQ(at.at("quaternion_wxyz").size(), 4U);
    unstable = unstable || !at.at("stable").get<bool>();
    EXPECT_EQ(at.contains("reason"), !at.at("stable").get<bool>());
  }
  EXPECT_TRUE(unstable);
  bool upright = false;
  for (const auto& at : json.at("attitudes")) {
    if (!at.at("stable").get<bool>() || std::abs(at.at("heel").get<double>()) > 1e-6) continue;
    upright = true;
    EXPECT_NEAR(at.at("draft").get<double>(), 6.0, 1e-12);
    EXPECT_NEAR(at.at("position")[2].get<double>(), 0.0, 1e-12);
  }
  EXPECT_TRUE(upright);
}

TEST_F(HydrostaticsProgram, TakesAMeshWithAMass) {
  const std::string mesh = box();
  const FinishedProcess result =
      run({"equilibrium", "--mesh", mesh, "--mass", "4100", "--center-of-mass", "2,1,0.3", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto first = nlohmann::json::parse(result.standard_output).at("attitudes").at(0);
  EXPECT_NEAR(first.at("draft").get<double>(), 0.5, 1e-12);
  const FinishedProcess without_mass = run({"equilibrium", "--mesh", mesh});
  EXPECT_EQ(without_mass.exit_code, 2);
  EXPECT_TRUE(contains(without_mass.standard_error, "--mass"));
}

// A tenth of the ship's mass: the result, put into a scene, floats at the target.
TEST_F(HydrostaticsProgram, BallastsTheShipToATarget) {
  const std::string csv = dir_.path("ballast.csv");
  const FinishedProcess result =
      run({"ballast", "--scene", ship(), "--mass", "984000", "--heel", "2", "--trim=-0.5", "--csv", csv});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  EXPECT_EQ(csv_rows(read_file(csv)).at(0), (CsvRow{"mass", "x", "y", "z"}));
  const std::string start = "[body.client]\n";
  const std::string client = result.standard_output.substr(result.standard_output.find(start) + start.size());
  const FinishedProcess floats = run({"equilibrium", "--scene", scene(client), "--json"});
  ASSERT_EQ(floats.exit_code, 0) << floats.standard_error;
  bool found = false;
  const auto json = nlohmann::json::parse(floats.standard_output);
  for (const auto& at : json.at("attitudes")) {
    found = found || (std::abs(at.at("heel").get<double>() - 2.0) < 1e-7 &&
                      std::abs(at.at("trim").get<double>() + 0.5) < 1e-7);
  }
  EXPECT_TRUE(found) << floats.standard_output;
}

TEST_F(HydrostaticsProgram, SplitsBallastAndFindsItOnALine) {
  const FinishedProcess split =
      run({"ballast", "--scene", ship(), "--draft", "6.6", "--at=-10,0,-5", "--at", "30,0,-5", "--json"});
  ASSERT_EQ(split.exit_code, 0) << split.standard_error;
  const auto json = nlohmann::json::parse(split.standard_output);
  EXPECT_NEAR(json.at("ballast").at(0).at("mass").get<double>(), 738000.0, 1e-3);
  EXPECT_NEAR(json.at("ballast").at(1).at("mass").get<double>(), 246000.0, 1e-3);
  EXPECT_TRUE(json.at("stability_limit").is_null());
  const FinishedProcess line =
      run({"ballast", "--scene", ship(), "--mass", "1000", "--at", "9,0,-5", "--along", "x", "--json"});
  ASSERT_EQ(line.exit_code, 0) << line.standard_error;
  EXPECT_NEAR(
      nlohmann::json::parse(line.standard_output).at("ballast").at(0).at("position").at(0).get<double>(), 0.0,
      1e-6);
}

TEST_F(HydrostaticsProgram, SaysWhyBallastDoesNotDo) {
  struct Case {
    std::vector<std::string> arguments;
    int exit_code;
    const char* says;
  };
  const std::vector<Case> cases{
      {{"--mass", "1e6", "--at", "0,3,0"}, 1, "to port"},
      {{"--mass", "1e6", "--at", "0,0,40"}, 1, "in balance, but not stable: GM"},
      {{"--mass", "1e6", "--at", "0,0,40"}, 1, "outside of the hull"},
      {{"--mass", "1e6", "--at", "9,0,0", "--at", "5,0,0"}, 1, "it would take -"},
      {{"--draft", "5"}, 1, "takes -1.64e+06 kg"},
      {{}, 2, "neither --mass nor --draft"},
      {{"--mass", "1", "--heel", "0:4:1"}, 2, "one number"},
      {{"--mass", "1", "--at", "1,2"}, 2, "--at"},
      {{"--mass", "1", "--at", "1,2,3", "--at", "1,2,3", "--along", "x"},
       2,
       "at most two, or one with --along"},
      {{"--mass", "1", "--along", "up"}, 2, "--along"},
      {{"--mass", "1", "--body-mass", "2"}, 2, "with --scene"},
      {{"--mass", "1", "--html", "a.html"}, 2, "--html"},
  };
  for (const Case& each : cases) {
    std::vector<std::string> arguments{"ballast", "--scene", ship()};
    arguments.insert(arguments.end(), each.arguments.begin(), each.arguments.end());
    const FinishedProcess result = run(arguments);
    EXPECT_EQ(result.exit_code, each.exit_code) << result.standard_error;
    EXPECT_TRUE(contains(result.standard_error, each.says)) << result.standard_error;
  }
  const FinishedProcess mesh =
      run({"ballast", "--mesh", "a.obj", "--mass", "1", "--center-of-mass", "0,0,0"});
  EXPECT_EQ(mesh.exit_code, 2);
  EXPECT_TRUE(contains(mesh.standard_error, "--body-mass")) << mesh.standard_error;
}

// [m rad], under the curve of the wall-sided ship from 0 to a heel.
double wall_sided_area(double heel) {
  constexpr double kBm = 400.0 / 72.0;
  constexpr double kGm = 3.0 + kBm - 8.0;
  return kGm * (1.0 - std::cos(heel)) + 0.5 * kBm * (1.0 / std::cos(heel) + std::cos(heel) - 2.0);
}

TEST_F(HydrostaticsProgram, ReportsDeckEdgeAndDownflooding) {
  const std::string file = ship();
  const FinishedProcess result = run({"gz", "--scene", file, "--json", "--heel", "0:60:20", "--deck-edge",
                                      "0,10,6", "--deck-edge", "5,-10,4", "--downflooding=0,-10,6"});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto json = nlohmann::json::parse(result.standard_output);
  EXPECT_NEAR(json.at("deck_edge").at("starboard").at("heel").get<double>(), std::atan(0.4) / kDegree, 1e-9);
  EXPECT_EQ(json.at("deck_edge").at("starboard").at("point"), 1);
  EXPECT_NEAR(json.at("deck_edge").at("port").at("heel").get<double>(), -std::atan(0.6) / kDegree, 1e-9);
  EXPECT_EQ(json.at("deck_edge").at("port").at("point"), 0);
  const double flooding = std::atan(0.6);
  EXPECT_NEAR(json.at("downflooding").at("starboard").at("heel").get<double>(), flooding / kDegree, 1e-9);
  const auto& criteria = json.at("criteria").at("values");
  EXPECT_NEAR(criteria.at(1).at("value").get<double>(), wall_sided_area(flooding), 1e-10);
  EXPECT_EQ(criteria.at(1).at("name"), "area from 0 to downflooding at 30.96 degrees");
  EXPECT_NEAR(criteria.at(2).at("value").get<double>(),
              wall_sided_area(flooding) - wall_sided_area(30.0 * kDegree), 1e-10);
  EXPECT_EQ(criteria.at(2).at("met"), false);

  const FinishedProcess text = run({"gz", "--scene", file, "--heel", "0", "--deck-edge", "0,-10,6"});
  EXPECT_TRUE(
      contains(text.standard_output, "deck edge under water to starboard: 30.963757 degrees, point 1\n"));
  EXPECT_FALSE(contains(text.standard_output, "downflooding"));
  const auto without =
      nlohmann::json::parse(run({"gz", "--scene", file, "--json", "--heel", "0"}).standard_output);
  EXPECT_TRUE(without.at("deck_edge").is_null());
  EXPECT_EQ(without.at("criteria").at("values").at(1).at("name"), "area from 0 to 40 degrees");
}

TEST_F(HydrostaticsProgram, EndsCriteriaWhereWaterComesInEarly) {
  const std::string opening = "0,-5," + std::to_string(5.0 * std::tan(24.0 * kDegree));
  const FinishedProcess result =
      run({"gz", "--scene", ship(), "--json", "--heel", "0", "--downflooding", opening});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto criteria = nlohmann::json::parse(result.standard_output).at("criteria").at("values");
  const std::string end = "downflooding at 24 degrees";
  const std::array<std::string, 5> names{"area from 0 to 30 degrees, cut at downflooding",
                                         "area from 0 to " + end, "area from 30 to " + end,
                                         "largest GZ at 30 degrees or more", "heel of the largest GZ"};
  // The area is beyond that of the code at 30 degrees, to which the curve does not come.
  const double area = wall_sided_area(24.0 * kDegree);
  EXPECT_GT(area, 0.055);
  const std::array<double, 5> values{area, area, 0.0, 0.0, 24.0};
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(criteria.at(i).at("name"), names[i]);
    EXPECT_NEAR(criteria.at(i).at("value").get<double>(), values[i], 1e-5);
    EXPECT_EQ(criteria.at(i).at("met"), false) << names[i];
  }
  EXPECT_EQ(criteria.at(5).at("met"), true);

  // Between 30 and 40 degrees the largest arm is that at the end; an opening that is under water upright
  // leaves no curve.
  const auto with_opening_at = [&](double degrees) {
    const std::string at = "0,-5," + std::to_string(5.0 * std::tan(degrees * kDegree));
    return nlohmann::json::parse(
               run({"gz", "--scene", ship(), "--json", "--heel", "0", "--downflooding", at}).standard_output)
        .at("criteria")
        .at("values");
  };
  const auto late = with_opening_at(30.5);
  EXPECT_EQ(late.at(0).at("met"), true);
  EXPECT_NEAR(late.at(4).at("value").get<double>(), 30.5, 1e-4);
  EXPECT_GT(late.at(3).at("value").get<double>(), 0.740740741);
  EXPECT_LT(late.at(3).at("value").get<double>(), 0.79);
  const auto upright = with_opening_at(-1.0);
  EXPECT_EQ(upright.size(), 6U);
  EXPECT_EQ(upright.at(1).at("value"), 0.0);
}

TEST_F(HydrostaticsProgram, TakesWaterScaleAndOpenPolicyWithAMesh) {
  // A tub of 2 x 1 x 0.5 without a lid.
  const std::string mesh = dir_.write("tub.obj",
                                      "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n"
                                      "v 0 0 0.5\nv 2 0 0.5\nv 2 1 0.5\nv 0 1 0.5\n"
                                      "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const std::vector<std::string> closed{"equilibrium",      "--mesh",  mesh,        "--mass",  "2000",
                                        "--center-of-mass", "2,1,0.2", "--json",    "--scale", "2",
                                        "--density",        "1000",    "--gravity", "1.62"};
  const FinishedProcess refused = run(closed);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.standard_error, "dry_boundary"));
  std::vector<std::string> open = closed;
  open.insert(open.end(), {"--open", "dry_boundary"});
  const FinishedProcess result = run(open);
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto json = nlohmann::json::parse(result.standard_output);
  ASSERT_EQ(json.at("attitudes").size(), 1U);
  const auto& at = json.at("attitudes").at(0);
  EXPECT_NEAR(at.at("draft").get<double>(), 0.25, 1e-12);
  EXPECT_NEAR(at.at("energy").get<double>(), 1.62 * 2000.0 * (0.2 - 0.25 + 0.125), 1e-9);

  open.front() = "gz";
  open.insert(open.end(), {"--heel", "0:60:20"});
  const FinishedProcess capsized = run(open);
  EXPECT_EQ(capsized.exit_code, 1);
  // Heeled by 45 degrees it displaces a prism, up to its edge: 4 times 1 x 1 / 2 m^3.
  EXPECT_TRUE(contains(capsized.standard_error, "no balance at a heel of 60 degrees"));
  EXPECT_TRUE(contains(capsized.standard_error, "takes in water"));
  const auto curve = nlohmann::json::parse(capsized.standard_output);
  ASSERT_EQ(curve.at("points").size(), 3U);
  EXPECT_EQ(curve.at("points").at(2).at("heel"), 40.0);
  EXPECT_DOUBLE_EQ(curve.at("unbalanced_starboard").get<double>(), 60.0);
  EXPECT_EQ(curve.at("unbalanced_port"), nullptr);
  EXPECT_TRUE(curve.at("criteria").at("values").empty());

  open.back() = "60:80:20";
  const FinishedProcess nothing = run(open);
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_TRUE(nothing.standard_output.empty());
  EXPECT_TRUE(contains(nothing.standard_error, "no balance at a heel of 60 degrees"));
}

TEST_F(HydrostaticsProgram, SaysThatAMassIsAssumed) {
  const std::string undefined = scene("center_of_mass = [0, 0, 2]\n");
  const FinishedProcess arms = run({"gz", "--scene", undefined, "--heel", "0:10:5"});
  EXPECT_EQ(arms.exit_code, 0);
  EXPECT_TRUE(contains(arms.standard_error, "a mass of 9.84e+06 kg is assumed")) << arms.standard_error;
  EXPECT_EQ(run({"table", "--scene", undefined, "--draft", "6:6:1"}).standard_error, "");
  EXPECT_EQ(run({"gz", "--scene", ship(), "--heel", "0:10:5"}).standard_error, "");
}

// A barge whose middle is beside the origin of its mesh, with its mass to port, whichever axes of the mesh
// are its own: every result is that of closed forms.
// A hull without a mass: all but MCT1cm and RM1deg, which need the centre of mass.
TEST_F(HydrostaticsProgram, PrintsATableWithoutAMass) {
  const std::string mesh = box();
  const std::string bare = dir_.write(
      "bare.toml",
      "[[body]]\nid = 1\nmesh = \"box.obj\"\n[[body]]\nid = 2\nmesh = \"box.obj\"\n[body.client]\n");
  for (const std::vector<std::string>& hull : {std::vector<std::string>{"--mesh", mesh},
                                               {"--scene", bare, "--body", "1"},
                                               {"--scene", bare, "--body", "2"}}) {
    std::vector<std::string> arguments{"table", "--draft", "0.5", "--json"};
    arguments.insert(arguments.end(), hull.begin(), hull.end());
    const FinishedProcess result = run(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const nlohmann::json row = nlohmann::json::parse(result.standard_output).at("rows").at(0);
    EXPECT_NEAR(row.at("displacement_volume").get<double>(), 4.0, 1e-12);
    EXPECT_NEAR(row.at("kb").get<double>(), 0.25, 1e-12);
    EXPECT_NEAR(row.at("bm_t").get<double>(), 2.0 / 3.0, 1e-12);
    EXPECT_TRUE(row.at("mct1cm").is_null());
    EXPECT_TRUE(row.at("rm1deg").is_null());
    arguments[3] = "--keel=0";
    EXPECT_TRUE(contains(run(arguments).standard_output, "no MCT1cm and no RM1deg"));
  }
  const FinishedProcess refused = run({"equilibrium", "--mesh", mesh});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.standard_error, "expected --mass and --center-of-mass of the body"));
  EXPECT_EQ(run({"gz", "--scene", bare, "--body", "1"}).exit_code, 2);
}

// In a world whose z axis points down the ship's -z axis is up; `up` of the body and --up say otherwise.
TEST_F(HydrostaticsProgram, TakesUpFromTheSceneAndTheBody) {
  const auto heel = [this](const std::string& up, std::vector<std::string> options) {
    options.insert(options.end(),
                   {"equilibrium", "--json", "--scene",
                    dir_.write("ned.toml", "[world]\nup = [0, 0, -1]\n[[body]]\nid = 1\n" + up +
                                               "shape = { type = \"box\", size = [9, 6, 2] }\n"
                                               "[body.client]\ndensity = 500\n"
                                               "center_of_mass = [0, 0, 0.4]\n")});
    const FinishedProcess result = run(options);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return std::abs(
        nlohmann::json::parse(result.standard_output).at("attitudes").at(0).at("heel").get<double>());
  };
  EXPECT_NEAR(heel("", {}), 0.0, 1e-6);
  EXPECT_NEAR(heel("", {"--up", "z"}), 180.0, 1e-6);
  EXPECT_NEAR(heel("up = \"z\"\n", {}), 180.0, 1e-6);
  EXPECT_NEAR(heel("up = \"y\"\n", {}), 90.0, 1e-6);
  EXPECT_NEAR(heel("up = \"y\"\n", {"--up=-z"}), 0.0, 1e-6);
}

TEST_F(HydrostaticsProgram, AgreesWithClosedFormsInAnyFrameOfTheMesh) {
  constexpr double kToPort = 0.15;  // [m], of the mass from the middle
  constexpr double kBm = 400.0 / 72.0;
  struct Frame {
    const char* forward;
    const char* up;
    Vec3 forward_B, up_B;
    double scale;
  };
  for (const Frame& frame : {Frame{"x", "z", Vec3::UnitX(), Vec3::UnitZ(), 1.0},
                             Frame{"-y", "+z", -Vec3::UnitY(), Vec3::UnitZ(), 0.5},
                             Frame{"z", "y", Vec3::UnitZ(), Vec3::UnitY(), 0.001},
                             Frame{"-x", "-y", -Vec3::UnitX(), -Vec3::UnitY(), 1024.0}}) {
    // Not a structured binding, which lambdas cannot capture in clang 14.
    const auto forward = frame.forward, up = frame.up;
    const Vec3 forward_B = frame.forward_B, up_B = frame.up_B;
    const double scale = frame.scale;
    SCOPED_TRACE(std::string(forward) + " " + up);
    const auto at = [&, port_B = Vec3(up_B.cross(forward_B))](double ahead, double to_port, double above) {
      return Vec3((7.0 + ahead) * forward_B + (to_port - 3.0) * port_B + (4.0 + above) * up_B);
    };
    const auto text = [&](double ahead, double to_port, double above) {
      const Vec3 point_B = at(ahead, to_port, above);
      return format_shortest(point_B.x()) + "," + format_shortest(point_B.y()) + "," +
             format_shortest(point_B.z());
    };
    std::string obj;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 v = at((corner & 1) != 0 ? 40.0 : -40.0, (corner & 2) != 0 ? 10.0 : -10.0,
                        (corner & 4) != 0 ? 6.0 : -6.0) /
                     scale;
      obj +=
          "v " + format_shortest(v.x()) + " " + format_shortest(v.y()) + " " + format_shortest(v.z()) + "\n";
    }
    obj += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    const auto json = [&](std::vector<std::string> arguments) {
      for (const std::string& one :
           {std::string("--mesh"), dir_.write("barge.obj", obj), std::string("--mass=9840000"),
            "--center-of-mass=" + text(0.0, kToPort, 2.0), std::string("--forward=") + forward,
            std::string("--up=") + up, "--scale=" + format_shortest(scale), std::string("--json")}) {
        arguments.push_back(one);
      }
      const FinishedProcess result = run(arguments);
      EXPECT_EQ(result.exit_code, 0) << result.standard_error;
      return nlohmann::json::parse(result.standard_output);
    };
    const auto arms = json({"gz", "--heel", "-20:30:10", "--deck-edge=" + text(0, 10, 6),
                            "--deck-edge=" + text(5, -10, 4), "--downflooding=" + text(-2, -10, 5.5)});
    for (const auto& point : arms.at("points")) {
      const double heel = point.at("heel").get<double>() * kDegree;
      const double t = std::tan(heel);
      EXPECT_NEAR(point.at("gz").get<double>(),
                  (3.0 + kBm - 8.0 + 0.5 * kBm * t * t) * std::sin(heel) + kToPort * std::cos(heel), 1e-7)
          << heel;
      EXPECT_NEAR(point.at("area").get<double>(), wall_sided_area(heel) + kToPort * std::sin(heel), 1e-7);
      EXPECT_NEAR(point.at("trim").get<double>(), 0.0, 1e-6);
      EXPECT_NEAR(point.at("draft").get<double>(), 6.0 * std::cos(heel) + 10.0 * std::abs(std::sin(heel)),
                  1e-7);
    }
    EXPECT_NEAR(arms.at("deck_edge").at("starboard").at("heel").get<double>(), std::atan(0.4) / kDegree,
                1e-7);
    EXPECT_EQ(arms.at("deck_edge").at("starboard").at("point"), 1);
    EXPECT_NEAR(arms.at("deck_edge").at("port").at("heel").get<double>(), -std::atan(0.6) / kDegree, 1e-7);
    EXPECT_EQ(arms.at("deck_edge").at("port").at("point"), 0);
    const double flooding = std::atan(0.55);  // 28.8 degrees: short of 30
    EXPECT_NEAR(arms.at("downflooding").at("starboard").at("heel").get<double>(), flooding / kDegree, 1e-7);
    const double area = wall_sided_area(flooding) + kToPort * std::sin(flooding);
    const std::array<double, 6> criteria{area, area, 0.0, 0.0, flooding / kDegree, 3.0 + kBm - 8.0};
    for (std::size_t i = 0; i < criteria.size(); ++i) {
      EXPECT_NEAR(arms.at("criteria").at("values").at(i).at("value").get<double>(), criteria[i], 1e-5) << i;
    }
    // With the bow up, what is displaced lies abaft of midship.
    const double trim = std::tan(1.5 * kDegree);
    const auto row = json({"table", "--draft", "2.5", "--trim", "1.5"}).at("rows").at(0);
    EXPECT_NEAR(row.at("displacement_volume").get<double>(), 80.0 * 20.0 * 2.5, 1e-6);
    EXPECT_NEAR(row.at("lcb").get<double>(), -6400.0 / 12.0 * trim / 2.5, 1e-6);
    EXPECT_NEAR(row.at("tcb").get<double>(), -3.0, 1e-9);
    EXPECT_NEAR(row.at("kb").get<double>(), 1.25 + 6400.0 / 24.0 * trim * trim / 2.5, 1e-6);
    EXPECT_NEAR(row.at("lcf").get<double>(), 0.0, 1e-6);
  }
}

TEST_F(HydrostaticsProgram, WarnsOfAMeshWhoseUpAxisIsNotTheShips) {
  const std::string mesh = dir_.write("side.dae", tetrahedron::collada("<up_axis>Y_UP</up_axis>"));
  const auto error_with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"equilibrium", "--mesh",           mesh,         "--mass",
                                       "80",          "--center-of-mass", "0.2,0.2,0.2"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const FinishedProcess result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return result.standard_error;
  };
  const std::string warning = error_with({});
  EXPECT_TRUE(contains(warning, ": warning: "));
  EXPECT_TRUE(contains(warning, "expected z of the body, which is the ship's upward axis"));
  EXPECT_TRUE(contains(warning, "Pass --up y; in a scene file, orientation = [0.70710678"));
  EXPECT_EQ(error_with({"--up", "y"}), "");
  EXPECT_EQ(error_with({"--up=+y"}), "");
  EXPECT_TRUE(contains(error_with({"--up=-y"}), "expected -y of the body"));
  // The axis is that of the mesh as it is scaled.
  EXPECT_TRUE(contains(error_with({"--scale=1,-1,1"}), "Pass --up=-y;"));
  EXPECT_EQ(error_with({"--scale=1,-1,1", "--up=-y"}), "");
}

TEST_F(HydrostaticsProgram, SaysThatABodySinks) {
  const std::string heavy = scene("density = 1100\n");
  const FinishedProcess result = run({"equilibrium", "--scene", heavy, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.standard_error;
  EXPECT_EQ(nlohmann::json::parse(result.standard_output).at("outcome"), "sinks");
  const FinishedProcess arms = run({"gz", "--scene", heavy});
  EXPECT_EQ(arms.exit_code, 1);
  EXPECT_TRUE(contains(arms.standard_error, "sinks"));
}

// 19,200 m^3 of 1,100 kg/m^3, in water of 1,025.
TEST_F(HydrostaticsProgram, SaysHowABodyThatSinksRests) {
  const std::string client = "density = 1100\ncenter_of_mass = [0.03, -0.04, -0.12]\n";
  const auto submerged = [&](const std::string& more) {
    const FinishedProcess result = run({"equilibrium", "--scene", scene(client, more), "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return nlohmann::json::parse(result.standard_output).at("submerged");
  };
  const double buoyancy = 1025.0 * 9.80665 * 19200.0;
  const double net_weight = 75.0 * 9.80665 * 19200.0;
  const auto rest = submerged("");
  EXPECT_NEAR(rest.at("heel").get<double>(), std::atan2(4.0, 12.0) / kDegree, 1e-9);
  EXPECT_NEAR(rest.at("trim").get<double>(), std::asin(-3.0 / 13.0) / kDegree, 1e-9);
  EXPECT_EQ(rest.at("quaternion_wxyz").size(), 4U);
  EXPECT_EQ(rest.at("family"), "none");
  EXPECT_NEAR(rest.at("bg").get<double>(), 0.13, 1e-12);
  for (const auto& moment : rest.at("righting_moment_per_degree")) {
    EXPECT_NEAR(moment.get<double>(), buoyancy * 0.13 * std::sin(kDegree), 1e-3);
  }
  EXPECT_NEAR(rest.at("net_weight").get<double>(), net_weight, 1e-3);
  EXPECT_EQ(rest.at("motion"), "sinks");
  EXPECT_TRUE(rest.at("terminal_speed").is_null());
  // Quadratic drag of equal coefficients c along the axes: c v |v|, of each component by itself.
  const auto with_drag = submerged("[body.drag]\nquadratic = [1e6, 1e6, 1e6, 0, 0, 0]\n");
  const double cubes = (3.0 * 3.0 * 3.0 + 4.0 * 4.0 * 4.0 + 12.0 * 12.0 * 12.0) / (13.0 * 13.0 * 13.0);
  EXPECT_NEAR(with_drag.at("terminal_speed").get<double>(), std::sqrt(net_weight / (1e6 * cubes)), 1e-9);

  const FinishedProcess text = run({"equilibrium", "--scene", scene(client)});
  EXPECT_TRUE(
      contains(text.standard_output,
               "The body sinks: it is heavier than the water that it can displace.\n"
               "Fully submerged it rests at a heel of 18.4349 and a trim of -13.3424 degrees, BG 0.13 m.\n"
               "Righting moment per degree: 4.3787e+05 N m.\n"
               "Net weight 1.41216e+07 N: it sinks, ever faster, since no drag is given.\n"))
      << text.standard_output;
}

TEST_F(HydrostaticsProgram, SaysWhenACompartmentSinksTheBody) {
  const std::string flooded =
      "[[body.compartment]]\nshape = { type = \"box\", size = [40, 20, 12] }\n"
      "position = [20, 0, 0]\npermeability = 1\nflooded = 1\n";
  const std::string heavy =
      scene("density = 768.75\n", flooded);  // three quarters of the hull's displacement
  const FinishedProcess result = run({"equilibrium", "--scene", heavy, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.standard_error;
  const auto rest = nlohmann::json::parse(result.standard_output).at("submerged");
  EXPECT_NEAR(rest.at("trim").get<double>(), -90.0, 1e-6) << "the stern displaces, 20 m behind the mass";
  EXPECT_NEAR(rest.at("bg").get<double>(), 20.0, 1e-9);
}

TEST_F(HydrostaticsProgram, ReportsAFloatingBodySubmergedOnRequest) {
  const FinishedProcess plain = run({"equilibrium", "--scene", ship()});
  EXPECT_FALSE(contains(plain.standard_output, "ubmerged"));
  const FinishedProcess text = run({"equilibrium", "--scene", ship(), "--submerged"});
  EXPECT_TRUE(text.standard_output.starts_with(plain.standard_output));
  EXPECT_TRUE(contains(text.standard_output, "Net weight -9.64974e+07 N: it rises, ever faster"))
      << text.standard_output;
  const std::string even = scene("density = 1025\n");
  EXPECT_TRUE(
      contains(run({"equilibrium", "--scene", even}).standard_output,
               "Fully submerged it rests in any attitude: its centre of mass is at that of buoyancy.\n"));
  const FinishedProcess json = run({"equilibrium", "--scene", even, "--json"});
  const auto rest = nlohmann::json::parse(json.standard_output).at("submerged");
  EXPECT_EQ(rest.at("family"), "sphere");
  EXPECT_EQ(rest.at("motion"), "hovers");
  EXPECT_EQ(rest.at("terminal_speed"), 0.0);
  EXPECT_EQ(run({"gz", "--scene", ship(), "--submerged"}).exit_code, 2);
}

TEST_F(HydrostaticsProgram, WritesAPageBesideJsonAndCsv) {
  const std::string page = dir_.path("gz.html");
  const FinishedProcess result = run(
      {"gz", "--scene", ship(), "--heel", "0:40:10", "--json", "--csv", dir_.path("gz.csv"), "--html", page});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  EXPECT_EQ(nlohmann::json::parse(result.standard_output).at("points").size(), 5U);
  EXPECT_EQ(csv_rows(read_file(dir_.path("gz.csv"))).size(), 6U);
  const std::string html = read_file(page);
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(contains(html, "WebGLRenderer"));
  EXPECT_FALSE(contains(html, "<!-- data -->"));
  EXPECT_TRUE(html.ends_with("</html>\n"));
}

TEST_F(HydrostaticsProgram, SaysWhyAPageCannotBeWritten) {
  const std::string file = ship();
  const FinishedProcess absent =
      run({"equilibrium", "--scene", file, "--html", dir_.path("no/such/page.html")});
  EXPECT_EQ(absent.exit_code, 1);
  EXPECT_TRUE(contains(absent.standard_error, "No such file or directory"));
  const FinishedProcess full = run({"equilibrium", "--scene", file, "--html", "/dev/full"});
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_TRUE(contains(full.standard_error, "No space left on device"));
  const std::string page = dir_.path("page.html");
  const FinishedProcess three =
      run({"equilibrium", "--scene", file, "--html", page, "--three", dir_.path("three.js")});
  EXPECT_EQ(three.exit_code, 1);
  EXPECT_TRUE(contains(three.standard_error, "libjs-three"));
  EXPECT_FALSE(std::filesystem::exists(page));
  const FinishedProcess scene_itself = run({"equilibrium", "--scene", file, "--html", file});
  EXPECT_EQ(scene_itself.exit_code, 2);
  EXPECT_EQ(run({"equilibrium", "--scene", file, "--html", page, "--csv", page}).exit_code, 2);
  EXPECT_EQ(run({"equilibrium", "--scene", file, "--three", "/dev/null"}).exit_code, 2);
}

TEST_F(HydrostaticsProgram, WritesTankTablesOfABodyWithoutAMass) {
  const std::string tanks = R"([[body.tank]]
name = "wing"
shape = { type = "box", size = [6, 4, 2] }
position = [1, 2, 3]
density = 900
fill = 0.5
[[body.tank]]
shape = { type = "box", size = [6, 4, 2] }
fill = 0
surface = "none"
fill_axis = "x"
)";
  const std::string path =
      dir_.write("tanks.toml", "[[body]]\nid = 1\nshape = { type = \"box\", size = [80, 20, 12] }\n" + tanks);
  const FinishedProcess result =
      run({"tanks", "--scene", path, "--trim", "0:1:1", "--json", "--csv", dir_.path("tanks.csv")});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto rows = csv_rows(read_file(dir_.path("tanks.csv")));
  EXPECT_EQ(rows.at(0), (CsvRow{"tank", "trim", "heel", "sounding", "volume", "fill", "mass", "x", "y", "z",
                                "fsm_t", "fsm_l"}));
  ASSERT_EQ(rows.size(), 1U + 2U * 2U * 11U);
  const std::vector<double> expected{0, 0, 0, 1, 24, 0.5, 21.6, 1, 2, 2.5, 28.8, 64.8};
  const std::vector<double> half = numbers_of(rows[6]);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(half[i], expected[i], 1e-12) << rows[0][i];
  const auto json = nlohmann::json::parse(result.standard_output).at("tanks");
  EXPECT_EQ(json.at(0).at("name"), "wing");
  EXPECT_EQ(json.at(0).at("piston"), false);
  EXPECT_TRUE(json.at(0).at("rows").at(0).at("x").is_null()) << "empty";
  EXPECT_EQ(json.at(1).at("piston"), true);
  EXPECT_EQ(json.at(1).at("rows").at(5).at("fsm_t"), 0.0);

  const FinishedProcess one =
      run({"tanks", "--scene", path, "--tank", "0", "--sounding", "0:2:0.5", "--heel", "5"});
  ASSERT_EQ(one.exit_code, 0) << one.standard_error;
  EXPECT_TRUE(contains(one.standard_output, "tank 0 'wing': 48 m^3")) << one.standard_output;
  EXPECT_FALSE(contains(one.standard_output, "tank 1"));
}

TEST_F(HydrostaticsProgram, TakesAMeshAsATank) {
  const std::string mesh =
      dir_.write("tank.obj",
                 "v 0 0 0\nv 4 0 0\nv 4 2 0\nv 0 2 0\nv 0 0 1\nv 4 0 1\nv 4 2 1\nv 0 2 1\n"
                 "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const FinishedProcess result =
      run({"tanks", "--mesh", mesh, "--density", "800", "--sounding", "0.5", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto at = nlohmann::json::parse(result.standard_output).at("tanks").at(0).at("rows").at(0);
  EXPECT_NEAR(at.at("mass").get<double>(), 3.2, 1e-12);
  EXPECT_NEAR(at.at("fsm_t").get<double>(), 0.8 * 4.0 * 8.0 / 12.0, 1e-12);
}

TEST_F(HydrostaticsProgram, SaysWhyThereIsNoTankTable) {
  const std::string tank =
      scene("", "[[body.tank]]\nshape = { type = \"box\", size = [1, 1, 1] }\nfill = 0\n");
  const std::string none =
      dir_.write("none.toml", "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1] }\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"tanks", "--scene", none}, "a body without tanks"},
      {{"tanks", "--scene", tank, "--tank", "1"}, "--tank: 1"},
      {{"tanks", "--scene", tank, "--heel", "90"}, "--heel: 90 degrees"},
      {{"tanks", "--scene", tank, "--sounding-at", "0,0"}, "--sounding-at"},
      {{"tanks", "--scene", tank, "--sounding-at", "0,0,1"}, "a point lower than"},
      {{"tanks", "--scene", tank, "--html", dir_.path("a.html")}, "--html: with another command"},
      {{"gz", "--scene", tank, "--sounding", "1"}, "--sounding: with another command"},
      {{"tanks", "--mesh",
        dir_.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"), "--open",
        "dry_boundary"},
       "an open mesh"}};
  for (const auto& [arguments, expected] : wrong) {
    const FinishedProcess result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << expected;
    EXPECT_TRUE(contains(result.standard_error, expected)) << result.standard_error;
  }
}

TEST_F(HydrostaticsProgram, RejectsWrongArguments) {
  const std::string good = ship();
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"gz"},
      {"float", "--scene", good},
      {"table", "--scene", good},
      {"table", "--scene", good, "--draft", "5:1:1"},
      {"table", "--scene", good, "--draft", "1:5:0"},
      {"table", "--scene", good, "--draft", "1:5:1e-9"},
      {"gz", "--scene", good, "--heel", "0:200:10"},
      {"gz", "--scene", good, "--draft", "1:5:1"},
      {"gz", "--scene", good, "--trim", "1"},
      {"gz", "--scene", good, "--fixed-trim", "--trim", "0:2:1"},
      {"gz", "--scene", good, "--forward", "+z"},
      {"gz", "--scene", good, "--forward", "ahead"},
      {"gz", "--scene", good, "--body", "4"},
      {"gz", "--scene", good, "--csv", good},
      {"gz", "--scene", good, "--deck-edge", "1,2"},
      {"gz", "--scene", good, "--downflooding", "1,2,nan"},
      {"table", "--scene", good, "--draft", "1", "--deck-edge", "1,2,3"},
      {"equilibrium", "--scene", good, "--downflooding", "1,2,3"},
      {"gz", "--scene", good, "--mass", "1"},
      {"gz", "--scene", good, "--at", "1,2,3"},
      {"gz", "--scene", good, "--density", "1000"},
      {"gz", "--scene", good, "--scale", "2"},
      {"gz", "--mesh", "a.obj", "--mass", "1", "--center-of-mass", "0,0,0", "--scale", "0"},
      {"gz", "--mesh", "a.obj", "--mass", "1", "--center-of-mass", "0,0,0", "--scale", "1,0,1"},
      {"gz", "--mesh", "a.obj", "--mass", "1", "--center-of-mass", "0,0,0", "--up", "w"},
      {"gz", "--scene", good, "--open", "dry_boundary"},
      {"gz", "--mesh", "a.obj", "--mass", "1", "--center-of-mass", "0,0,0", "--gravity", "0"},
      {"gz", "--mesh", "a.obj", "--mass", "1", "--center-of-mass", "0,0,0", "--open", "maybe"},
      {"table", "--scene", good, "--draft", "1", "--aft-perpendicular", "9", "--forward-perpendicular", "3"}};
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    const FinishedProcess result = run(wrong[i]);
    EXPECT_NE(result.exit_code, 0) << i;
    EXPECT_FALSE(result.standard_error.empty()) << i;
    EXPECT_TRUE(result.standard_output.empty()) << i << result.standard_output;
  }
}

TEST(HydrostaticsPageData, DrawsEveryPartThatDisplaces) {
  const HydrostaticMesh mesh = make_hydrostatic_mesh({make_shape(BoxShape{{2, 1, 1}, {1, 1, 1}}), {}});
  const std::vector<PlacedMesh> pontoons{
      {.mesh = &mesh, .position_B = Vec3(5, 2, 0)},
      {.mesh = &mesh, .position_B = Vec3(5, -2, 0)},
      {.mesh = &mesh, .position_B = Vec3(5, 2, 0), .signed_permeability = -0.25}};
  const Water water;
  const FloatingBody body = FloatingBody::make(pontoons, 1500.0, Vec3(5, 0, 0)).value();
  const PageSubject subject{.name = "pontoons", .body = &body, .water = &water, .axes = {}};
  const std::string page = equilibria_page(subject, find_equilibria(body, water), nullptr, "");
  constexpr std::string_view kStart = "id=\"data\">";
  const std::size_t start = page.find(kStart) + kStart.size();
  const auto data = nlohmann::json::parse(page.substr(start, page.find("</script>", start) - start));
  const auto& drawn = data.at("model").at("meshes").at(0);
  EXPECT_EQ(drawn.at("triangles"), 24);
  EXPECT_NEAR(drawn.at("diagonal").get<double>(), std::sqrt(4.0 + 25.0 + 1.0), 1e-6);
  EXPECT_EQ(drawn.at("center"), nlohmann::json({5.0, 2.0, 0.0}));
  EXPECT_NEAR(drawn.at("volume").get<double>(), 3.5, 1e-12);
  EXPECT_GT(data.at("rows"), 0);
}

TEST(HydrostaticsRange, IncludesItsEndWhereAStepMeetsIt) {
  EXPECT_EQ(parse_range("--heel", "0:1:0.1")->size(), 11U);
  EXPECT_EQ(parse_range("--heel", "0:1:0.1")->back(), 1.0);
  EXPECT_EQ(parse_range("--heel", "0:1:0.3")->size(), 4U);
  EXPECT_EQ(*parse_range("--heel", "-5"), std::vector<double>{-5.0});
  EXPECT_EQ(*parse_range("--heel", "2:2:1"), std::vector<double>{2.0});
  for (const char* text : {"", "a", "1:2", "1:2:3:4", "2:1:1", "0:1:-1", "0:nan:1", "0:inf:1", "0:1:1e-6"}) {
    EXPECT_FALSE(parse_range("--heel", text)) << text;
  }
}

}  // namespace
}  // namespace buoyancy::service
