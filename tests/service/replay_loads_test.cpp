// Replays of bodies with drag, added mass and the loads output.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <sstream>

#include <bot_core/rigid_transform_t.hpp>
#include <gtest/gtest.h>

#include "recording/state_csv.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/service/replay_fixture.h"
#include "tests/support/contains.h"
#include "tests/support/csv.h"
#include "tests/support/json.h"

namespace buoyancy {
namespace {

const std::string kTwistHeader = "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
constexpr std::size_t kColumns = 4 + 18 + 3 + 72;

class ReplayLoads : public Replay {
 protected:
  ReplayLoads() { write("scene.toml", kLoadsBoxScene + "[[body]]\nid = 2\nshape = { type = \"box\" }\n"); }

  std::vector<BodiesLoads> loads_in(const std::string& log, const std::string& channel = "BUOYANCY_LOADS") {
    std::vector<BodiesLoads> loads;
    for (const LoggedEvent& one : events_of(log, only_channel(channel))) {
      loads.push_back(decoded<BodiesLoads>(one.bytes));
    }
    return loads;
  }

  // Expects a refusal before any output, as one line with these texts.
  void expect_refused(const std::string& input, const std::vector<std::string>& options,
                      const std::vector<std::string>& texts) {
    const FinishedProcess finished = replay(input, path("refused.csv"), options);
    EXPECT_EQ(finished.exit_code, 2) << finished.standard_error;
    EXPECT_EQ(std::count(finished.standard_error.begin(), finished.standard_error.end(), '\n'), 1)
        << finished.standard_error;
    for (const std::string& text : texts) {
      EXPECT_TRUE(contains(finished.standard_error, text));
    }
    EXPECT_FALSE(std::filesystem::exists(path("refused.csv")));
  }
};

// Both bodies at each time, the first moving, dry, fully submerged or piercing the surface; every seventh row
// of it has no velocity.
std::string moving_rows(int count) {
  std::ostringstream csv;
  csv << kTwistHeader;
  for (int i = 0; i < count; ++i) {
    csv << i << ",1,7,8," << 0.003 * (811 * i % 2000) - 3.0 << ",0.8,0,0.6,0,";
    if (i % 7 == 3) {
      csv << "nan";
    } else {
      csv << 0.01 * i;
    }
    csv << ",0.5,-0.25,0.1,0.2,-0.3\n" << i << ",2,0,0,0,1,0,0,0,nan,nan,nan,nan,nan,nan\n";
  }
  return csv.str();
}

std::vector<double> numbers_of(const BodyLoads& body) {
  std::vector<double> numbers{body.immersion};
  const auto add = [&numbers](const auto& values) {
    numbers.insert(numbers.end(), values.begin(), values.end());
  };
  for (const auto& vector : {body.buoyancy_force, body.buoyancy_torque, body.drag_force, body.drag_torque,
                             body.added_mass_force, body.added_mass_torque, body.water_velocity}) {
    add(vector);
  }
  for (const auto& row : body.added_mass) add(row);
  for (const auto& row : body.damping) add(row);
  return numbers;
}

TEST_F(ReplayLoads, WritesEventsAfterEachResponse) {
  std::string log;
  for (int i = 0; i < 3; ++i) log += event("BUOYANCY_STATES", 500 + i, request(i, 0.5 * i));
  write("in.lcmlog", log);
  ASSERT_EQ(replay(path("in.lcmlog"), path("out.lcmlog"), {"--loads-channel", "L"}).exit_code, 0);
  const std::vector<LoggedEvent> all = events_of(path("out.lcmlog"));
  const std::vector<BodiesLoads> loads = loads_in(path("out.lcmlog"), "L");
  ASSERT_EQ(all.size(), 6U);
  ASSERT_EQ(loads.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(all[2 * i].channel, "BUOYANCY_WRENCHES");
    EXPECT_EQ(all[2 * i + 1].channel, "L");
    EXPECT_EQ(all[2 * i + 1].timestamp, static_cast<std::int64_t>(500 + i));
    EXPECT_EQ(loads[i].id.seq, static_cast<std::int64_t>(i));
    EXPECT_NEAR(loads[i].bodies.at(0).immersion, (2.0 - 0.5 * static_cast<double>(i)) / 4.0, 1e-14);
  }
  expect_refused(path("in.lcmlog"), {"--loads-channel", "BUOYANCY_STATES"}, {"two are equal"});
}

TEST_F(ReplayLoads, CsvHasTheNumbersOfTheMessages) {
  const std::string input = write("in.csv", moving_rows(50));
  ASSERT_EQ(replay(input, path("out.lcmlog"), {"--loads", path("loads.csv")}).exit_code, 0);
  const auto rows = csv_rows(read_file(path("loads.csv")));
  const std::vector<BodiesLoads> messages = loads_in(path("out.lcmlog"));
  ASSERT_EQ(messages.size(), 50U);
  ASSERT_EQ(rows.size(), 51U) << "only body 1 requests its loads";
  const std::vector<std::string>& header = rows[0];
  ASSERT_EQ(header.size(), kColumns);
  EXPECT_EQ(header[3], "immersion");
  EXPECT_EQ(header[4], "buoyancy_fx");
  EXPECT_EQ(header[10], "drag_fx");
  EXPECT_EQ(header[21], "added_mass_tz");
  EXPECT_EQ(header[22], "water_vx");
  EXPECT_EQ(header[25], "added_mass_11");
  EXPECT_EQ(header[60], "added_mass_66");
  EXPECT_EQ(header[62], "damping_12");
  EXPECT_EQ(header[96], "damping_66");
  for (std::size_t i = 0; i < 50; ++i) {
    const BodyLoads& body = messages[i].bodies.at(0);
    const std::vector<std::string>& row = rows[i + 1];
    ASSERT_EQ(row.size(), kColumns);
    EXPECT_EQ(row[0], std::to_string(i));
    EXPECT_EQ(row[1], "1");
    EXPECT_EQ(row[2], i % 7 == 3 ? "4" : "0");
    EXPECT_EQ(buoyancy::numbers_of(CsvRow(row.begin() + 3, row.end())), numbers_of(body)) << i;
  }
  EXPECT_NE(messages[1].bodies[0].drag_force[0], 0.0);
  EXPECT_NE(messages[1].bodies[0].damping[0][4], 0.0);
}

TEST_F(ReplayLoads, CsvIsTheSameForAnyJobsInputAndOutput) {
  const std::string input = write("in.csv", moving_rows(6000));
  std::string expected;
  for (const char* jobs : {"1", "2", "3", "8"}) {
    ASSERT_EQ(replay(input, path("out.csv"), {"--loads", path("loads.csv"), "--jobs", jobs}).exit_code, 0);
    const std::string loads = read_file(path("loads.csv"));
    if (expected.empty()) expected = loads;
    EXPECT_TRUE(loads == expected) << jobs << " jobs";
  }
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 6001);
  const std::string with = read_file(path("out.csv"));
  ASSERT_EQ(replay(input, path("out.csv")).exit_code, 0);
  EXPECT_TRUE(read_file(path("out.csv")) == with) << "the option changes nothing else";

  // The same requests as a log.
  std::string log;
  auto reader = StateCsvReader::open(input);
  ASSERT_TRUE(reader);
  for (LogItem item = reader->next(); std::holds_alternative<RecordedEvent>(item); item = reader->next()) {
    const Bytes bytes = std::get<RecordedEvent>(item).bytes;
    log += event("BUOYANCY_STATES", 1, {bytes.begin(), bytes.end()});
  }
  write("in.lcmlog", log);
  ASSERT_EQ(replay(path("in.lcmlog"), path("out.lcmlog"), {"--loads", path("from_log.csv")}).exit_code, 0);
  EXPECT_TRUE(read_file(path("from_log.csv")) == expected);
}

TEST_F(ReplayLoads, CsvIsRefusedWhereItCannotBeWritten) {
  const std::string input = write("in.csv", moving_rows(2));
  const std::string loads = path("loads.csv");
  expect_refused(input, {"--loads", path("refused.csv")}, {"the same file as OUTPUT"});
  expect_refused(input, {"--loads", input}, {"the same file as"});
  expect_refused(input, {"--loads", path("loads.lcmlog")}, {"loads.lcmlog; expected a .csv file"});
  expect_refused(input, {"--loads", loads, "--part", "1/2"},
                 {"--loads: together with --part", "Name an .lcmlog as OUTPUT"});
  const FinishedProcess joined = run({"--join", "2", "--loads", loads, input, path("refused.csv")});
  EXPECT_EQ(joined.exit_code, 2) << joined.standard_error;
  EXPECT_TRUE(contains(joined.standard_error, "together with --loads"));
  const FinishedProcess full = replay(input, path("out.csv"), {"--loads", "/dev/full"});
  EXPECT_EQ(full.exit_code, 1) << full.standard_error;
  EXPECT_TRUE(contains(full.standard_error, "/dev/full"));
  write("scene.toml", kOneBoxScene);
  expect_refused(input, {"--loads", loads},
                 {"no body of " + scene_ + " has loads", "outputs = [\"wrench\", \"loads\"]"});
  EXPECT_FALSE(std::filesystem::exists(loads));
}

TEST_F(ReplayLoads, RefusesCsvWithoutTheVelocitiesThatDragNeeds) {
  const std::string input = write("poses.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n0,2,0,0,0,1,0,0,0\n");
  expect_refused(input, {},
                 {input + ":1: a header without velocities", "vx,vy,vz,wx,wy,wz", "body 'hull' of " + scene_,
                  "or remove [body.drag] and [body.added_mass]"});
  EXPECT_EQ(replay(write("empty.csv", ""), path("empty_out.csv")).exit_code, 0) << "no rows, no velocities";
  write("scene.toml", kOneBoxScene);
  EXPECT_EQ(replay(input, path("out.csv")).exit_code, 0);
}

TEST_F(ReplayLoads, PosesGetDragOnlyWithVelocities) {
  bot_core::rigid_transform_t transform{};
  transform.quat[0] = 1.0;
  std::string log;
  bot_core::pose_t pose = upright_pose(0.5, 1);
  pose.vel[0] = 1.5;
  for (int i = 0; i < 3; ++i) log += event("FRAME", i, encoded_by_lcm(transform));
  log += event("HULL", 5, encoded_by_lcm(pose));
  write("in.lcmlog", log);
  const FinishedProcess finished =
      replay(path("in.lcmlog"), path("out.lcmlog"),
             {"--pose", "HULL=1", "--pose", "FRAME=hull", "--velocity-frame", "world"});
  EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
  EXPECT_EQ(std::count(finished.standard_error.begin(), finished.standard_error.end(), '\n'), 1)
      << finished.standard_error;
  for (const char* text : {"warning: channel FRAME: 3 poses in ", "body 'hull' has drag or added mass",
                           "NON_FINITE_TWIST", "Send pose_t instead of rigid_transform_t"}) {
    EXPECT_TRUE(contains(finished.standard_error, text));
  }
  std::vector<BodyWrench> wrenches;
  for (const LoggedEvent& one : events_of(path("out.lcmlog"), only_channel("BUOYANCY_WRENCHES"))) {
    wrenches.push_back(decoded<WrenchResponse>(one.bytes).bodies.at(0));
  }
  ASSERT_EQ(wrenches.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(wrenches[i].status, BodyStatus::kNonFiniteTwist);
    EXPECT_EQ(wrenches[i].force, (std::array<double, 3>{}));
  }
  EXPECT_EQ(wrenches[3].status, BodyStatus::kOk);
  EXPECT_NEAR(wrenches[3].force[0], -1.5 / 4.0 * (20.0 + 18.0), 1e-9);
}

TEST_F(ReplayLoads, RefusesPosesOfUnknownVelocityFrame) {
  write("in.lcmlog", event("HULL", 5, encoded_by_lcm(upright_pose(0.5, 1))));
  expect_refused(path("in.lcmlog"), {"--pose", "HULL=1"},
                 {"--pose HULL=1: no --velocity-frame", "body 'hull' has drag or added mass"});
  EXPECT_EQ(replay(path("in.lcmlog"), path("out.lcmlog"), {"--pose", "HULL=2"}).exit_code, 0)
      << "body 2 needs no velocities";
}

class ComparedLoads : public ReplayLoads {
 protected:
  void SetUp() override {
    write("in.csv", moving_rows(20));
    ASSERT_EQ(replay(path("in.csv"), path("baseline.lcmlog")).exit_code, 0);
  }
  nlohmann::json compared(const std::string& baseline, int exit_code) {
    const FinishedProcess finished =
        replay(path("in.csv"), path("new.lcmlog"), {"--compare", path(baseline), "--json"});
    EXPECT_EQ(finished.exit_code, exit_code) << finished.standard_error << finished.standard_output;
    return parse_json(finished.standard_output)["compared"];
  }
  // The baseline with the second message of loads changed, of a body that is OK.
  nlohmann::json compared_with(const std::function<void(BodyLoads&)>& change, int exit_code) {
    std::string all;
    int number = 0;
    for (LoggedEvent& one : events_of(path("baseline.lcmlog"))) {
      if (one.channel == "BUOYANCY_LOADS" && ++number == 2) {
        auto loads = decoded<BodiesLoads>(one.bytes);
        change(loads.bodies.at(0));
        encode(loads, one.bytes);
      }
      all += event(one.channel, one.timestamp, one.bytes);
    }
    write("changed.lcmlog", all);
    return compared("changed.lcmlog", exit_code)["bodies"][0];
  }
  void replace_in_scene(const std::string& what, const std::string& instead) {
    std::string scene = read_file(scene_);
    scene.replace(scene.find(what), what.size(), instead);
    write("scene.toml", scene);
  }
};

TEST_F(ComparedLoads, AgreeWithThemselves) {
  const auto same = compared("baseline.lcmlog", 0);
  EXPECT_EQ(same["agrees"], true);
  EXPECT_EQ(same["bodies"][0]["loads"], 17) << "20, of which 3 have no velocity";
  EXPECT_EQ(same["bodies"][0]["loads_in_bounds"], 0.0);
  EXPECT_EQ(same["bodies"][0]["loads_worst_field"], "");
  EXPECT_EQ(same["bodies"][1]["loads"], 0);
  const FinishedProcess text =
      replay(path("in.csv"), path("new.lcmlog"), {"--compare", path("baseline.lcmlog")});
  EXPECT_TRUE(
      contains(text.standard_output, "       1 loads: 17 compared, largest difference over tolerance 0\n"));
}

TEST_F(ComparedLoads, NameTheFieldThatDiffers) {
  using Change = std::pair<const char*, std::function<void(BodyLoads&)>>;
  for (const double shift : {1e-6, std::nan("")}) {
    for (const auto& [field, change] : std::initializer_list<Change>{
             {"immersion", [&](BodyLoads& body) { body.immersion += shift; }},
             {"buoyancy_force", [&](BodyLoads& body) { body.buoyancy_force[2] += shift; }},
             {"buoyancy_torque", [&](BodyLoads& body) { body.buoyancy_torque[0] += shift; }},
             {"drag_force", [&](BodyLoads& body) { body.drag_force[1] += shift; }},
             {"drag_torque", [&](BodyLoads& body) { body.drag_torque[2] += shift; }},
             {"added_mass_force", [&](BodyLoads& body) { body.added_mass_force[0] += shift; }},
             {"added_mass_torque", [&](BodyLoads& body) { body.added_mass_torque[1] += shift; }},
             {"added_mass", [&](BodyLoads& body) { body.added_mass[4][4] += shift; }},
             {"damping", [&](BodyLoads& body) { body.damping[0][1] += shift; }},
             {"water_velocity", [&](BodyLoads& body) { body.water_velocity[2] += shift; }}}) {
      const auto differing = compared_with(change, 1);
      EXPECT_EQ(differing["loads_worst_field"], field) << differing;
      EXPECT_EQ(differing["force_in_bounds"], 0.0);
    }
  }
  const auto status = compared_with([](BodyLoads& body) { body.status = BodyStatus::kOutOfRange; }, 1);
  EXPECT_EQ(status["status_changes"], 1);
}

TEST_F(ComparedLoads, AllowForRounding) {
  constexpr double kTiny = 1.0 + 1e-15;
  const auto rounded = compared_with(
      [](BodyLoads& body) {
        body.immersion *= kTiny;
        for (auto& row : body.added_mass) {
          for (double& number : row) number *= kTiny;
        }
        for (auto& row : body.damping) {
          for (double& number : row) number *= kTiny;
        }
        for (double& number : body.drag_force) number *= kTiny;
        for (double& number : body.water_velocity) number *= kTiny;
      },
      0);
  EXPECT_GT(rounded["loads_in_bounds"].get<double>(), 0.0);
  EXPECT_LE(rounded["loads_in_bounds"].get<double>(), 1.0);
}

TEST_F(ComparedLoads, OfAnotherMethodDifferByTheImmersionsError) {
  for (const char* method : {"exact", "fast", "improved", "fast_surface"}) {
    write("scene.toml", kLoadsBoxScene + "[[body]]\nid = 2\nshape = { type = \"box\" }\n");
    replace_in_scene("name = \"hull\"\n", std::string("name = \"hull\"\nmethod = \"") + method + "\"\n");
    const auto body = compared("baseline.lcmlog", 0)["bodies"][0];
    EXPECT_LE(body["loads_in_bounds"].get<double>(), 1.0) << method << body;
    EXPECT_GT(body["loads_in_bounds"].get<double>(), 0.0) << method << body;
  }
}

TEST_F(ComparedLoads, OfOtherCoefficientsDiffer) {
  replace_in_scene("[5, 126, 126", "[5, 126.001, 126");
  const auto body = compared("baseline.lcmlog", 1)["bodies"][0];
  EXPECT_GT(body["loads_in_bounds"].get<double>(), 1e3) << body;
}

TEST_F(ComparedLoads, WithoutCounterpartAreReported) {
  replace_in_scene("outputs = [\"wrench\", \"loads\"]\n", "");
  EXPECT_EQ(compared("baseline.lcmlog", 1)["unmatched_baseline"], 20);
  std::string without;
  for (const LoggedEvent& one : events_of(path("baseline.lcmlog"))) {
    if (one.channel == "BUOYANCY_WRENCHES") without += event(one.channel, one.timestamp, one.bytes);
  }
  write("without.lcmlog", without);
  write("scene.toml", kLoadsBoxScene + "[[body]]\nid = 2\nshape = { type = \"box\" }\n");
  EXPECT_EQ(compared("without.lcmlog", 1)["unmatched_new"], 20);
}

}  // namespace
}  // namespace buoyancy
