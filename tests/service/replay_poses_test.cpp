// Runs buoyancy-replay on logs of bot_core poses, encoded by LCM's own generator.
#include <cmath>
#include <limits>

#include <bot_core/rigid_transform_t.hpp>
#include <bot_core/six_axis_force_torque_t.hpp>
#include <gtest/gtest.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/service/replay_fixture.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"

namespace buoyancy {
namespace {

using ReplayPoses = Replay;

std::string pose_event(std::int64_t timestamp, double height) {
  return event("POSE", timestamp, encoded_by_lcm(upright_pose(height, 10 * timestamp)));
}

std::string log_of_poses(int count) {
  std::string log;
  for (int i = 0; i < count; ++i) log += pose_event(500 + i, 0.01 * i - 2.0);
  return log;
}

// [N], for the partially submerged box of kOneBoxScene.
double force_at(double height) {
  return 10'000.0 * 6.0 * (2.0 - height);
}

std::vector<WrenchResponse> responses_in(const std::string& path) {
  std::vector<WrenchResponse> responses;
  for (const LoggedEvent& event : events_of(path, only_channel("BUOYANCY_WRENCHES"))) {
    responses.push_back(decoded<WrenchResponse>(event.bytes));
  }
  return responses;
}

TEST_F(ReplayPoses, WritesWrenchesOfBodyOfEachPoseChannel) {
  write("in.lcmlog", log_of_poses(20));
  const FinishedProcess finished = replay(path("in.lcmlog"), path("out.lcmlog"), {"--pose", "POSE=1"});
  ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  const std::vector<LoggedEvent> events = events_of(path("out.lcmlog"));
  const std::vector<WrenchResponse> responses = responses_in(path("out.lcmlog"));
  ASSERT_EQ(responses.size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) {
    const auto timestamp = static_cast<std::int64_t>(500 + i);
    EXPECT_EQ(events[i].timestamp, timestamp);
    EXPECT_EQ(responses[i].id.utime, 10 * timestamp);
    ASSERT_EQ(responses[i].bodies.size(), 1U);
    EXPECT_EQ(responses[i].bodies[0].body_id, 1);
    EXPECT_NEAR(responses[i].bodies[0].force[2], force_at(0.01 * static_cast<double>(i) - 2.0), 1e-7);
  }
}

TEST_F(ReplayPoses, AcceptsBodiesByIdOrName) {
  write("scene.toml", "[[body]]\nid = 7\nname = \"hull=A\"\nshape = { type = \"box\", size = [1, 1, 1] }\n");
  write("in.lcmlog", log_of_poses(2));
  for (const char* body : {"POSE=7", "POSE=hull=A"}) {
    // The last '=' separates channel and body: a channel may contain one, a body's name may not.
    const bool has_two = std::string(body) == "POSE=hull=A";
    const FinishedProcess finished = replay(path("in.lcmlog"), path("out.lcmlog"), {"--pose", body});
    EXPECT_EQ(finished.exit_code, has_two ? 2 : 0) << finished.standard_error;
  }
  write("scene.toml", "[[body]]\nid = 7\nname = \"hull\"\nshape = { type = \"box\", size = [1, 1, 1] }\n");
  EXPECT_EQ(replay(path("in.lcmlog"), path("out.lcmlog"), {"--pose", "POSE=hull"}).exit_code, 0);
  EXPECT_EQ(responses_in(path("out.lcmlog")).at(0).bodies.at(0).body_id, 7);
}

TEST_F(ReplayPoses, WritesForceTorqueMessagesOnTheirOwnChannel) {
  std::string log;
  for (int i = 0; i < 5; ++i) {
    bot_core::rigid_transform_t transform{};
    transform.utime = i;
    transform.trans[2] = 0.1 * i;
    transform.quat[0] = 1.0;
    log += event("HULL_TO_LOCAL", 100 + i, encoded_by_lcm(transform));
  }
  write("in.lcmlog", log);
  const FinishedProcess finished = replay(path("in.lcmlog"), path("out.lcmlog"),
                                          {"--pose", "HULL_TO_LOCAL=1", "--force-torque", "HULL_BUOYANCY=1"});
  ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  const std::vector<LoggedEvent> events = events_of(path("out.lcmlog"));
  ASSERT_EQ(events.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(events[i].channel, "HULL_BUOYANCY");
    EXPECT_EQ(events[i].timestamp, static_cast<std::int64_t>(100 + i));
    bot_core::six_axis_force_torque_t message{};
    const auto size = static_cast<int>(events[i].bytes.size());
    ASSERT_EQ(message.decode(events[i].bytes.data(), 0, size), size);
    EXPECT_EQ(message.utime, static_cast<std::int64_t>(i));
    EXPECT_NEAR(message.force[2], force_at(0.1 * static_cast<double>(i)), 1e-7);
    EXPECT_EQ(message.force[0], 0.0);
    EXPECT_NEAR(message.moment[1], 0.0, 1e-9);
  }
}

TEST_F(ReplayPoses, ReadsVelocitiesInFrameOfOption) {
  // Rotated by 90 degrees about y: the body's -x is the world's +z.
  bot_core::pose_t pose = upright_pose(0.0, 1);
  pose.orientation[0] = pose.orientation[2] = std::sqrt(0.5);
  pose.vel[0] = -1.0;
  write("in.lcmlog", event("POSE", 1, encoded_by_lcm(pose)));
  const auto volume = [&](const char* frame) {
    const FinishedProcess finished =
        replay(path("in.lcmlog"), path("out.lcmlog"),
               {"--pose", "POSE=1", "--lead-time", "0.5", "--velocity-frame", frame});
    EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
    return responses_in(path("out.lcmlog")).at(0).bodies.at(0).submerged_volume;
  };
  // On its side the box is 4 x 3 m wide and 2 m high.
  EXPECT_NEAR(volume("world"), 12.0, 1e-9) << "moves along the surface";
  EXPECT_NEAR(volume("body"), 12.0 - 12.0 * 0.5, 1e-9) << "rises by 0.5 m";
}

TEST_F(ReplayPoses, ReportsNonFiniteTwistForLeadTimeWithoutVelocity) {
  bot_core::rigid_transform_t transform{};
  transform.quat[0] = 1.0;
  write("in.lcmlog", event("POSE", 1, encoded_by_lcm(transform)));
  const FinishedProcess finished =
      replay(path("in.lcmlog"), path("out.lcmlog"),
             {"--pose", "POSE=1", "--lead-time", "0.5", "--velocity-frame", "world", "--json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
  EXPECT_EQ(responses_in(path("out.lcmlog")).at(0).bodies.at(0).status, BodyStatus::kNonFiniteTwist);
}

TEST_F(ReplayPoses, ReportsAndCountsInvalidPoses) {
  write("in.lcmlog", pose_event(1, 0.0) + event("POSE", 2, {1, 2, 3}) + event("POSE", 3, request(1, 0.0)) +
                         pose_event(4, 0.0));
  const FinishedProcess finished =
      replay(path("in.lcmlog"), path("out.lcmlog"), {"--pose", "POSE=1", "--json"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "event at 2 us is not a valid pose: shorter"));
  EXPECT_TRUE(contains(finished.standard_error, "event at 3 us is not a valid pose: fingerprint"));
  const auto summary = parse_json(finished.standard_output);
  EXPECT_EQ(summary["requests"], 4);
  EXPECT_EQ(summary["computed"], 2);
  EXPECT_EQ(summary["rejected"]["truncated"], 1);
  EXPECT_EQ(summary["rejected"]["fingerprint"], 1);
}

TEST_F(ReplayPoses, HandlesPosesAroundCorruptSectionAndReportsIt) {
  const std::string before = log_of_poses(10);
  write("in.lcmlog", before + "garbage" + log_of_poses(10));
  const FinishedProcess finished = replay(path("in.lcmlog"), path("out.lcmlog"), {"--pose", "POSE=1"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "corrupt at byte " + std::to_string(before.size())));
  EXPECT_EQ(responses_in(path("out.lcmlog")).size(), 20U);
}

TEST_F(ReplayPoses, CopiesMatchingChannelsInOrderOnRequest) {
  write("in.lcmlog", event("LIDAR", 1, {1, 2}) + pose_event(2, 0.0) + event("BUOYANCY_WRENCHES", 3, {3}) +
                         event("LIDAR_STATUS", 4, {4}) + pose_event(5, 1.0));
  const auto channels = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all{"--pose", "POSE=1"};
    all.insert(all.end(), options.begin(), options.end());
    EXPECT_EQ(replay(path("in.lcmlog"), path("out.lcmlog"), all).exit_code, 0);
    std::string found;
    for (const LoggedEvent& event : events_of(path("out.lcmlog"))) {
      found += event.channel + "@" + std::to_string(event.timestamp) + " ";
    }
    return found;
  };
  EXPECT_EQ(channels({}), "BUOYANCY_WRENCHES@2 BUOYANCY_WRENCHES@5 ");
  EXPECT_EQ(channels({"--copy", "LIDAR"}), "LIDAR@1 BUOYANCY_WRENCHES@2 BUOYANCY_WRENCHES@5 ");
  EXPECT_EQ(channels({"--copy", ".*"}),
            "LIDAR@1 POSE@2 BUOYANCY_WRENCHES@2 LIDAR_STATUS@4 POSE@5 BUOYANCY_WRENCHES@5 ")
      << "a recorded response is not copied";
}

TEST_F(ReplayPoses, WritesSameOutputForAnyNumberOfJobs) {
  std::string log;
  for (int i = 0; i < 6000; ++i) {
    log += pose_event(i, 0.001 * i - 3.0);
    if (i % 3 == 0) log += event("BUOYANCY_STATES", i, request(i, 0.0005 * i));
    if (i % 7 == 0) log += event("OTHER", i, {1, 2, 3});
    if (i % 500 == 0) log += event("POSE", i, {1});
    if (i % 1000 == 0) log += "garbage";
  }
  write("in.lcmlog", log);
  const auto outcome = [&](const char* jobs) {
    const FinishedProcess finished = replay(path("in.lcmlog"), path("out.lcmlog"),
                                            {"--pose", "POSE=1", "--copy", "OTHER", "--jobs", jobs});
    EXPECT_EQ(finished.exit_code, 1);
    const std::string& summary = finished.standard_output;
    return read_file(path("out.lcmlog")) + finished.standard_error +
           summary.substr(0, summary.find("seconds"));
  };
  const std::string of_one_job = outcome("1");
  EXPECT_GT(of_one_job.size(), 1'000'000U);
  for (const char* jobs : {"2", "3", "8"}) EXPECT_TRUE(outcome(jobs) == of_one_job) << jobs << " jobs";
}

TEST_F(ReplayPoses, ComparesWithBaselineBodyByBody) {
  write("in.lcmlog", log_of_poses(3000));
  ASSERT_EQ(replay(path("in.lcmlog"), path("baseline.lcmlog"), {"--pose", "POSE=1"}).exit_code, 0);
  const auto compared = [&](const std::string& baseline, int exit_code) {
    const FinishedProcess finished =
        replay(path("in.lcmlog"), "/dev/null", {"--pose", "POSE=1", "--compare", path(baseline), "--json"});
    EXPECT_EQ(finished.exit_code, exit_code) << finished.standard_error << finished.standard_output;
    return parse_json(finished.standard_output)["compared"];
  };
  const auto same = compared("baseline.lcmlog", 0);
  EXPECT_EQ(same["agrees"], true);
  EXPECT_EQ(same["bodies"][0]["responses"], 3000);
  EXPECT_EQ(same["bodies"][0]["force"], 0.0);

  // Another exact method differs by rounding, denser water by more than the bounds.
  const std::string scene = read_file(scene_);
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string changed = scene;
    changed.replace(changed.find(what), what.size(), instead);
    write("scene.toml", changed);
  };
  with("\"exact\"", "\"hierarchical\"");
  EXPECT_EQ(compared("baseline.lcmlog", 0)["agrees"], true);
  with("density = 1000.0", "density = 1001.0");
  const auto denser = compared("baseline.lcmlog", 1);
  EXPECT_EQ(denser["agrees"], false);
  EXPECT_NEAR(denser["bodies"][0]["force"], 24.0 * 10.0, 1e-6) << "a thousandth of the full displacement";
  EXPECT_EQ(denser["bodies"][0]["volume"], 0.0);
  EXPECT_GT(denser["bodies"][0]["force_in_bounds"].get<double>(), 1e6);
  write("scene.toml", scene);

  const std::string baseline = read_file(path("baseline.lcmlog"));
  const std::size_t one = baseline.size() / 3000;
  write("shorter.lcmlog", baseline.substr(0, 10 * one) + baseline.substr(11 * one));
  EXPECT_EQ(compared("shorter.lcmlog", 0)["not_recorded"], 1);
  write("longer.lcmlog", baseline + event("BUOYANCY_WRENCHES", 1, {1}) + baseline.substr(0, one));
  const auto longer = compared("longer.lcmlog", 1);
  EXPECT_EQ(longer["unmatched_baseline"], 1);
  EXPECT_EQ(longer["decode_errors"], 1);
}

TEST_F(ReplayPoses, ReportsDifferencesFromNonFiniteBaselines) {
  write("in.lcmlog", log_of_poses(3));
  ASSERT_EQ(replay(path("in.lcmlog"), path("baseline.lcmlog"), {"--pose", "POSE=1"}).exit_code, 0);
  for (double BodyWrench::*bound : {&BodyWrench::force_error_bound, &BodyWrench::torque_error_bound}) {
    for (const double number : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      for (const bool in_force : {true, false}) {
        std::string changed;
        for (WrenchResponse& response : responses_in(path("baseline.lcmlog"))) {
          BodyWrench& wrench = response.bodies.at(0);
          (in_force ? wrench.force[1] : wrench.*bound) = number;
          changed += event("BUOYANCY_WRENCHES", response.id.utime / 10, encoded(response));
        }
        write("changed.lcmlog", changed);
        EXPECT_EQ(
            replay(path("in.lcmlog"), "/dev/null", {"--pose", "POSE=1", "--compare", path("changed.lcmlog")})
                .exit_code,
            1)
            << number;
      }
    }
  }
}

TEST_F(ReplayPoses, WritesSameBytesForAnyOrderOfPoseOptions) {
  write("in.lcmlog", log_of_poses(5) + event("HULL", 900, encoded_by_lcm(upright_pose(0.5, 9'000))));
  ASSERT_EQ(run({"--scene", scene_, "--pose", "POSE=1", "--pose", "HULL=1", path("in.lcmlog"),
                 path("a.lcmlog"), "--jobs", "1"})
                .exit_code,
            0)
      << "an option takes one value, so INPUT is not a value of --pose";
  ASSERT_EQ(replay(path("in.lcmlog"), path("b.lcmlog"), {"--pose", "HULL=1", "--pose", "POSE=1"}).exit_code,
            0);
  EXPECT_TRUE(read_file(path("a.lcmlog")) == read_file(path("b.lcmlog")));
}

TEST_F(ReplayPoses, WarnsAboutChannelsThatAreNotInLog) {
  write("in.lcmlog", log_of_poses(2));
  const FinishedProcess misspelt =
      replay(path("in.lcmlog"), path("out.lcmlog"), {"--pose", "POSE=1", "--pose", "POZE=1"});
  EXPECT_EQ(misspelt.exit_code, 0);
  EXPECT_TRUE(contains(misspelt.standard_error, "warning: channel POZE: no events"));
  EXPECT_FALSE(contains(misspelt.standard_error, "POSE:"));
  EXPECT_TRUE(
      contains(replay(path("in.lcmlog"), path("out.lcmlog")).standard_error, "channel BUOYANCY_STATES"));
}

TEST_F(ReplayPoses, RejectsNameThatTwoBodiesShare) {
  write("scene.toml",
        "[[body]]\nid = 1\nname = \"a\"\nshape = { type = \"box\", size = [1, 1, 1] }\n"
        "[[body]]\nid = 2\nname = \"a\"\nshape = { type = \"box\", size = [2, 2, 2] }\n");
  write("in.lcmlog", log_of_poses(1));
  const FinishedProcess rejected = replay(path("in.lcmlog"), path("out.lcmlog"), {"--pose", "POSE=a"});
  EXPECT_EQ(rejected.exit_code, 2);
  EXPECT_TRUE(contains(rejected.standard_error, "2 bodies are named 'a'"));
}

TEST_F(ReplayPoses, RejectsInvalidChannelsAndBodiesWithUsageError) {
  const std::string in = write("in.lcmlog", log_of_poses(1));
  const std::string out = path("out.lcmlog");
  const std::vector<std::vector<std::string>> invalid{
      {"--pose", "POSE"},
      {"--pose", "=1"},
      {"--pose", "POSE=2"},
      {"--pose", "POSE="},
      {"--pose", std::string(64, 'a') + "=1"},
      {"--pose", "POSE=1", "--pose", "POSE=1"},
      {"--pose", "BUOYANCY_STATES=1"},
      {"--pose", "BUOYANCY_WRENCHES=1"},
      {"--force-torque", "FT=1"},
      {"--pose", "POSE=1", "--force-torque", "POSE=1"},
      {"--pose", "POSE=1", "--force-torque", "A=1", "--force-torque", "B=1"},
      {"--pose", "POSE=1", "--lead-time", "0.1"},
      {"--pose", "POSE=1", "--lead-time", "inf", "--velocity-frame", "body"},
      {"--pose", "POSE=1", "--velocity-frame", "sideways"},
      {"--wrenches-channel", "BUOYANCY_STATES"},
      {"--copy", "("},
      {"--jobs", "-1"},
      {"--compare", path("gone.lcmlog")},
      {"--compare", out},
      {"--pose", "POSE=1", "--force-torque", "FT=1", "--compare", in},
  };
  write("out.lcmlog", "");
  for (const std::vector<std::string>& options : invalid) {
    const FinishedProcess finished = replay(in, out, options);
    std::string shown;
    for (const std::string& option : options) shown += option + " ";
    EXPECT_EQ(finished.exit_code, 2) << shown << finished.standard_error;
    EXPECT_EQ(finished.standard_error.rfind("buoyancy-replay: ", 0), 0U) << shown;
  }
  const std::string csv = write("in.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n");
  EXPECT_EQ(replay(csv, out, {"--pose", "POSE=1"}).exit_code, 2);
  EXPECT_EQ(replay(csv, out, {"--copy", ".*"}).exit_code, 2);
  EXPECT_EQ(replay(in, path("out.csv"), {"--pose", "POSE=1", "--force-torque", "FT=1"}).exit_code, 2);
  EXPECT_EQ(replay(in, path("out.csv"), {"--copy", ".*"}).exit_code, 2);
}

}  // namespace
}  // namespace buoyancy
