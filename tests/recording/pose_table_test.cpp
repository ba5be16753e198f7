// Poses of other programs as text: the layouts, their guesses, and what is refused.
#include "recording/pose_table.h"

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "recording/state_csv.h"
#include "tests/support/byte_vector.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;
using testing::StartsWith;

constexpr TableOptions kAnyFormat{.format = TableFormat::kGuess, .time_unit = {}};

struct Poses {
  std::string description;
  std::vector<std::int64_t> utimes;
  std::vector<BodyState> states;
  std::vector<std::string> errors;  // of rows
};

Expected<Poses> read(const std::string& contents, const TableOptions& options) {
  const TempDir directory;
  Expected<StateCsvReader> reader = StateCsvReader::open(directory.write("poses.txt", contents), options);
  if (!reader) return tl::unexpected(reader.error());
  reader->set_body(7);
  Poses poses;
  if (reader->table() != nullptr) poses.description = reader->table()->description();
  while (true) {
    const LogItem item = reader->next();
    if (std::holds_alternative<EndOfLog>(item)) return poses;
    if (const auto* corrupt = std::get_if<CorruptSection>(&item)) {
      poses.errors.push_back(corrupt->description);
      continue;
    }
    const auto request = decoded<WrenchRequest>(std::get<RecordedEvent>(item).bytes);
    EXPECT_EQ(request.id.seq, static_cast<std::int64_t>(poses.utimes.size()));
    poses.utimes.push_back(request.id.utime);
    EXPECT_EQ(request.bodies.size(), 1U) << "each pose is a request";
    poses.states.push_back(request.bodies.at(0));
  }
}

Poses read_poses(const std::string& contents, const TableOptions& options = kAnyFormat) {
  Expected<Poses> poses = read(contents, options);
  if (!poses) throw std::runtime_error(poses.error().message());
  return *std::move(poses);
}

std::string open_error(const std::string& contents, const TableOptions& options = kAnyFormat) {
  const Expected<Poses> poses = read(contents, options);
  return poses ? "" : poses.error().message();
}

// Every case states the pose of position (1, 2, 3) and quaternion (w, x, y, z) = (0.5, 0.5, -0.5, 0.5).
struct Case {
  const char* name;
  std::string contents;
  std::string description;
  std::int64_t utime;
};

std::ostream& operator<<(std::ostream& stream, const Case& tested) {
  return stream << tested.name;
}

class PoseTableFormats : public testing::TestWithParam<Case> {};

TEST_P(PoseTableFormats, AreToldByTheirColumns) {
  const Poses poses = read_poses(GetParam().contents);
  EXPECT_EQ(poses.description, GetParam().description);
  EXPECT_THAT(poses.errors, ElementsAre());
  ASSERT_THAT(poses.utimes, ElementsAre(GetParam().utime));
  const BodyState& state = poses.states[0];
  EXPECT_EQ(state.body_id, 7);
  EXPECT_EQ(state.position, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(state.quaternion_wxyz, (std::array{0.5, 0.5, -0.5, 0.5}));
}

INSTANTIATE_TEST_SUITE_P(
    All, PoseTableFormats,
    testing::Values(
        Case{"Tum", "1.5 1 2 3 0.5 -0.5 0.5 0.5\n", "TUM, time in seconds, without velocities", 1'500'000},
        Case{"TumWithByteOrderMarkCommentsAndCrlf",
             "\xEF\xBB\xBF# ground truth\r\n# timestamp tx ty tz qx qy qz qw\r\n\r\n"
             "1403636580.838555 1\t2  3 0.5 -0.5 0.5 0.5 \r\n# end",
             "TUM, time in seconds, without velocities", 1'403'636'580'838'555},
        Case{"TumAsEvoWritesIt", "1.403636580838555574e+09 1e0 2e0 3e0 5e-1 -5e-1 5e-1 5e-1",
             "TUM, time in seconds, without velocities", 1'403'636'580'838'556},
        Case{"TumWithSemicolons", "2;1;2;3;0.5;-0.5;0.5;0.5\n", "TUM, time in seconds, without velocities",
             2'000'000},
        Case{"TumInNanoseconds", "1403636580838555574 1 2 3 0.5 -0.5 0.5 0.5\n",
             "TUM, time in nanoseconds, without velocities", 1'403'636'580'838'556},
        Case{"TumInMilliseconds", "1403636580838 1 2 3 0.5 -0.5 0.5 0.5\n",
             "TUM, time in milliseconds, without velocities", 1'403'636'580'838'000},
        Case{"TumWhoseHeaderHasAnotherOrder", "# t tx ty tz qw qx qy qz\n1 1 2 3 0.5 0.5 -0.5 0.5\n",
             "TUM, time in seconds, without velocities", 1'000'000},
        Case{"Euroc",
             "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z "
             "[], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1]\n"
             "1403636580838555648,1,2,3,0.5,0.5,-0.5,0.5,4,5,6,0.1\n",
             "EuRoC, time in nanoseconds, without angular velocities", 1'403'636'580'838'556},
        Case{"EurocWithoutHeader", "1403636580838555499,1,2,3,0.5,0.5,-0.5,0.5,4,5,6,0,0,0,0,0,0\n",
             "EuRoC, time in nanoseconds, without angular velocities", 1'403'636'580'838'555},
        Case{"EurocWithRelativeTime",
             "#timestamp [ns],q_RS_w,q_RS_x,q_RS_y,q_RS_z,p_RS_R_x,p_RS_R_y,p_RS_R_z\n"
             "5000000,0.5,0.5,-0.5,0.5,1,2,3\n",
             "EuRoC, time in nanoseconds, without velocities", 5'000},
        Case{"Rostopic",
             "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,"
             "field.pose.position.y,field.pose.position.z,field.pose.orientation.x,field.pose.orientation.y,"
             "field.pose.orientation.z,field.pose.orientation.w\n"
             "9,3,2000001000,map,1,2,3,0.5,-0.5,0.5,0.5\n",
             "nav_msgs, time in nanoseconds, without velocities", 2'000'001},
        Case{"SecondsAndNanoseconds",
             "header.stamp.sec,header.stamp.nanosec,pose.pose.position.x,pose.pose.position.y,"
             "pose.pose.position.z,pose.pose.orientation.x,pose.pose.orientation.y,pose.pose.orientation.z,"
             "pose.pose.orientation.w,twist.twist.linear.x\n1700000000,123456500,1,2,3,0.5,-0.5,0.5,0.5,9\n",
             "nav_msgs, time in seconds and nanoseconds, without velocities", 1'700'000'000'123'457},
        Case{"PlotJuggler",
             "__time,/imu/orientation/x,/odom/header/stamp,/odom/pose/pose/orientation/w,"
             "/odom/pose/pose/orientation/x,/odom/pose/pose/orientation/y,/odom/pose/pose/orientation/z,"
             "/odom/pose/pose/position/x,/odom/pose/pose/position/y,/odom/pose/pose/position/z\n"
             "8,9,1.25,0.5,0.5,-0.5,0.5,1,2,3\n",
             "nav_msgs, time in seconds, without velocities", 1'250'000},
        Case{"TopicNamedPose",
             "__time;/pose/pose/position/x;/pose/pose/position/y;/pose/pose/position/z;/pose/pose/"
             "orientation/w;"
             "/pose/pose/orientation/x;/pose/pose/orientation/y;/pose/pose/orientation/z\n"
             "-0.5;1;2;3;0.5;0.5;-0.5;0.5\n",
             "nav_msgs, time in seconds, without velocities", -500'000}),
    [](const testing::TestParamInfo<Case>& tested) { return tested.param.name; });

const std::string kOdometryHeader =
    "Time,pose.pose.position.x,pose.pose.position.y,pose.pose.position.z,pose.pose.orientation.w,"
    "pose.pose.orientation.x,pose.pose.orientation.y,pose.pose.orientation.z,twist.twist.linear.x,"
    "twist.twist.linear.y,twist.twist.linear.z,twist.twist.angular.x,twist.twist.angular.y,"
    "twist.twist.angular.z\n";

TEST(PoseTable, TurnsTheTwistOfAnOdometryToTheWorld) {
  // A quarter turn about z: x of the body is y of the world.
  const double half = std::sqrt(0.5);
  const std::string q = std::to_string(half);
  const Poses poses = read_poses(kOdometryHeader + "1,0,0,0," + q + ",0,0," + q + ",1,2,3,4,5,6\n");
  EXPECT_EQ(poses.description, "nav_msgs, time in seconds, with velocities");
  ASSERT_EQ(poses.states.size(), 1U);
  EXPECT_THAT(poses.states[0].linear_velocity,
              ElementsAre(testing::DoubleNear(-2.0, 1e-12), testing::DoubleNear(1.0, 1e-12), 3.0));
  EXPECT_THAT(poses.states[0].angular_velocity,
              ElementsAre(testing::DoubleNear(-5.0, 1e-12), testing::DoubleNear(4.0, 1e-12), 6.0));
}

TEST(PoseTable, KeepsTheVelocityOfEurocInTheWorldAndTurnsItsRate) {
  const std::string header =
      "#timestamp [ns],p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z,v_RS_R_x [m "
      "s^-1],v_RS_R_y,v_RS_R_z";
  // Half a turn about x.
  const Poses linear = read_poses(header + "\n1000,0,0,0,0,1,0,0,4,5,6\n");
  EXPECT_EQ(linear.states.at(0).linear_velocity, (std::array{4.0, 5.0, 6.0}));
  EXPECT_THAT(linear.states.at(0).angular_velocity, Each(IsNan())) << "a rate that nobody sent";
  const Poses both = read_poses(header + ",w_RS_S_x,w_RS_S_y,w_RS_S_z\n1000,0,0,0,0,1,0,0,4,5,6,1,2,3\n");
  EXPECT_EQ(both.description, "EuRoC, time in nanoseconds, with velocities");
  EXPECT_EQ(both.states.at(0).linear_velocity, (std::array{4.0, 5.0, 6.0}));
  EXPECT_EQ(both.states.at(0).angular_velocity, (std::array{1.0, -2.0, -3.0}));
}

TEST(PoseTable, ReadsTimesInTheStatedUnit) {
  const struct {
    TimeUnit unit;
    std::int64_t utime;
  } cases[] = {{TimeUnit::kSeconds, 1'500'000'000},
               {TimeUnit::kMilliseconds, 1'500'000},
               {TimeUnit::kMicroseconds, 1'500},
               {TimeUnit::kNanoseconds, 2}};
  for (const auto& [unit, utime] : cases) {
    const Poses poses = read_poses("1500 0 0 0 0 0 0 1\n-1500 0 0 0 0 0 0 1\n", {TableFormat::kTum, unit});
    EXPECT_THAT(poses.utimes, ElementsAre(utime, unit == TimeUnit::kNanoseconds ? -1 : -utime));
  }
}

TEST(PoseTable, ReadsTheSmallestTimeInNanoseconds) {
  const Poses poses =
      read_poses("-9223372036854775808 0 0 0 0 0 0 1\n", {TableFormat::kTum, TimeUnit::kNanoseconds});
  EXPECT_THAT(poses.utimes, ElementsAre(-9'223'372'036'854'776));
}

TEST(PoseTable, KeepsOrderAndRepeatedTimesAsALogDoes) {
  const Poses poses = read_poses("2 0 0 0 0 0 0 1\n2 0 0 1 0 0 0 1\n1 0 0 2 0 0 0 1\n");
  EXPECT_THAT(poses.utimes, ElementsAre(2'000'000, 2'000'000, 1'000'000));
}

TEST(PoseTable, ReportsInvalidRowsByLine) {
  const Poses poses = read_poses(
      "# t tx ty tz qx qy qz qw\n1 0 0 0 0 0 0 1\n2 0 0 x 0 0 0 1\n3 0 0 0 0 0 1\n1e40 0 0 0 0 0 0 1\n"
      "4 0 0 0 0 0 0 1 9\n5 0 0 0 0 0 0 1\n");
  EXPECT_THAT(poses.utimes, ElementsAre(1'000'000, 5'000'000));
  EXPECT_THAT(poses.errors,
              ElementsAre("line 3: 'x' in column 4 is not a number in range; skipped",
                          "line 4: 7 columns where 8 are expected; skipped",
                          "line 5: '1e40' in column 1 is not a time in seconds in range; skipped",
                          "line 6: 9 columns where 8 are expected; skipped"));
}

TEST(PoseTable, RefusesWhatItCannotTell) {
  const std::string nav =
      "header.stamp.sec,header.stamp.nanosec,pose.position.x,pose.position.y,pose.position.z,pose."
      "orientation.x,"
      "pose.orientation.y,pose.orientation.z,pose.orientation.w\n";
  const struct {
    std::string contents;
    TableOptions options;
    const char* error;
  } cases[] = {
      {"hello\n", kAnyFormat, ":1: header 'hello'; expected a TUM trajectory"},
      {"\n1 2 3\n", kAnyFormat, ":2: poses '1 2 3' without a header; expected a TUM trajectory"},
      {"1403636580838555648,1,2,3,0.5,0.5,-0.5,0.5\n", kAnyFormat, "State --format tum or --format euroc"},
      {"#timestamp,p_RS_R_x,p_RS_R_y,q_RS_x\n1,2,3,4\n", kAnyFormat, "expected a column p_RS_R_z"},
      {"utime,fx,fy,fz,tx,ty,tz\n1,2,3,4,5,6,7\n", kAnyFormat, "expected a TUM trajectory"},
      {"tx ty tz qx qy qz qw\n1 2 3 0 0 0 1\n", kAnyFormat,
       "expected a column header.stamp, time or timestamp"},
      {"time,a.position.x,a.orientation.x,b.position.x,b.orientation.x\n1,2,3,4,5\n", kAnyFormat,
       "the poses 'a.' and 'b.'; expected one pose"},
      {nav + "1,2,0,0,0,0,0,0,1\n", {TableFormat::kGuess, TimeUnit::kSeconds}, "columns of their own"},
      {nav + "1,2,0,0,0,0,0,0,1\n",
       {TableFormat::kEuroc, {}},
       "expected columns p_RS_R_x ..., as --format states"},
      {"utime,body_id,px,py,pz,qw,qx,qy,qz\n1,1,0,0,0,1,0,0,0\n",
       {TableFormat::kTum, {}},
       "expected columns tx ..."},
      {"1 0 0 0 0 0 0 1\n", {TableFormat::kNav, {}}, "without a header"},
      {"1 0 0 0 0 0 0 1\n", {TableFormat::kCsv, {}}, "utime,body_id,px"},
      {std::string(5000, 'x') + "\n", kAnyFormat, ":1: more than 4096 characters"},
  };
  for (const auto& [contents, options, error] : cases) {
    EXPECT_THAT(open_error(contents, options), HasSubstr(error)) << contents.substr(0, 60);
  }
}

TEST(PoseTable, AcceptsFilesWithoutPoses) {
  for (const char* contents : {"", "# nothing\n", "#timestamp [ns],p_RS_R_x [m]\n", "\n\n"}) {
    EXPECT_THAT(read_poses(contents).utimes, ElementsAre()) << contents;
  }
}

TEST(PoseTable, HoldsTheSamePosesInPieces) {
  std::string text = "# t tx ty tz qx qy qz qw\n";
  for (int i = 0; i < 40; ++i) {
    text += std::to_string(i / 3) + " 0 0 " + std::to_string(i) + " 0 0 0 1\n";
    if (i % 7 == 0) text += "# comment\n";
    if (i % 11 == 0) text += "broken\n";
  }
  const TempDir directory;
  const std::string path = directory.write("poses.txt", text);
  const auto heights = [&path](std::int64_t from, std::int64_t to) {
    Expected<StateCsvReader> reader = StateCsvReader::open(path, kAnyFormat);
    if (from > 0) reader->seek(from);
    std::vector<double> found;
    while (true) {
      const LogItem item = reader->next(to);
      if (std::holds_alternative<EndOfLog>(item) || std::holds_alternative<LimitReached>(item)) return found;
      if (const auto* event = std::get_if<RecordedEvent>(&item)) {
        found.push_back(decoded<WrenchRequest>(event->bytes).bodies.at(0).position[2]);
      }
    }
  };
  const std::vector<double> whole = heights(0, kNoLimit);
  ASSERT_EQ(whole.size(), 40U);
  for (std::int64_t cut = 1; cut < static_cast<std::int64_t>(text.size()); ++cut) {
    std::vector<double> pieces = heights(0, cut);
    const std::vector<double> rest = heights(cut, kNoLimit);
    pieces.insert(pieces.end(), rest.begin(), rest.end());
    ASSERT_EQ(pieces, whole) << "cut at " << cut;
  }
}

}  // namespace
}  // namespace buoyancy
