// Runs buoyancy-replay on poses as other programs write them, and lists what inputs hold.
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/service/replay_fixture.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"

namespace buoyancy {
namespace {

using ReplayFormats = Replay;

constexpr int kPoses = 30;

WrenchRequest pose(int i) {
  WrenchRequest request;
  request.id = {1'700'000'000'000'000 + 12'345 * i, 0, i};
  BodyState& state = request.bodies.emplace_back();
  state.body_id = 1;
  state.position = {0.1 * i, -7.0 / (i + 1), 0.123 * i - 2.0};
  const double norm = std::sqrt(1.0 + 0.05 * i);
  state.quaternion_wxyz = {1.0 / norm, std::sqrt(0.02 * i) / norm, -std::sqrt(0.03 * i) / norm, 0.0};
  state.linear_velocity = {0.1 * i, 0.3, -0.7};
  state.angular_velocity = {0.01, 0.2 * i, 0.3};
  return request;
}

std::string number(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

// The lines of all poses: row(time, values) with the values as text, 17 digits each.
template <typename Row>
std::string rows(Row&& row) {
  std::string text;
  for (int i = 0; i < kPoses; ++i) {
    const WrenchRequest request = pose(i);
    const BodyState& state = request.bodies[0];
    std::vector<std::string> values;
    for (const double value : state.position) values.push_back(number(value));
    for (const double value : state.quaternion_wxyz) values.push_back(number(value));
    for (const double value : state.linear_velocity) values.push_back(number(value));
    text += row(request.id.utime, values) + "\n";
  }
  return text;
}

std::string in_seconds(std::int64_t utime) {
  std::string digits = std::to_string(utime);
  return digits.insert(digits.size() - 6, ".");
}

std::string tum() {
  return rows([](std::int64_t utime, const std::vector<std::string>& v) {
    return in_seconds(utime) + " " + v[0] + " " + v[1] + " " + v[2] + " " + v[4] + " " + v[5] + " " + v[6] +
           " " + v[3];
  });
}

TEST_F(ReplayFormats, GiveTheWrenchesOfTheSamePosesInALog) {
  std::string log;
  for (int i = 0; i < kPoses; ++i) log += event("BUOYANCY_STATES", 5, encoded(pose(i)));
  ASSERT_EQ(replay(write("in.lcmlog", log), path("log.csv")).exit_code, 0);
  const std::string euroc =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
      "v_RS_R_x "
      "[m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1]\n" +
      rows([](std::int64_t utime, const std::vector<std::string>& v) {
        std::string row = std::to_string(utime) + "000";
        for (const std::string& value : v) row += "," + value;
        return row;
      });
  const std::string nav =
      "header.stamp.sec,header.stamp.nanosec,pose.position.x,pose.position.y,pose.position.z,pose."
      "orientation.w,pose."
      "orientation.x,pose.orientation.y,pose.orientation.z\n" +
      rows([](std::int64_t utime, const std::vector<std::string>& v) {
        std::string row = std::to_string(utime / 1'000'000) + "," + std::to_string(utime % 1'000'000 * 1000);
        for (int i = 0; i < 7; ++i) row += "," + v[static_cast<std::size_t>(i)];
        return row;
      });
  const std::string expected = read_file(path("log.csv"));
  const struct {
    const char* file;
    std::string contents;
    const char* said;
  } cases[] = {{"a.txt", tum(), "TUM, time in seconds, without velocities"},
               {"b.csv", euroc, "EuRoC, time in nanoseconds, without angular velocities"},
               {"c.csv", nav, "nav_msgs, time in seconds and nanoseconds, without velocities"}};
  for (const auto& [file, contents, said] : cases) {
    const FinishedProcess finished = replay(write(file, contents), path("out.csv"));
    EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
    EXPECT_EQ(finished.standard_error,
              "buoyancy-replay: " + path(file) + ": " + said + "; poses of body 'body 1' (id 1)\n");
    EXPECT_TRUE(read_file(path("out.csv")) == expected) << file;
  }
}

TEST_F(ReplayFormats, WriteLogsAndPartsOfPoses) {
  const std::string in = write("in.tum", tum());
  ASSERT_EQ(replay(in, path("whole.lcmlog")).exit_code, 0);
  for (const char* part : {"1/2", "2/2"}) {
    const FinishedProcess finished = replay(in, path("out.lcmlog"), {"--part", part});
    ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  }
  const FinishedProcess joined = run({"--join", "2", in, path("out.lcmlog")});
  EXPECT_EQ(joined.exit_code, 0) << joined.standard_error;
  EXPECT_EQ(joined.standard_error, "");
  EXPECT_TRUE(read_file(path("out.lcmlog")) == read_file(path("whole.lcmlog")));
  const FinishedProcess compared = replay(in, "/dev/null", {"--compare", path("whole.lcmlog")});
  EXPECT_EQ(compared.exit_code, 0) << compared.standard_error;
}

TEST_F(ReplayFormats, RefuseAnUnsuitableQuaternionAsALogDoes) {
  const FinishedProcess finished =
      replay(write("in.txt", "1 0 0 0 0 0 0 1.0005\n2 0 0 0 0 0 0 1.1\n"), path("out.csv"), {"--json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
  const auto bodies = parse_json(finished.standard_output)["bodies"];
  EXPECT_EQ(bodies["OK"], 1);
  EXPECT_EQ(bodies["BAD_QUATERNION"], 1);
}

TEST_F(ReplayFormats, ReportInvalidRowsAndFail) {
  const FinishedProcess finished =
      replay(write("in.txt", "1 0 0 0 0 0 0 1\n2 0 zero 0 0 0 0 1\n"), path("out.csv"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "in.txt: line 2: 'zero' in column 3 is not a number"));
}

TEST_F(ReplayFormats, AreReadFromAnyNameIfStated) {
  const std::string log = write("run.dat", log_of_requests(3));
  EXPECT_EQ(replay(log, path("out.csv")).exit_code, 0) << "it begins with an event";
  EXPECT_EQ(replay(log, path("out.csv"), {"--format", "lcm"}).exit_code, 0);
  const std::string poses = write("poses.lcmlog", tum());
  EXPECT_EQ(replay(poses, path("out.csv"), {"--format", "tum"}).exit_code, 0);
  EXPECT_EQ(replay(poses, path("out.csv")).exit_code, 1) << "no log";
}

TEST_F(ReplayFormats, NameOneBody) {
  const std::string two = kTestWater +
                          "[[body]]\nid = 4\nname = \"hull\"\nshape = { type = \"box\", size = [1, 1, 1] }\n"
                          "[[body]]\nid = 9\nname = \"buoy\"\nshape = { type = \"box\", size = [2, 2, 2] }\n";
  write("scene.toml", two);
  const std::string in = write("in.txt", "1 0 0 0 0 0 0 1\n");
  const FinishedProcess unnamed = replay(in, path("out.csv"));
  EXPECT_EQ(unnamed.exit_code, 2);
  EXPECT_TRUE(contains(unnamed.standard_error, "poses of one body for a scene with 2 bodies"))
      << unnamed.standard_error;
  EXPECT_EQ(replay(in, path("out.csv"), {"--body", "ship"}).exit_code, 2);
  for (const char* body : {"buoy", "9"}) {
    EXPECT_EQ(replay(in, path("out.csv"), {"--body", body}).exit_code, 0);
    EXPECT_TRUE(contains(read_file(path("out.csv")), "\n1000000,9,0,0,0,40000,"))
        << read_file(path("out.csv"));
  }
}

TEST_F(ReplayFormats, RefuseOptionsThatDoNotApply) {
  const std::string csv = write("in.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n1,1,0,0,0,1,0,0,0\n");
  const std::string log = write("in.lcmlog", log_of_requests(1));
  const std::string poses = write("in.txt", "1 0 0 0 0 0 0 1\n");
  const struct {
    std::string in;
    std::vector<std::string> options;
    const char* error;
  } cases[] = {
      {csv, {"--body", "1"}, "rows of our CSV state both"},
      {csv, {"--time-unit", "ns"}, "rows of our CSV state both"},
      {log, {"--body", "1"}, "the messages of a log state both"},
      {log, {"--time-unit", "ns"}, "the messages of a log state both"},
      {poses, {"--pose", "POSE=1"}, "For a file of poses use --body"},
      {poses, {"--copy", ".*"}, "an .lcmlog as INPUT"},
      {poses, {"--format", "bag"}, "--format"},
      {poses, {"--time-unit", "h"}, "--time-unit"},
      {poses, {"--list"}, "--list: OUTPUT"},
  };
  for (const auto& [in, options, error] : cases) {
    const FinishedProcess finished = replay(in, path("out.csv"), options);
    EXPECT_EQ(finished.exit_code, 2) << error;
    EXPECT_TRUE(contains(finished.standard_error, error)) << finished.standard_error;
  }
}

TEST_F(ReplayFormats, RefusePosesWithoutVelocitiesForABodyWithDrag) {
  write("scene.toml", kLoadsBoxScene);
  const FinishedProcess refused = replay(write("in.txt", tum()), path("out.csv"));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.standard_error,
                       "TUM, time in seconds, without velocities; expected columns of the "
                       "linear and the angular velocity, since body 'hull'"))
      << refused.standard_error;
}

TEST_F(ReplayFormats, ListChannelsWithTypesCountsAndTimes) {
  const std::vector<std::uint8_t> foreign{0x12, 0x34, 0x56, 0x78, 0x9a, 0xbc, 0xde, 0xf0, 1, 2};
  const std::string log = event("POSE", 1'500'000, encoded_by_lcm(upright_pose(0.0, 1))) +
                          event("BUOYANCY_STATES", 2'000'000, request(1, 0.0)) + event("CAMERA", 3, foreign) +
                          event("POSE", 4'500'000, encoded_by_lcm(upright_pose(0.0, 2))) +
                          event("EMPTY", 7, {1});
  const std::string in = write("in.lcmlog", log);
  const FinishedProcess text = run({"--list", in});
  EXPECT_EQ(text.exit_code, 0) << text.standard_error;
  EXPECT_TRUE(contains(text.standard_output, "POSE            bot_core.pose_t")) << text.standard_output;
  const FinishedProcess listed = run({"--list", in, "--json"});
  const auto channels = parse_json(listed.standard_output)["channels"];
  ASSERT_EQ(channels.size(), 4U) << listed.standard_output;
  EXPECT_EQ(channels[0]["type"], "buoyancy.body_states_t");
  EXPECT_EQ(channels[1]["type"], "0x123456789abcdef0");
  EXPECT_EQ(channels[2]["type"], "no fingerprint");
  EXPECT_EQ(channels[3]["channel"], "POSE");
  EXPECT_EQ(channels[3]["messages"], 2);
  EXPECT_EQ(channels[3]["bytes"], 2 * 144);
  EXPECT_EQ(channels[3]["first_utime"], 1'500'000);
  EXPECT_EQ(channels[3]["last_utime"], 4'500'000);
  EXPECT_EQ(run({"--list", write("cut.lcmlog", log.substr(0, log.size() - 1))}).exit_code, 1);
  EXPECT_EQ(run({"--list", path("gone.lcmlog")}).exit_code, 2);
  EXPECT_EQ(run({"--list", in, path("out.csv")}).exit_code, 2) << "nothing is written";
}

TEST_F(ReplayFormats, ListTheFormatOfPoses) {
  const FinishedProcess listed = run({"--list", write("in.txt", tum()), "--json"});
  EXPECT_EQ(listed.exit_code, 0) << listed.standard_error;
  const auto channels = parse_json(listed.standard_output)["channels"];
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_EQ(channels[0]["type"], "TUM, time in seconds, without velocities");
  EXPECT_EQ(channels[0]["messages"], kPoses);
  EXPECT_EQ(channels[0]["first_utime"], 1'700'000'000'000'000);
  EXPECT_EQ(channels[0]["last_utime"], 1'700'000'000'000'000 + 12'345 * (kPoses - 1));
}

TEST_F(ReplayFormats, ListTheChannelsOfALogThatLacksOne) {
  const std::string in = write("in.lcmlog", event("POSE", 1, encoded_by_lcm(upright_pose(0.0, 1))));
  const FinishedProcess finished = replay(in, path("out.lcmlog"));
  EXPECT_TRUE(contains(finished.standard_error,
                       "See --states-channel and --pose. The log has POSE (bot_core.pose_t)"))
      << finished.standard_error;
}

}  // namespace
}  // namespace buoyancy
