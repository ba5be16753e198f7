// Runs buoyancy-replay as a program on generated files.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <sstream>
#include <thread>

#include <Eigen/LU>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/unique_fd.h"
#include "base/vec3.h"
#include "messages/wire.h"
#include "recording/event_log.h"
#include "tests/geometry/mesh_files.h"
#include "tests/service/replay_fixture.h"
#include "tests/support/contains.h"
#include "tests/support/csv.h"
#include "tests/support/json.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

constexpr const char* kPoseHeader = "utime,body_id,px,py,pz,qw,qx,qy,qz\n";
constexpr const char* kWrenchHeader =
    "utime,body_id,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz,force_error_bound,torque_error_bound\n";

// A unit cube centred on its origin, as OBJ.
constexpr const char* kCube =
    "v -0.5 -0.5 -0.5\nv 0.5 -0.5 -0.5\nv 0.5 0.5 -0.5\nv -0.5 0.5 -0.5\n"
    "v -0.5 -0.5 0.5\nv 0.5 -0.5 0.5\nv 0.5 0.5 0.5\nv -0.5 0.5 0.5\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string pose_row(int utime, double height) {
  std::ostringstream row;
  row << utime << ",1,7,8," << height << ",1,0,0,0\n";
  return row.str();
}

TEST_F(Replay, MatchesArchimedesPrincipleForEachCsvRow) {
  std::string poses = kPoseHeader;
  for (int i = 0; i < 50; ++i) poses += pose_row(i / 2, 0.1 * i - 2.5);
  poses += "99,77,0,0,0,1,0,0,0\n99,1,nan,0,0,1,0,0,0\n";
  const FinishedProcess finished = replay(write("in.csv", poses), path("out.csv"));
  ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  EXPECT_EQ(finished.standard_error, "");
  const std::string csv = read_file(path("out.csv"));
  EXPECT_EQ(csv.rfind(kWrenchHeader, 0), 0U) << csv;
  const std::vector<CsvRow> responses = csv_rows(csv);
  ASSERT_EQ(responses.size(), 53U);
  for (std::size_t i = 0; i < 50; ++i) {
    const CsvRow& row = responses[i + 1];
    ASSERT_EQ(row.size(), 15U);
    const double depth = std::clamp(2.0 - (0.1 * static_cast<double>(i) - 2.5), 0.0, 4.0);
    EXPECT_EQ(row[0], std::to_string(i / 2));
    EXPECT_EQ(row[1], "1");
    EXPECT_EQ(row[2], "0");
    EXPECT_NEAR(std::stod(row[5]), 10'000.0 * 6.0 * depth, 1e-7) << i;
    EXPECT_NEAR(std::stod(row[9]), 6.0 * depth, 1e-12) << i;
  }
  EXPECT_EQ(responses[51][2], "1") << "unknown body";
  EXPECT_EQ(responses[52][2], "2") << "pose not finite";
  EXPECT_EQ(std::stod(responses[52][5]), 0.0);
}

TEST_F(Replay, WritesNumbersThatRoundTripExactly) {
  replay(write("in.csv", std::string(kPoseHeader) + "0,1,0,0,0.1,0.9998,0.02,0,0\n"), path("out.csv"));
  replay(path("in.csv"), path("out.lcmlog"));
  const auto response = decoded<WrenchResponse>(events_of(path("out.lcmlog")).at(0).bytes);
  const CsvRow row = csv_rows(read_file(path("out.csv"))).at(1);
  const BodyWrench& wrench = response.bodies.at(0);
  EXPECT_EQ(std::stod(row[5]), wrench.force[2]);
  EXPECT_EQ(std::stod(row[6]), wrench.torque[0]);
  EXPECT_NE(wrench.torque[0], 0.0);
  EXPECT_EQ(std::stod(row[9]), wrench.submerged_volume);
  EXPECT_EQ(std::stod(row[12]), wrench.center_of_buoyancy[2]);
  EXPECT_EQ(std::stod(row[13]), wrench.force_error_bound);
}

TEST_F(Replay, KeepsTimestampsAndCopiesNoOtherChannel) {
  const std::string log = event("OTHER", 1, {1, 2}) + event("BUOYANCY_STATES", 2, request(20, 0.0)) +
                          event("BUOYANCY_WRENCHES", 3, {3}) + event("BUOYANCY_STATES", 4, request(40, 1.0));
  ASSERT_EQ(replay(write("in.lcmlog", log), path("out.lcmlog")).exit_code, 0);
  const std::vector<LoggedEvent> responses = events_of(path("out.lcmlog"));
  ASSERT_EQ(responses.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto timestamp = static_cast<std::int64_t>(2 * i + 2);
    EXPECT_EQ(responses[i].channel, "BUOYANCY_WRENCHES");
    EXPECT_EQ(responses[i].timestamp, timestamp);
    const auto response = decoded<WrenchResponse>(responses[i].bytes);
    EXPECT_EQ(response.id.utime, 10 * timestamp);
    EXPECT_DOUBLE_EQ(response.bodies.at(0).submerged_volume, timestamp == 2 ? 12.0 : 6.0);
  }
}

TEST_F(Replay, WritesRequestedHydrostaticsToLogsOnly) {
  const std::string hydrostatics_scene =
      write("hydrostatics.toml", kOneBoxScene + "outputs = [\"wrench\", \"hydrostatics\"]\n");
  const auto replay_with_hydrostatics = [&](const std::string& output,
                                            const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"--scene", hydrostatics_scene, path("in.lcmlog"), output};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(std::move(arguments)).exit_code;
  };
  write("in.lcmlog", log_of_requests(3));
  ASSERT_EQ(replay_with_hydrostatics(path("out.lcmlog"), {"--hydrostatics-channel", "H"}), 0);
  const std::vector<LoggedEvent> found = events_of(path("out.lcmlog"), only_channel("H"));
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto seq = static_cast<std::int64_t>(i);
    EXPECT_EQ(found[i].timestamp, 500 + seq);
    const auto hydrostatics = decoded<BodiesHydrostatics>(found[i].bytes);
    EXPECT_EQ(hydrostatics.id.seq, seq);
    EXPECT_DOUBLE_EQ(hydrostatics.bodies.at(0).waterplane_area, 6.0);
  }

  ASSERT_EQ(replay_with_hydrostatics(path("requested.csv"), {}), 0);
  ASSERT_EQ(replay(path("in.lcmlog"), path("not_requested.csv")).exit_code, 0);
  EXPECT_EQ(read_file(path("requested.csv")), read_file(path("not_requested.csv")));
  EXPECT_EQ(replay_with_hydrostatics(path("x.lcmlog"), {"--hydrostatics-channel", "BUOYANCY_WRENCHES"}), 2);
}

// The three poses are partially, fully and not submerged.
TEST_F(Replay, ComparesCentresAndHydrostatics) {
  const std::string hydrostatics_scene =
      write("hydrostatics.toml",
            kOneBoxScene + "outputs = [\"wrench\", \"hydrostatics\"]\n" + "[body.client]\nmass = 9e3\n");
  std::string log;
  for (const double height : {0.3, -9.0, 9.0}) log += event("BUOYANCY_STATES", 1, request(1, height));
  write("in.lcmlog", log);
  ASSERT_EQ(run({"--scene", hydrostatics_scene, path("in.lcmlog"), path("baseline.lcmlog")}).exit_code, 0);
  const auto compared = [&](const std::string& scene, const std::string& baseline, int exit_code) {
    const FinishedProcess finished =
        run({"--scene", scene, path("in.lcmlog"), "/dev/null", "--compare", path(baseline), "--json"});
    EXPECT_EQ(finished.exit_code, exit_code) << finished.standard_error << finished.standard_output;
    return parse_json(finished.standard_output)["compared"];
  };
  const auto same = compared(hydrostatics_scene, "baseline.lcmlog", 0)["bodies"][0];
  EXPECT_EQ(same["hydrostatics"], 3);
  EXPECT_EQ(same["hydrostatics_in_bounds"], 0.0);
  EXPECT_EQ(same["center_in_bounds"], 0.0);
  EXPECT_EQ(compared(scene_, "baseline.lcmlog", 1)["unmatched_baseline"], 3) << "the hydrostatics";

  // The first message of `channel`, of the partly submerged body, after `change`.
  const auto changed = [&](const std::string& channel, auto message, const auto& change) {
    std::string all;
    bool first = true;
    for (LoggedEvent& one : events_of(path("baseline.lcmlog"))) {
      if (one.channel == channel && std::exchange(first, false)) {
        EXPECT_FALSE(decode(one.bytes, message));
        change(message.bodies.at(0));
        encode(message, one.bytes);
      }
      all += event(one.channel, one.timestamp, one.bytes);
    }
    write("changed.lcmlog", all);
    return compared(hydrostatics_scene, "changed.lcmlog", 1)["bodies"][0];
  };
  for (const double shift : {1e-9, std::nan("")}) {
    const auto moved = changed("BUOYANCY_WRENCHES", WrenchResponse{},
                               [&](BodyWrench& wrench) { wrench.center_of_buoyancy[2] += shift; });
    if (!std::isnan(shift)) {
      EXPECT_NEAR(moved["center"], shift, 1e-3 * shift);
      EXPECT_GT(moved["center_in_bounds"].get<double>(), 1.0);
    }
    using Change = std::pair<const char*, std::function<void(BodyHydrostatics&)>>;
    for (const auto& [field, change] : std::initializer_list<Change>{
             {"submerged_volume", [&](BodyHydrostatics& body) { body.submerged_volume += shift; }},
             {"center_of_buoyancy", [&](BodyHydrostatics& body) { body.center_of_buoyancy[1] += shift; }},
             {"wetted_area", [&](BodyHydrostatics& body) { body.wetted_area += shift; }},
             {"waterplane_area", [&](BodyHydrostatics& body) { body.waterplane_area += shift; }},
             {"waterplane_centroid", [&](BodyHydrostatics& body) { body.waterplane_centroid[0] += shift; }},
             {"waterplane_second_moments",
              [&](BodyHydrostatics& body) { body.waterplane_second_moments[1] += shift; }},
             {"waterplane_axes", [&](BodyHydrostatics& body) { body.waterplane_axes[1][2] += shift; }},
             {"metacentric_radii", [&](BodyHydrostatics& body) { body.metacentric_radii[0] += shift; }},
             {"metacenters", [&](BodyHydrostatics& body) { body.metacenters[0][2] += shift; }},
             {"metacentric_heights", [&](BodyHydrostatics& body) { body.metacentric_heights[1] += shift; }},
             {"stiffness", [&](BodyHydrostatics& body) { body.stiffness[4][4] += 1e4 * shift; }}}) {
      const auto differing = changed("BUOYANCY_HYDROSTATICS", BodiesHydrostatics{}, change);
      EXPECT_EQ(differing["hydrostatics_worst_field"], field) << differing;
      EXPECT_EQ(differing["center_in_bounds"], 0.0);
    }
  }
}

TEST_F(Replay, WritesSameResponsesForCsvAndLogInput) {
  std::string poses = kPoseHeader;
  for (int i = 0; i < 20; ++i) poses += pose_row(i, 0.125 * i);
  ASSERT_EQ(replay(write("in.csv", poses), path("from_csv.csv")).exit_code, 0);
  ASSERT_EQ(replay(write("in.lcmlog", log_of_requests(20)), path("from_log.csv")).exit_code, 0);
  EXPECT_EQ(read_file(path("from_csv.csv")), read_file(path("from_log.csv")));
}

TEST_F(Replay, WritesSameBytesInEveryRun) {
  write("in.lcmlog", log_of_requests(100));
  ASSERT_EQ(replay(path("in.lcmlog"), path("a.lcmlog")).exit_code, 0);
  ASSERT_EQ(replay(path("in.lcmlog"), path("b.lcmlog")).exit_code, 0);
  EXPECT_EQ(read_file(path("a.lcmlog")), read_file(path("b.lcmlog")));
  EXPECT_GT(read_file(path("a.lcmlog")).size(), 10'000U);
}

TEST_F(Replay, HandlesIntactEventsOfCorruptLogAndFails) {
  std::string log = log_of_requests(10);
  const std::size_t middle = log.size() / 2;
  log.insert(middle, "garbage");
  log.resize(log.size() - 3);
  const FinishedProcess finished = replay(write("in.lcmlog", log), path("out.csv"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "corrupt at byte " + std::to_string(middle)));
  EXPECT_TRUE(contains(finished.standard_error, "the file ends within an event"));
  EXPECT_EQ(csv_rows(read_file(path("out.csv"))).size(), 1U + 9U);
}

TEST_F(Replay, ReportsAndCountsInvalidRequests) {
  const std::string log = event("BUOYANCY_STATES", 1, {1, 2, 3}) + log_of_requests(2);
  const FinishedProcess finished = replay(write("in.lcmlog", log), path("out.csv"), {"--json"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "shorter than the fixed fields"));
  const auto summary = parse_json(finished.standard_output);
  EXPECT_EQ(summary["requests"], 3);
  EXPECT_EQ(summary["computed"], 2);
  EXPECT_EQ(summary["rejected"]["truncated"], 1);
  EXPECT_EQ(summary["bodies"]["OK"], 2);
  EXPECT_EQ(summary["complete"], false);
}

TEST_F(Replay, ReportsMalformedRowsByLineAndFails) {
  const std::string poses = kPoseHeader + pose_row(1, 0.0) + "2,1,zero,0,0,1,0,0,0\n" + pose_row(3, 0.0);
  const FinishedProcess finished = replay(write("in.csv", poses), path("out.csv"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "line 3: 'zero' in column 3"));
  EXPECT_EQ(csv_rows(read_file(path("out.csv"))).size(), 3U);
}

TEST_F(Replay, PrintsFirstInputErrorsAndCountsRest) {
  std::string poses = kPoseHeader;
  for (int i = 0; i < 1000; ++i) poses += "x\n";
  const FinishedProcess finished = replay(write("in.csv", poses), path("out.csv"), {"--json"});
  EXPECT_EQ(finished.exit_code, 1);
  const std::string& error = finished.standard_error;
  EXPECT_LT(std::count(error.begin(), error.end(), '\n'), 30) << error;
  EXPECT_EQ(parse_json(finished.standard_output)["corrupt_sections"], 1000);
}

TEST_F(Replay, WritesEmptyOutputForEmptyInput) {
  EXPECT_EQ(replay(write("in.csv", ""), path("out.csv")).exit_code, 0);
  EXPECT_EQ(read_file(path("out.csv")), kWrenchHeader);
  EXPECT_EQ(replay(write("in.lcmlog", ""), path("out.lcmlog")).exit_code, 0);
  EXPECT_EQ(read_file(path("out.lcmlog")), "");
}

TEST_F(Replay, AcceptsOneMeshInsteadOfScene) {
  write("cube.obj", kCube);
  write("in.csv", kPoseHeader + pose_row(0, 0.25));
  const FinishedProcess finished = run({"--mesh", path("cube.obj"), path("in.csv"), path("out.csv")});
  ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  const CsvRow row = csv_rows(read_file(path("out.csv"))).at(1);
  EXPECT_NEAR(std::stod(row[5]), 0.25 * 1025.0 * 9.80665, 1e-9);
  const FinishedProcess fast =
      run({"--mesh", path("cube.obj"), "--method", "fast", path("in.csv"), path("fast.csv")});
  ASSERT_EQ(fast.exit_code, 0) << fast.standard_error;
  EXPECT_NE(read_file(path("fast.csv")), read_file(path("out.csv")));
}

// The same mesh, placed by options, and written as it is placed.
TEST_F(Replay, PlacesTheMeshAsScaleAndUpSay) {
  const auto wedge = [](const Mat3& place) {
    std::ostringstream obj;
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 0), Vec3(0.5, 0.25, 3)}) {
      obj << "v " << (place * corner).transpose() << '\n';
    }
    const bool mirror = place.determinant() < 0.0;
    obj << (mirror ? "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n" : "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    return obj.str();
  };
  const auto responses = [this](const std::string& obj, const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"--mesh", write("wedge.obj", obj), path("in.csv"), path("out.csv")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const FinishedProcess finished = run(arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
    EXPECT_EQ(finished.standard_error, "");
    return read_file(path("out.csv"));
  };
  write("in.csv", kPoseHeader + pose_row(0, -0.25) + "1,1,0,0,-0.5,0.8,0.6,0,0\n");
  const auto rows = [](const Vec3& x, const Vec3& y, const Vec3& z) {
    return (Mat3() << x.transpose(), y.transpose(), z.transpose()).finished();
  };
  const Vec3 x = Vec3::UnitX();
  const Vec3 y = Vec3::UnitY();
  const Vec3 z = Vec3::UnitZ();
  const std::vector<std::pair<std::vector<std::string>, Mat3>> cases{
      {{"--scale", "1", "--up", "z"}, rows(x, y, z)},
      {{"--scale", "0.5"}, rows(x / 2, y / 2, z / 2)},
      {{"--scale", "1,1,1.5"}, rows(x, y, 1.5 * z)},
      {{"--scale=-1,1,1"}, rows(-x, y, z)},
      {{"--up", "y"}, rows(x, -z, y)},
      {{"--up=-y"}, rows(x, z, -y)},
      {{"--up=-z"}, rows(x, -y, -z)},
      {{"--up", "x"}, rows(-z, y, x)},
      {{"--up=-x"}, rows(z, y, -x)},
      // The axis of the file becomes up, whatever the factors.
      {{"--up", "y", "--scale", "1,-2,1"}, rows(x, z, 2 * y)}};
  for (const auto& [options, place] : cases) {
    EXPECT_EQ(responses(wedge(Mat3::Identity()), options), responses(wedge(place), {})) << options.front();
  }
}

TEST_F(Replay, WarnsOfAMeshOnItsSideUnlessUpStandsItUp) {
  const std::string mesh = write("side.dae", tetrahedron::collada("<up_axis>Y_UP</up_axis>"));
  write("in.csv", kPoseHeader + pose_row(0, 0.25));
  const std::vector<std::string> plain{"--mesh", mesh, path("in.csv"), path("out.csv")};
  const auto with = [&](const std::string& up) {
    std::vector<std::string> arguments = plain;
    arguments.push_back(up);
    return run(arguments).standard_error;
  };
  const std::string warning = run(plain).standard_error;
  EXPECT_TRUE(contains(warning, ": warning: "));
  EXPECT_TRUE(contains(warning, "Pass --up y; in a scene file, orientation = [0.70710678"));
  EXPECT_EQ(with("--up=y"), "");
  EXPECT_TRUE(contains(with("--up=x"), "Pass --up y;"));
}

TEST_F(Replay, SaysWhichScaleAndAxisAreExpected) {
  const auto error_with = [this](const std::string& option) {
    return run({"--mesh", "a.obj", option, path("in.csv"), path("out.csv")}).standard_error;
  };
  EXPECT_EQ(
      error_with("--scale=1,0,1"),
      "buoyancy-replay: --scale: '1,0,1'; expected a number above 0, or factors X,Y,Z of the three axes of "
      "which none is 0. Likely cause: a mesh without an extent. For millimetres write --scale 0.001.\n");
  EXPECT_TRUE(contains(error_with("--scale=-1"), "such as --scale=-1,1,1"));
  for (const std::string scale : {"0", "nan", "inf", "1,1", "1,1,1,1", "1,1,inf", "1,1,", "large"}) {
    EXPECT_TRUE(
        contains(error_with("--scale=" + scale), "'" + scale + "'; expected a number above 0, or factors"));
  }
  for (const std::string axis : {"w", "xy", "-", "--x", "Y"}) {
    EXPECT_EQ(error_with("--up=" + axis), "buoyancy-replay: --up: '" + axis +
                                              "'; expected one of x y z -x -y -z, an axis of the mesh. "
                                              "Write a negative axis with an equals sign: --up=-x.\n");
  }
}

TEST_F(Replay, RejectsInvalidArgumentsWithOneLineAndUsageError) {
  const std::string in = write("in.csv", kPoseHeader + pose_row(0, 0.0));
  const std::string out = path("out.csv");
  const std::string cube = write("cube.obj", kCube);
  const std::string wrong_header = write("header.csv", "a,b\n1,2\n");
  const std::string untouched = read_file(in);
  const std::vector<std::vector<std::string>> invalid{
      {},
      {in, out},
      {"--scene", scene_, in},
      {"--scene", scene_, "--mesh", cube, in, out},
      {"--scene", scene_, "--method", "fast", in, out},
      {"--scene", scene_, "--tolerance", "0.1", in, out},
      {"--mesh", cube, "--method", "slow", in, out},
      {"--mesh", cube, "--tolerance", "2", in, out},
      {"--mesh", cube, "--open", "wet", in, out},
      {"--mesh", cube, "--scale", "0", in, out},
      {"--mesh", cube, "--up", "w", in, out},
      {"--scene", scene_, "--scale", "2", in, out},
      {"--scene", scene_, "--up", "y", in, out},
      {"--scene", scene_, "--open", "dry_boundary", in, out},
      {"--mesh", path("gone.obj"), in, out},
      {"--mesh", in, in, out},
      {"--scene", path("gone.toml"), in, out},
      {"--scene", scene_, path("gone.csv"), out},
      {"--scene", scene_, path("gone.lcmlog"), out},
      {"--scene", scene_, in, path("out.txt")},
      {"--scene", scene_, write("in.txt", "hello\n"), out},
      {"--scene", scene_, in, in},
      {"--scene", scene_, in, path("./in.csv")},
      {"--scene", scene_, wrong_header, out},
      {"--scene", scene_, in, out, "--states-channel", std::string(64, 'a')},
      {"--scene", scene_, in, out, "--no-such-option"},
  };
  for (const std::vector<std::string>& arguments : invalid) {
    const FinishedProcess finished = run(arguments);
    std::string shown;
    for (const std::string& argument : arguments) shown += argument + " ";
    EXPECT_EQ(finished.exit_code, 2) << shown << ": " << finished.standard_error;
    EXPECT_EQ(finished.standard_output, "") << shown;
    const std::string& error = finished.standard_error;
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << shown << ": " << error;
    EXPECT_EQ(error.rfind("buoyancy-replay: ", 0), 0U) << shown << ": " << error;
  }
  EXPECT_EQ(read_file(in), untouched);
  EXPECT_EQ(read_file(out), "") << "no output without a replay";
}

TEST_F(Replay, FailsIfOutputCannotBeWritten) {
  const std::string in = write("in.csv", kPoseHeader + pose_row(0, 0.0));
  std::filesystem::create_symlink("/dev/full", path("full.csv"));
  for (const std::string& out :
       {std::string("/dev/full"), path("full.csv"), path("gone/out.csv"), path(".") + "/"}) {
    const FinishedProcess finished = replay(in, out);
    const bool no_extension = out.back() == '/';
    EXPECT_EQ(finished.exit_code, no_extension ? 2 : 1) << out << ": " << finished.standard_error;
    EXPECT_EQ(std::count(finished.standard_error.begin(), finished.standard_error.end(), '\n'), 1)
        << finished.standard_error;
  }
}

TEST_F(Replay, ReportsTheLimitOnTheSizeOfItsOutput) {
  const std::string program = built_program("buoyancy-replay");
  const FinishedProcess limited =
      run_to_end(command_of({"/bin/sh", "-c", "ulimit -f 1; exec \"$@\"", "sh", program, "--scene", scene_,
                             write("in.lcmlog", log_of_requests(100)), path("out.csv")}),
                 kWaitTimeout);
  EXPECT_EQ(limited.exit_code, 1) << limited.standard_error;
  EXPECT_TRUE(contains(limited.standard_error, "File too large"));
}

TEST_F(Replay, EndsItsOutputWithWholeRowWhenTerminated) {
  write("scene.toml",
        "[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 3, 4], segments = [20, 20, 20] }\n"
        "method = \"exact\"\n");
  std::string poses = kPoseHeader;
  for (int i = 0; i < 200'000; ++i) poses += pose_row(i, 1e-5 * i);
  ChildProcess child(command({"--scene", scene_, write("in.csv", poses), path("out.csv")}));
  std::error_code not_there_yet;
  while (std::filesystem::file_size(path("out.csv"), not_there_yet) + 1 <= 1) {
    ASSERT_FALSE(child.wait(0.002)) << child.standard_error();
  }
  child.send_signal(SIGTERM);
  EXPECT_EQ(child.wait(kWaitTimeout), 1);
  EXPECT_TRUE(contains(child.standard_error(), "terminated by SIGTERM"));
  const std::string csv = read_file(path("out.csv"));
  EXPECT_EQ(csv.back(), '\n');
  const std::vector<CsvRow> responses = csv_rows(csv);
  EXPECT_GT(responses.size(), 1U);
  EXPECT_LT(responses.size(), 200'001U);
  EXPECT_EQ(responses.back().size(), 15U);
}

TEST_F(Replay, StopsOnSignalIfItsPipeHasNoActiveReader) {
  std::string poses = kPoseHeader;
  for (int i = 0; i < 20'000; ++i) poses += pose_row(i, 1e-4 * i);
  write("in.csv", poses);
  for (const auto& [signal, name] : {std::pair{SIGTERM, "SIGTERM"}, std::pair{SIGINT, "SIGINT"}}) {
    const std::string pipe = path(std::string(name) + ".csv");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const UniqueFd reader(::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    ChildProcess child(command({"--scene", scene_, path("in.csv"), pipe}));
    const auto waiting = [&reader] {
      int bytes = 0;
      ::ioctl(reader.value(), FIONREAD, &bytes);
      return bytes;
    };
    for (int before = 0, now = -1; now < 60'000 || now != before; now = waiting()) {
      before = now;
      ASSERT_FALSE(child.wait(0.002)) << child.standard_error();
    }
    child.send_signal(signal);
    EXPECT_EQ(child.wait(kWaitTimeout), 1);
    EXPECT_TRUE(contains(child.standard_error(), "its reader has stalled"));
    std::string csv(static_cast<std::size_t>(waiting()), ' ');
    ASSERT_EQ(::read(reader.value(), csv.data(), csv.size()), static_cast<ssize_t>(csv.size()));
    EXPECT_EQ(csv.rfind(kWrenchHeader, 0), 0U);
    EXPECT_EQ(csv.back(), '\n') << csv.substr(csv.rfind('\n'));
  }
}

bool has_open(const ChildProcess& child, const std::string& file) {
  const std::string descriptors = "/proc/" + std::to_string(child.pid()) + "/fd";
  std::error_code ended;
  for (std::filesystem::directory_iterator open(descriptors, ended), end; open != end;
       open.increment(ended)) {
    if (std::filesystem::read_symlink(open->path(), ended) == file) return true;
    if (ended) break;
  }
  return false;
}

bool is_asleep(const ChildProcess& child) {
  std::ifstream file("/proc/" + std::to_string(child.pid()) + "/stat");
  std::string text;
  std::getline(file, text);
  return contains(text, ") S ");
}

// Waits until the child has opened the file and waits for something else, so that it knows the file's size.
// Returns whether it still runs then.
bool wait_until_open(ChildProcess& child, const std::string& file) {
  while (!child.wait(0.002)) {
    if (has_open(child, file) && is_asleep(child)) return true;
  }
  return false;
}

// Waits until the child takes SIGTERM when it suits it, which it does not before it has opened its files, and
// returns whether it still runs then.
bool wait_until_it_handles_sigterm(ChildProcess& child) {
  while (!child.wait(0.002)) {
    std::ifstream status("/proc/" + std::to_string(child.pid()) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.rfind("SigBlk:", 0) != 0) continue;
      const std::uint64_t blocked = std::stoull(line.substr(7), nullptr, 16);
      const auto is_blocked = [blocked](int signal) { return (blocked >> (signal - 1) & 1U) != 0; };
      // posix_spawn() and the starts of threads block all signals for a moment.
      if (is_blocked(SIGTERM) && !is_blocked(SIGUSR2)) return true;
    }
  }
  return false;
}

TEST_F(Replay, EndsAtEventIfLogIsTruncatedMeanwhile) {
  constexpr int kRequests = 20'000;
  const std::string log = log_of_requests(kRequests);
  const std::string input = write("in.lcmlog", log);
  const std::string pipe = path("out.lcmlog");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ChildProcess child(command({"--scene", scene_, input, pipe}));
  ASSERT_TRUE(wait_until_open(child, input)) << child.standard_error();
  std::filesystem::resize_file(input, log.size() / 2 + 7);
  // Only now may it write, and so read.
  const UniqueFd reader(::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  std::string output;
  std::string part(65'536, ' ');
  for (bool ended = false; !ended;) {
    ended = child.wait(0.001).has_value();
    for (ssize_t got = 0; (got = ::read(reader.value(), part.data(), part.size())) > 0;) {
      output.append(part, 0, static_cast<std::size_t>(got));
    }
  }
  EXPECT_EQ(child.wait(kWaitTimeout), 1);
  EXPECT_TRUE(contains(child.standard_error(), "it was truncated or replaced while it was read"));
  const std::vector<LoggedEvent> events = events_of(write("out_copy.lcmlog", output));
  ASSERT_GE(events.size(), kRequests / 2U - 10);  // the last kilobyte before the fault is not used
  std::string again;
  for (std::size_t i = 0; i < events.size(); ++i)
    again += event(events[i].channel, events[i].timestamp, events[i].bytes);
  EXPECT_EQ(again.size(), output.size()) << "OUTPUT ends within an event";
}

TEST_F(Replay, EndsWithinDamageAfterSignal) {
  const std::string input = write("in.lcmlog", "");
  std::filesystem::resize_file(input, 1'000'000'000'000);  // of zeros, and no byte on the disk
  ChildProcess child(command({"--scene", scene_, input, path("out.lcmlog")}));
  ASSERT_TRUE(wait_until_it_handles_sigterm(child)) << child.standard_error();
  child.send_signal(SIGTERM);
  EXPECT_EQ(child.wait(kWaitTimeout), 1);
  EXPECT_TRUE(contains(child.standard_error(), "terminated by SIGTERM"));
}

TEST_F(Replay, AcceptsOpenMeshesWithDryBoundaryOnRequest) {
  const std::string lid = "f 5 6 7 8\n";
  std::string cup = kCube;
  cup.erase(cup.find(lid), lid.size());
  const std::string mesh = write("cup.obj", cup);
  write("in.csv", kPoseHeader + pose_row(0, 0.25) + pose_row(1, -0.75));
  const std::vector<std::string> arguments{"--mesh", mesh, path("in.csv"), path("out.csv")};
  const FinishedProcess rejected = run(arguments);
  EXPECT_EQ(rejected.exit_code, 2);
  EXPECT_TRUE(contains(rejected.standard_error, "--open dry_boundary"));
  std::vector<std::string> accepting = arguments;
  accepting.insert(accepting.end(), {"--open", "dry_boundary"});
  const FinishedProcess accepted = run(accepting);
  ASSERT_EQ(accepted.exit_code, 0) << accepted.standard_error;
  const std::vector<CsvRow> responses = csv_rows(read_file(path("out.csv")));
  ASSERT_EQ(responses.size(), 3U);
  EXPECT_EQ(responses[1][2], "0");
  EXPECT_NEAR(std::stod(responses[1][9]), 0.25, 1e-12);
  EXPECT_EQ(responses[2][2], "6") << "OPEN_EDGE_WET";
}

TEST_F(Replay, PrintsItsVersion) {
  const FinishedProcess finished = run({"--version"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.standard_output, "buoyancy-replay " BUOYANCY_VERSION "\n");
}

}  // namespace
}  // namespace buoyancy
