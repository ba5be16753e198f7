// Compartments and tanks in the model of the scene and in the data of the report.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"
#include "tests/view/subdivided_hull.h"
#include "view/common/scene_model.h"
#include "view/report/report_page.h"
#include "view/report/run_file.h"

namespace buoyancy::view {
namespace {

class RunSubdivisionTest : public testing::Test {
 protected:
  RecordedRun read_csv(const std::string& rows) const {
    return read_run(directory_.write("run.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n" + rows), scene_, 100,
                    {})
        .value();
  }

  TempDir directory_;
  const Scene scene_ = Scene::load(write_subdivided_hull(directory_)).value();
};

TEST_F(RunSubdivisionTest, DescribesCompartmentsAndTanksInModel) {
  const nlohmann::ordered_json model = scene_model(scene_);
  const nlohmann::ordered_json& inside = model["bodies"][0];
  EXPECT_EQ(inside["compartments"][0]["name"], "engine room");
  EXPECT_EQ(inside["compartments"][0]["permeability"], 0.85);
  EXPECT_EQ(inside["compartments"][0]["flooded"], 0.25);
  EXPECT_EQ(inside["tanks"][1]["name"], "ring");
  EXPECT_EQ(inside["tanks"][1]["density"], 850.0);
  EXPECT_EQ(inside["tanks"][1]["liquid_volume"], 1.25);
  EXPECT_NEAR(model["meshes"][inside["tanks"][1]["mesh"].get<std::size_t>()]["volume"].get<double>(), 3.0,
              1e-12);
  EXPECT_FALSE(model["bodies"][1].contains("tanks"));
}

TEST_F(RunSubdivisionTest, LeavesMeshesOfPartsOutOfModel) {
  const nlohmann::ordered_json model = scene_model(scene_);
  ASSERT_EQ(model["meshes"].size(), 6U);
  const auto volume = [&model](std::size_t body) {
    return model["meshes"][model["bodies"][body]["mesh"].get<std::size_t>()]["volume"].get<double>();
  };
  EXPECT_NEAR(volume(0), 49.0, 1e-12) << "hull and part";
  EXPECT_NEAR(volume(1), 1.0, 1e-12);
}

TEST_F(RunSubdivisionTest, CountsRowsAsComputed) {
  const RecordedRun run = read_csv("0,1,0,0,9,1,0,0,0\n1000,1,0,0,0,1,0,0,0\n2000,1,0,0,0,1,0,0,0\n");
  EXPECT_EQ(run.bodies[0].evaluations.crossing, 2) << "bounds do not decide";
  EXPECT_EQ(run.bodies[0].evaluations.unchanged, 1);
}

TEST_F(RunSubdivisionTest, AppliesRecordedConditionsFromTheirUtimeOn) {
  const RecordedRun run =
      read_run(directory_.write("run.lcmlog", log_of_conditions()), scene_, 100, {}).value();
  const BodyRun& body = run.bodies[0];
  ASSERT_EQ(body.rows.size(), 4U);
  ASSERT_EQ(body.condition_of_row.size(), 4U);
  const auto condition = [&body](std::size_t row) { return body.conditions.at(body.condition_of_row[row]); };
  const auto expect_condition = [&condition](std::size_t row, double flooded, double liquid_volume) {
    ASSERT_TRUE(condition(row)) << row;
    EXPECT_EQ(condition(row)->flooded, (std::vector<double>{flooded, 0.0})) << row;
    EXPECT_NEAR(condition(row)->liquid_volumes[0], liquid_volume, 1e-12) << row;
    EXPECT_EQ(condition(row)->liquid_volumes[1], 1.25) << row;
  };
  expect_condition(0, 0.25, 6.0);
  expect_condition(1, 0.25, 12.0);
  expect_condition(2, 1.0, 12.0);
  EXPECT_FALSE(condition(3)) << "the volume in a tank is not known";
  EXPECT_EQ(body.rows[3][kStatus], static_cast<double>(BodyStatus::kBadCondition));
  // 6 m^3 more in the tank; then 0.75 more of the engine room's water, 0.9 m of whose 1 m is under the level.
  EXPECT_NEAR(body.rows[1][kFz] - body.rows[0][kFz], -6.0 * kDensity * kGravity, 1e-6);
  EXPECT_NEAR(body.rows[2][kFz] - body.rows[1][kFz], -2.0 * 0.85 * 0.75 * 0.9 * kDensity * kGravity, 1e-6);
  ASSERT_EQ(run.warnings.size(), 1U);
  EXPECT_TRUE(contains(run.warnings[0], "liquid_volume = 99"));
}

TEST_F(RunSubdivisionTest, CountsLiquidsInEnergy) {
  const RecordedRun run =
      read_run(directory_.write("run.lcmlog", log_of_conditions()), scene_, 100, {}).value();
  // The liquid in the wide tank is between 0.9 m and 1.9 m over the water, and then between 0.9 m and 2.9 m.
  const double lifted = kDensity * kGravity * (12.0 * 1.9 - 6.0 * 1.4);
  const std::vector<RunRow>& rows = run.bodies[0].rows;
  EXPECT_NEAR(rows[1][kEnergy] - rows[0][kEnergy], lifted, 1e-6 * lifted);
}

TEST_F(RunSubdivisionTest, WritesConditionsThatDiffer) {
  const RecordedRun run =
      read_run(directory_.write("run.lcmlog", log_of_conditions()), scene_, 100, {}).value();
  const auto data = parse_json(report_data(scene_, run, {.file = "run.lcmlog", .version = "1"}));
  const nlohmann::json& list = data["bodies"][0]["conditions"]["list"];
  ASSERT_EQ(list.size(), 4U);
  EXPECT_EQ(list[2]["flooded"], nlohmann::json({1.0, 0.0}));
  EXPECT_EQ(list[2]["liquid_volumes"][1], 1.25);
  EXPECT_EQ(list[3], nullptr);
  const RecordedRun unchanged = read_csv("0,1,0,0,0,1,0,0,0\n");
  EXPECT_TRUE(unchanged.bodies[0].conditions.empty());
}

TEST(RunSubdivision, AddsNothingToPageWithoutCompartmentsAndTanks) {
  const TempDir directory;
  const Scene scene = scene_of(kOneBoxScene);
  const RecordedRun run =
      read_run(directory.write("run.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n"), scene,
               100, {})
          .value();
  const std::string data = report_data(scene, run, {.file = "run.csv", .version = "1"});
  const std::string without = report_page(data, "three.js");
  for (const char* word : {"subdivision", "Subdivision", "LevelCut", "condition_of_row", "opacity;"}) {
    EXPECT_FALSE(contains(without, word));
  }
  const std::string with = report_page(data, "three.js", {.subdivision = true});
  EXPECT_TRUE(contains(with, "class SubdivisionDrawing"));
  EXPECT_TRUE(contains(with, "new SubdivisionDrawing("));
}

}  // namespace
}  // namespace buoyancy::view
