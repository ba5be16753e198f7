// The weather criterion, permissible KG, drafts at marks, freeboards and parts of buoyancy-hydrostatics.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/angles.h"
#include "geometry/shapes.h"
#include "service/hydrostatics/kg_limit.h"
#include "tests/flotation/box_section.h"
#include "tests/support/child_process.h"
#include "tests/support/contains.h"
#include "tests/support/csv.h"
#include "tests/support/temp_dir.h"

namespace buoyancy::service {
namespace {

FinishedProcess run(std::vector<std::string> arguments) {
  return run_program("buoyancy-hydrostatics", std::move(arguments));
}

// Beam 20, depth 12 [m], with B's origin in the middle.
class KgLimitOfABox : public testing::Test {
 protected:
  static FloatingBody body_with(const HydrostaticMesh& mesh, double draft, double kg) {
    const PlacedMesh placed{.mesh = &mesh};
    return FloatingBody::make({&placed, 1}, Water{}.density * 80.0 * 20.0 * draft, Vec3(0, 0, kg - 6.0))
        .value();
  }
  std::optional<KgLimit> limit(double draft, const WeatherInputs* weather = nullptr,
                               double trim = 0.0) const {
    return kg_limit(body_, water_, table_, draft, trim, {}, {}, weather);
  }

  Water water_;
  HydrostaticMesh mesh_ = make_hydrostatic_mesh({make_shape(BoxShape{{80, 20, 12}, {2, 2, 2}}), {}});
  FloatingBody body_ = body_with(mesh_, 6.0, 6.0);
  HydrostaticTable table_ = HydrostaticTable::make(body_, water_).value();
};

// How far the general criteria are met by a clipped rectangle, by the beginnings of their names.
std::vector<std::pair<std::string, double>> independent_margins(const BoxSection& box, double kg) {
  constexpr double kThirty = 30.0 * kRadiansPerDegree;
  constexpr double kForty = 40.0 * kRadiansPerDegree;
  constexpr double kTwentyFive = 25.0 * kRadiansPerDegree;
  double largest = 0.0;
  for (int tenth = 300; tenth <= 900; ++tenth) {
    largest = std::max(largest, box.gz(0.1 * tenth * kRadiansPerDegree, kg));
  }
  // The arm of a box has one maximum, which is beyond 25 degrees while the arm rises there.
  const double rise = box.gz(kTwentyFive + 1e-4, kg) - box.gz(kTwentyFive - 1e-4, kg);
  const double gm = 0.5 * box.draft + box.beam * box.beam / (12.0 * box.draft) - kg;
  return {{"area from 0 to 30", box.area(0.0, kThirty, kg) - 0.055},
          {"area from 0 to 40", box.area(0.0, kForty, kg) - 0.090},
          {"area from 30", box.area(kThirty, kForty, kg) - 0.030},
          {"largest GZ", largest - 0.20},
          {"heel of the largest", rise},
          {"GM", gm - 0.15}};
}

TEST_F(KgLimitOfABox, IsWhereAnIndependentCriterionStopsToHold) {
  std::set<std::string> governing;
  int limits = 0;
  for (const double draft : {2.0, 6.0, 8.0, 9.0, 10.0}) {
    const std::optional<KgLimit> found = limit(draft);
    ASSERT_TRUE(found && found->kg_max) << draft;
    EXPECT_NEAR(found->mass, 1025.0 * 1600.0 * draft, 1e-3);
    const BoxSection box{.beam = 20.0, .depth = 12.0, .draft = draft};
    for (const auto& [name, margin] : independent_margins(box, *found->kg_max - 1e-4)) {
      EXPECT_GT(margin, 0.0) << draft << ' ' << name;
    }
    for (const auto& [name, margin] : independent_margins(box, *found->kg_max + 1e-3)) {
      if (found->governing.starts_with(name)) {
        EXPECT_LT(margin, 0.0) << draft << ' ' << name;
        governing.insert(name);
        ++limits;
      }
    }
  }
  EXPECT_EQ(limits, 5);
  EXPECT_GE(governing.size(), 3U);  // several criteria govern
}

TEST_F(KgLimitOfABox, MeetsTheGoverningCriterionWithEquality) {
  for (const double draft : {6.0, 8.0, 10.0}) {
    const KgLimit found = *limit(draft);
    const FloatingBody at_limit = body_with(mesh_, draft, *found.kg_max);
    const RightingResults results =
        righting_results(at_limit, water_, std::array{0.0}, {}, RightingArmOptions{}).value();
    const auto governs = std::ranges::find(results.criteria, found.governing, &StabilityCriterion::name);
    ASSERT_NE(governs, results.criteria.end());
    EXPECT_TRUE(std::ranges::all_of(results.criteria, &StabilityCriterion::is_met)) << draft;
    EXPECT_NEAR(governs->value / governs->required, 1.0, 1e-3) << draft << ' ' << found.governing;
  }
}

TEST_F(KgLimitOfABox, FollowsTheWeatherCriterion) {
  const WeatherInputs weather{.exposure = {.windage_area = 4000.0, .windage_lever = 9.0}, .table = &table_};
  const KgLimit calm = *limit(6.0);
  const KgLimit windy = *limit(6.0, &weather);
  ASSERT_TRUE(windy.kg_max);
  EXPECT_LT(*windy.kg_max, *calm.kg_max);
  EXPECT_EQ(windy.governing, "weather criterion: heel in the steady wind");
  // Wall-sided: GZ = sin phi (GM + BM tan^2 phi / 2) is the lever of the wind at 16 degrees.
  const double heel = 16.0 * kRadiansPerDegree;
  const double bm = 400.0 / 72.0;
  const double lw1 = 504.0 * 4000.0 * 9.0 / (water_.gravity * water_.density * 9600.0);
  const double gm = lw1 / std::sin(heel) - 0.5 * bm * std::pow(std::tan(heel), 2);
  EXPECT_NEAR(*windy.kg_max, 3.0 + bm - gm, 1e-5);
}

TEST_F(KgLimitOfABox, SaysWhenNoKgIsPermissible) {
  const ImmersionPoints low{.deck_edge_B = {}, .downflooding_B = {Vec3(0, -10, 1)}};
  const KgLimit found = *kg_limit(body_, water_, table_, 6.0, 0.0, low, {}, nullptr);
  EXPECT_FALSE(found.kg_max);
  EXPECT_TRUE(found.governing.starts_with("area from 0 to 30 degrees, cut at downflooding"))
      << found.governing;
  EXPECT_FALSE(limit(0.0));
  EXPECT_FALSE(limit(13.0));
}

TEST_F(KgLimitOfABox, FloatsAtItsTrim) {
  const KgLimit level = *limit(6.0);
  const KgLimit trimmed = *limit(6.0, nullptr, 0.5 * kRadiansPerDegree);
  ASSERT_TRUE(trimmed.kg_max);
  EXPECT_NEAR(*trimmed.kg_max, *level.kg_max, 0.02);
  EXPECT_NE(*trimmed.kg_max, *level.kg_max);
}

class StabilityProgram : public testing::Test {
 protected:
  std::string ship(
      const std::string& more = "[body.client]\ndensity = 512.5\ncenter_of_mass = [0, 0, 2]\n") const {
    return dir_.write("scene.toml", R"([[body]]
id = 3
shape = { type = "box", size = [80, 20, 12], segments = [2, 2, 2] }
)" + more);
  }

  TempDir dir_;
};

TEST_F(StabilityProgram, PrintsPermissibleKgWithoutAMass) {
  const std::vector<std::string> command{"kg-limit", "--scene", ship(""),           "--draft",
                                         "4:6:1",    "--csv",   dir_.path("kg.csv")};
  const FinishedProcess text = run(command);
  ASSERT_EQ(text.exit_code, 0) << text.standard_error;
  EXPECT_TRUE(contains(text.standard_output, "not a class approval"));
  EXPECT_EQ(text.standard_error, "");
  const auto rows = csv_rows(read_file(dir_.path("kg.csv")));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0], (CsvRow{"draft", "trim", "displacement", "kg_max", "governing"}));
  EXPECT_NEAR(std::stod(rows[3][3]), 3.0 + 400.0 / 72.0 - 0.15, 2e-6);
  EXPECT_EQ(rows[3][4], "GM at heel 0");
  std::vector<std::string> as_json = command;
  as_json.emplace_back("--json");
  const auto json = nlohmann::json::parse(run(as_json).standard_output);
  EXPECT_NEAR(json.at("rows").at(2).at("displacement").get<double>(), 9840.0, 1e-9);

  const std::string mesh =
      dir_.write("box.obj",
                 "v 0 0 0\nv 4 0 0\nv 4 2 0\nv 0 2 0\nv 0 0 1\nv 4 0 1\nv 4 2 1\nv 0 2 1\n"
                 "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  EXPECT_EQ(run({"kg-limit", "--mesh", mesh, "--draft", "0.3"}).exit_code, 0);
  EXPECT_EQ(run({"kg-limit", "--scene", ship(), "--draft", "20"}).exit_code, 1);
}

TEST_F(StabilityProgram, PrintsTheWeatherCriterion) {
  const std::vector<std::string> command{
      "gz", "--scene", ship(), "--heel", "0:40:20", "--windage-area", "600", "--windage-lever", "9"};
  const FinishedProcess text = run(command);
  ASSERT_EQ(text.exit_code, 0) << text.standard_error;
  EXPECT_TRUE(contains(text.standard_output,
                       "2008 IS Code A 2.3, wind and roll, to starboard (not a class approval)"));
  EXPECT_TRUE(
      contains(text.standard_output, "outside the ships of the formulae (2.3.5): T is not below 20 s"));
  std::vector<std::string> as_json = command;
  as_json.emplace_back("--json");
  const auto json = nlohmann::json::parse(run(as_json).standard_output);
  const auto& weather = json.at("weather_criterion");
  EXPECT_NEAR(weather.at("lw1").get<double>(), 504.0 * 600.0 * 9.0 / (9.80665 * 9'840'000.0), 1e-9);
  EXPECT_NEAR(weather.at("og").get<double>(), 2.0, 1e-9);
  EXPECT_EQ(weather.at("areas_met"), true);
  EXPECT_EQ(weather.at("phi0_met"), true);
  EXPECT_EQ(weather.at("outside").size(), 1U);
  EXPECT_EQ(weather.at("phi2"), 50.0);
  const auto calm =
      nlohmann::json::parse(run({"gz", "--scene", ship(), "--heel", "0", "--json"}).standard_output);
  EXPECT_FALSE(calm.contains("weather_criterion"));
}

TEST_F(StabilityProgram, ReadsDraftsAtMarksAndFreeboards) {
  // 1 degree by the stern with the centre of mass moved aft: a draft of 6 m at midship.
  const double trim = 1.0 * kRadiansPerDegree;
  const std::vector<std::string> points{"--marks",  "aft=-40,0",   "side=10,4", "--freeboard",
                                        "40,-10,6", "--freeboard", "0,0,-6"};
  const auto with_points = [&](std::vector<std::string> command) {
    command.insert(command.end(), points.begin(), points.end());
    return command;
  };
  const auto table = nlohmann::json::parse(
      run(with_points({"table", "--scene", ship(), "--json", "--draft", "6", "--trim", "1"}))
          .standard_output);
  const auto& row = table.at("rows").at(0);
  EXPECT_NEAR(row.at("marks").at("aft").get<double>(), 6.0 + 40.0 * std::tan(trim), 1e-9);
  EXPECT_NEAR(row.at("marks").at("side").get<double>(), 6.0 - 10.0 * std::tan(trim), 1e-9);
  EXPECT_NEAR(row.at("freeboards").at(0).get<double>(), 6.0 * std::cos(trim) + 40.0 * std::sin(trim), 1e-9);
  EXPECT_NEAR(row.at("freeboards").at(1).get<double>(), -6.0 * std::cos(trim), 1e-9);

  const FinishedProcess arms =
      run(with_points({"gz", "--scene", ship(), "--heel", "0:20:20", "--csv", dir_.path("gz.csv")}));
  ASSERT_EQ(arms.exit_code, 0) << arms.standard_error;
  const auto rows = csv_rows(read_file(dir_.path("gz.csv")));
  EXPECT_EQ(rows.at(0), (CsvRow{"heel", "trim", "draft", "gz", "kn", "area", "draft_aft", "draft_side",
                                "freeboard_1", "freeboard_2"}));
  // A wall-sided ship turns about the middle of its waterplane; the port side comes up.
  const std::vector<double> heeled = numbers_of(rows.at(2));
  const double heel = 20.0 * kRadiansPerDegree;
  EXPECT_NEAR(heeled[6], 6.0, 1e-9);
  EXPECT_NEAR(heeled[7], 6.0 - 4.0 * std::tan(heel), 1e-9);
  EXPECT_NEAR(heeled[8], 6.0 * std::cos(heel) - 10.0 * std::sin(heel), 1e-9);

  const FinishedProcess rest =
      run(with_points({"equilibrium", "--scene", ship(), "--json", "--csv", dir_.path("e.csv")}));
  const auto attitudes = nlohmann::json::parse(rest.standard_output).at("attitudes");
  bool upright = false;
  for (const auto& at : attitudes) {
    const double angle = at.at("heel").get<double>();
    if (std::abs(angle) > 90.0) {
      EXPECT_EQ(at.at("marks").at("aft"), nullptr);
    }
    if (std::abs(angle) > 1e-6) continue;
    upright = true;
    EXPECT_NEAR(at.at("marks").at("side").get<double>(), 6.0, 1e-9);
    EXPECT_NEAR(at.at("freeboards").at(0).get<double>(), 6.0, 1e-9);
  }
  EXPECT_TRUE(upright);
  EXPECT_EQ(csv_rows(read_file(dir_.path("e.csv"))).at(0).back(), "freeboard_2");
  EXPECT_TRUE(contains(run(with_points({"equilibrium", "--scene", ship()})).standard_output, "draft_side"));
}

TEST_F(StabilityProgram, SaysWhichPartDisplacesWhat) {
  const std::string scene = dir_.write("parts.toml", R"([[body]]
id = 1
name = "catamaran"
[[body.part]]
name = "port"
shape = { type = "box", size = [10, 1, 2], segments = [1, 1, 1] }
position = [0, 3, 0]
[[body.part]]
name = "starboard"
shape = { type = "box", size = [10, 1, 2], segments = [1, 1, 1] }
position = [0, -3, 0]
[[body.part]]
name = "mast"
shape = { type = "box", size = [0.1, 0.1, 1], segments = [1, 1, 1] }
position = [0, 0, 10]
[body.client]
mass = 10250.0
center_of_mass = [0, 0.5, -0.5]
)");
  const FinishedProcess text = run({"equilibrium", "--scene", scene});
  ASSERT_EQ(text.exit_code, 0) << text.standard_error;
  EXPECT_TRUE(contains(text.standard_output, "starboard displaces"));
  EXPECT_TRUE(contains(text.standard_output, "mast displaces nothing\n")) << text.standard_output;
  EXPECT_FALSE(contains(text.standard_output, "(-0,")) << text.standard_output;
  const auto at = nlohmann::json::parse(run({"equilibrium", "--scene", scene, "--json"}).standard_output)
                      .at("attitudes")
                      .at(0);
  const auto& parts = at.at("parts");
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_TRUE(parts[2].at("center_of_buoyancy").is_null());
  EXPECT_EQ(parts[0].at("name"), "port");
  EXPECT_GT(parts[0].at("mass").get<double>(), parts[1].at("mass").get<double>());
  EXPECT_NEAR(parts[0].at("mass").get<double>() + parts[1].at("mass").get<double>(), 10250.0, 1e-6);
  EXPECT_NEAR(parts[0].at("volume").get<double>() + parts[1].at("volume").get<double>(),
              at.at("displacement_volume").get<double>(), 1e-10);
  EXPECT_FALSE(nlohmann::json::parse(run({"equilibrium", "--scene", ship(), "--json"}).standard_output)
                   .at("attitudes")
                   .at(0)
                   .contains("parts"));
}

TEST_F(StabilityProgram, RejectsWrongArguments) {
  const std::string good = ship();
  const std::vector<std::vector<std::string>> wrong{
      {"kg-limit", "--scene", good},
      {"kg-limit", "--scene", good, "--draft", "6", "--heel", "0:10:5"},
      {"kg-limit", "--scene", good, "--draft", "6", "--marks", "aft=1,2"},
      {"kg-limit", "--scene", good, "--draft", "6", "--html", dir_.path("a.html")},
      {"gz", "--scene", good, "--windage-area", "5"},
      {"gz", "--scene", good, "--windage-lever", "5"},
      {"gz", "--scene", good, "--windage-area", "-5", "--windage-lever", "5"},
      {"gz", "--scene", good, "--sharp-bilges"},
      {"equilibrium", "--scene", good, "--windage-area", "5", "--windage-lever", "5"},
      {"equilibrium", "--scene", good, "--marks", "aft"},
      {"equilibrium", "--scene", good, "--marks", "aft=1"},
      {"equilibrium", "--scene", good, "--marks", "=1,2"},
      {"equilibrium", "--scene", good, "--marks", "a,b=1,2"},
      {"equilibrium", "--scene", good, "--marks", "aft=1,2", "aft=3,4"},
      {"equilibrium", "--scene", good, "--freeboard", "1,2"},
      {"equilibrium", "--mesh", "a.obj", "--mass", "1"}};
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    const FinishedProcess result = run(wrong[i]);
    EXPECT_EQ(result.exit_code, 2) << i << result.standard_error;
    EXPECT_FALSE(result.standard_error.empty()) << i;
  }
}

}  // namespace
}  // namespace buoyancy::service
