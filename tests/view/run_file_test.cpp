#include "view/report/run_file.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "engine/request_handler.h"
#include "messages/sea_state.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/grid_bytes.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/service/one_box_scene.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/recorded_log.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"
#include "view/report/body_list.h"
#include "view/report/report_page.h"
#include "view/report/run_builder.h"

namespace buoyancy::view {
namespace {

WrenchRequest request_at(std::int64_t seq, double height, std::int64_t session_id = 1) {
  WrenchRequest request;
  request.id = {.utime = 1'000 * seq, .session_id = session_id, .seq = seq};
  request.bodies.resize(1);
  request.bodies[0] = {.body_id = 1, .position = {0.0, 0.0, height}, .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0}};
  return request;
}

class RunFileTest : public testing::Test {
 protected:
  Expected<RecordedRun> read(const std::string& path) const {
    return read_run(path, scene_, 1'000, options_);
  }
  Expected<RecordedRun> read_csv(const std::string& text) const {
    return read(directory_.write("run.csv", text));
  }

  void log_request(std::int64_t timestamp, const WrenchRequest& request) {
    log_.add(timestamp, kStatesChannel, encoded(request));
  }
  void log_response(std::int64_t timestamp, const WrenchRequest& request) {
    log_.add(timestamp, kWrenchesChannel, handler_.handle(encoded(request)));
  }
  Expected<RecordedRun> read_log() const { return read(directory_.write("run.lcmlog", log_.text())); }

  // A pose of the body on channel POSE of options_.
  void log_pose(std::int64_t timestamp, const bot_core::pose_t& pose) {
    log_.add(timestamp, "POSE", encoded_by_lcm(pose));
  }

  TempDir directory_;
  RunFileOptions options_;
  Scene scene_ = scene_of(kOneBoxScene);
  RequestHandler handler_{scene_};
  RecordedLog log_;
};

TEST_F(RunFileTest, ComputesForcesOfPoses) {
  const RecordedRun run = read_csv(
                              "utime,body_id,px,py,pz,qw,qx,qy,qz\n"
                              "5000000,1,0,0,0,1,0,0,0\n"
                              "5001000,1,0,0,1,1,0,0,0\n")
                              .value();
  ASSERT_EQ(run.bodies[0].rows.size(), 2);
  EXPECT_EQ(run.computed, 2);
  const RunRow& half_submerged = run.bodies[0].rows[0];
  EXPECT_EQ(half_submerged[kTime], 0.0);
  EXPECT_NEAR(half_submerged[kFz], 12.0 * kDensity * kGravity, 1e-6);
  EXPECT_TRUE(std::isnan(half_submerged[kEnergy])) << "the box has no mass";
  const RunRow& higher = run.bodies[0].rows[1];
  EXPECT_DOUBLE_EQ(higher[kTime], 1e-3);
  EXPECT_EQ(higher[kHeave], 1.0);
  EXPECT_NEAR(higher[kForce], 6.0 * kDensity * kGravity, 1e-6);
}

TEST_F(RunFileTest, KeepsRecordedValues) {
  const RecordedRun run =
      read_csv(
          "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,status,fx,fy,fz,tx,ty,tz,volume,"
          "bx,by,bz,energy\n"
          "0,1,0,0,0,1,0,0,0,0,0,0,0,0,0,0,1,2,3,4,5,6,7,8,9,10,11.25\n")
          .value();
  const RunRow& row = run.bodies[0].rows.at(0);
  EXPECT_EQ(run.computed, 0);
  EXPECT_EQ(std::vector(row.begin() + kFx, row.begin() + kRoundTrip),
            (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11.25}));
}

TEST_F(RunFileTest, SkipsInvalidRowsWithWarning) {
  const RecordedRun run = read_csv(
                              "utime,body_id,px,py,pz,qw,qx,qy,qz\n"
                              "0,1,0,0,0,1,0,0,0\n"
                              "1000,1,0,0,zero,1,0,0,0\n"
                              "2000,1,0,0\n"
                              "3000,1,0,0,0,1,0,0,0\n")
                              .value();
  EXPECT_EQ(run.bodies[0].recorded, 2);
  EXPECT_EQ(run.warnings, (std::vector<std::string>{"line 3 skipped: expected 9 numbers",
                                                    "line 4 skipped: expected 9 numbers"}));
}

TEST_F(RunFileTest, SkipsNumbersOutOfRangeAndLongLines) {
  const auto row = [](const std::string& key, const std::string& status) {
    return key + ",0,0,0,1,0,0,0," + status + ",1,2,3,4,5,6,7,8,9,10\n";
  };
  const RecordedRun run =
      read_csv("utime,body_id,px,py,pz,qw,qx,qy,qz,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz\n" +
               row("0,1", "0") + row("1000,4294967297", "0") + row("2000,1", "1e300") + row("3000,1", "nan") +
               row("4000," + std::string(100'000, '0') + "1", "0") + row("5000,1", "0"))
          .value();
  EXPECT_EQ(run.bodies[0].recorded, 2) << "4294967297 is 1 in 32 bits";
  EXPECT_EQ(run.unknown_bodies, 0);
  EXPECT_EQ(run.warnings.size(), 4U);
}

TEST_F(RunFileTest, ReadsPipe) {
  const std::string path = directory_.path("pipe.csv");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::thread writer(
      [&path] { std::ofstream(path) << "utime,body_id,px,py,pz,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n"; });
  const Expected<RecordedRun> run = read(path);
  writer.join();
  ASSERT_TRUE(run) << run.error().message();
  EXPECT_EQ(run->bodies[0].recorded, 1);
}

TEST_F(RunFileTest, RejectsFilesWithoutPoses) {
  const auto responses_only = read_csv("utime,body_id,status,fx,fy,fz\n0,1,0,0,0,0\n");
  ASSERT_FALSE(responses_only);
  EXPECT_TRUE(contains(responses_only.error().message(), "px, py, pz"));
  const auto other_scene = read_csv("utime,body_id,px,py,pz,qw,qx,qy,qz\n0,77,0,0,0,1,0,0,0\n");
  ASSERT_FALSE(other_scene);
  EXPECT_TRUE(contains(other_scene.error().message(), "1 rows, none about a body of test scene"));
  EXPECT_FALSE(read(directory_.write("run.txt", ""))) << "neither .csv nor .lcmlog";
  EXPECT_FALSE(read(directory_.path("missing.csv")));
  EXPECT_FALSE(read(directory_.path("missing.lcmlog")));
}

TEST_F(RunFileTest, ReadsResponsesAndRoundTripsFromLog) {
  for (std::int64_t seq = 0; seq < 10; ++seq) {
    const WrenchRequest request = request_at(seq, 0.1 * static_cast<double>(seq));
    log_request(1'000'000 + 1'000 * seq, request);
    log_response(1'000'000 + 1'000 * seq + 250, request);
  }
  const RecordedRun run = read_log().value();
  ASSERT_EQ(run.bodies[0].rows.size(), 10);
  EXPECT_EQ(run.computed, 0);
  for (const RunRow& row : run.bodies[0].rows) EXPECT_NEAR(row[kRoundTrip], 250e-6, 1e-12);
  EXPECT_NEAR(run.bodies[0].rows[5][kFz], 6.0 * 1.5 * kDensity * kGravity, 1e-6);
}

TEST_F(RunFileTest, CountsRetriesOnceAndComputesMissingResponses) {
  const WrenchRequest lost = request_at(0, 0.5);
  const WrenchRequest repeated = request_at(1, 0.0);
  log_request(0, lost);
  log_request(1'000, repeated);
  log_request(2'000, repeated);
  log_response(2'100, repeated);
  log_response(2'200, repeated);
  log_request(2'300, repeated);
  const RecordedRun run = read_log().value();
  ASSERT_EQ(run.bodies[0].rows.size(), 2);
  EXPECT_EQ(run.computed, 1);
  EXPECT_EQ(run.bodies[0].rows[0][kHeave], 0.5) << "in order of time, although it was added last";
  EXPECT_NEAR(run.bodies[0].rows[0][kFz], 9.0 * kDensity * kGravity, 1e-6);
  EXPECT_TRUE(std::isnan(run.bodies[0].rows[0][kRoundTrip]));
  EXPECT_NEAR(run.bodies[0].rows[1][kRoundTrip], 1.1e-3, 1e-12) << "from the first request";
}

// A log may hold 4,096 requests before the response to the first of them.
TEST_F(RunFileTest, MatchesResponsesOfUpTo4096RequestsBefore) {
  for (const std::int64_t later : {4'095, 4'096}) {
    log_ = {};
    for (std::int64_t seq = 0; seq <= later; ++seq) log_request(1'000 * seq, request_at(seq, 0.0));
    log_response(1'000 * later + 500, request_at(0, 0.0));
    const RecordedRun run = read_log().value();
    EXPECT_EQ(run.computed, later == 4'095 ? later : later + 1) << later;
  }
}

// A body that falls at 1 m/s and states millimetres per second; two requests are missing.
TEST_F(RunFileTest, NotesWhatTheLogLacksAndContradicts) {
  for (std::int64_t seq = 0; seq < 20; ++seq) {
    if (seq == 7 || seq == 8) continue;
    WrenchRequest request = request_at(seq, -1e-3 * static_cast<double>(seq));
    request.bodies[0].linear_velocity = {0.0, 0.0, -1000.0};
    log_request(1'000 * seq, request);
    log_response(1'000 * seq + 500, request);
  }
  const RecordedRun run = read_log().value();
  ASSERT_EQ(run.notices.size(), 2U);
  EXPECT_EQ(run.notices[0], "session 1: 2 requests missing, seq 7 to 8");
  EXPECT_EQ(run.notices[1].rfind(
                "session 1, body 1: linear_velocity = 0, 0, -1e+03 m/s where the body moves by", 0),
            0U)
      << run.notices[1];
}

class RunFileInWavesTest : public RunFileTest {
 protected:
  static std::string box_in(const std::string& waves) {
    return "[water]\nwaves = " + waves +
           "\n[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 3, 4], segments = [2, 2, 2] }\n";
  }
  static inline const std::string kSwell = "{ type = \"regular\", height = 0.6, period = 4.0 }";

  // The forces that a request handler gives in the swell.
  double force_at(const WrenchRequest& request) {
    return decoded<WrenchResponse>(in_swell_.handle(encoded(request))).bodies.at(0).force[0];
  }

  Scene swell_ = scene_of(box_in(kSwell));
  RequestHandler in_swell_{swell_};
};

TEST_F(RunFileInWavesTest, ComputesMissingWrenchesAtTheirTime) {
  scene_ = scene_of(box_in(kSwell));
  for (std::int64_t i = 1; i <= 3; ++i) log_request(i, request_at(500 * i, 0.1));
  const RecordedRun run = read_log().value();
  ASSERT_EQ(run.bodies[0].rows.size(), 3U);
  for (std::int64_t i = 1; i <= 3; ++i) {
    const double expected = force_at(request_at(500 * i, 0.1));
    EXPECT_DOUBLE_EQ(run.bodies[0].rows[static_cast<std::size_t>(i - 1)][kFx], expected) << i;
  }
  EXPECT_NE(run.bodies[0].rows[0][kFx], run.bodies[0].rows[1][kFx]);
}

TEST_F(RunFileInWavesTest, ReceivesTheSeaOfTheLog) {
  scene_ = scene_of(box_in("\"received\""));
  SeaState sea = to_sea_state(*swell_.sea(), 1);
  sea.utime = 900'000;
  ByteVector bytes = encoded(sea);
  log_.add(1, kSeaChannel, bytes);
  bytes.pop_back();
  log_.add(2, kSeaChannel, bytes);
  log_request(3, request_at(500, 0.1));
  log_request(4, request_at(1'000, 0.1));
  const RecordedRun run = read_log().value();
  ASSERT_EQ(run.bodies[0].rows.size(), 2U);
  EXPECT_EQ(run.bodies[0].rows[0][kStatus], static_cast<double>(BodyStatus::kNoSea));
  EXPECT_NEAR(run.bodies[0].rows[1][kFx], force_at(request_at(1'000, 0.1)), 1e-3);
  ASSERT_EQ(run.warnings.size(), 1U);
  EXPECT_EQ(run.warnings[0].rfind("event at 2 us skipped: a message of the sea", 0), 0U) << run.warnings[0];
}

// Of states in order of arrival: late ones keep their place, a clock that restarts goes on after the last
// time by the last step, again and again, and a session returns to its own clock.
// Of more surfaces than a page holds, one is kept at even distances in time.
TEST(RunBuilder, DrawsLargeSurfacesLessOften) {
  const Scene scene = scene_of("[water]\nwaves = \"grid\"\n[[body]]\nid = 1\nshape = { type = \"box\" }\n");
  RunBuilder builder(scene, 1'000);
  SeaGridHeader header = kGridAroundOrigin;
  header.rows = header.columns = 600;  // 1.9 MB in a page
  constexpr int kRows = 40;
  for (int i = 0; i < kRows; ++i) {
    header.utime = 1'000'000 * i;
    builder.receive_sea(0, grid_bytes(header, [](double, double) { return 0.25; }));
    RecordedState state;
    state.time = state.utime = header.utime;
    state.state = request_at(0, 0.0).bodies[0];
    builder.add(state);
    builder.add(state);  // another body at the same time
  }
  const RecordedRun run = builder.finish();
  ASSERT_GE(run.surfaces.size(), 6U);
  ASSERT_LE(run.surfaces.size(), 13U);
  EXPECT_EQ(run.surfaces[0].time, 0.0);
  for (std::size_t i = 1; i < run.surfaces.size(); ++i)
    EXPECT_EQ(run.surfaces[i].time - run.surfaces[i - 1].time, 4.0);
}

TEST(RunBuilder, MapsClocksToOneAxis) {
  struct State {
    std::int32_t body;
    std::int64_t session, utime, time;  // [us]
  };
  constexpr std::int64_t kSecond = 1'000'000;
  constexpr std::int64_t kDay = 86'400 * kSecond;
  const std::vector<std::vector<State>> runs{
      {{1, 1, 5 * kSecond, 0},
       {1, 1, 7 * kSecond, 2 * kSecond},
       {1, 1, 6'200'000, 1'200'000},    // late
       {1, 1, 5'900'000, 4 * kSecond},  // more than a second behind the latest: a restart
       {1, 1, 5'950'000, 4'050'000},
       {1, 1, 1 * kSecond, 4'100'000},  // another one
       {1, 1, 1'200'000, 4'300'000}},
      {{1, 1, 0, 0}, {1, 1, 3 * kSecond, 3 * kSecond}, {1, 1, 2 * kSecond, 2 * kSecond}},
      {{1, 1, 0, 0}, {1, 1, 3 * kSecond, 3 * kSecond}, {1, 1, 2 * kSecond - 1, 6 * kSecond}},
      {{1, 1, 9, 0}, {1, 1, kDay + 9, kDay}, {1, 1, 2 * kDay + 9, 2 * kDay}},
      {{1, 1, 9, 0}, {1, 1, kDay + 10, 0}},  // another clock
      {{1, 1, 0, 0},
       {1, 1, 1'000, 1'000},
       {1, 2, 2'000, 2'000},  // of the same clock
       {1, 3, 0, 3'000},      // of its own
       {1, 3, 10, 3'010},
       {1, 1, 2'500, 2'500},
       {1, 4, 10, 3'020},  // at the last time of the clock before
       {1, 3, 40, 3'040}},
      {{1, 1, kSecond, 0},
       {1, 1, 3 * kSecond, 2 * kSecond},
       {2, 1, 2'500'000, 1'500'000},  // of another body, by the same clock
       {2, 1, 4 * kSecond, 3 * kSecond},
       {1, 1, 4 * kSecond, 3 * kSecond}},
      {{1, 1, kSecond, 0}, {1, 1, 3 * kSecond, 2 * kSecond}, {2, 1, 9 * kDay, 2 * kSecond}}};
  const Scene scene = scene_of(kOneBoxScene + "[[body]]\nid = 2\nshape = { type = \"box\" }\n");
  for (std::size_t run = 0; run < runs.size(); ++run) {
    RunBuilder builder(scene, 1'000);
    for (std::size_t i = 0; i < runs[run].size(); ++i) {
      const auto& [body, session, utime, time] = runs[run][i];
      EXPECT_EQ(builder.time_of(body, session, utime), time) << "run " << run << ", state " << i;
    }
  }
}

TEST_F(RunFileTest, AppendsSessionWithRestartedClock) {
  for (const std::int64_t session : {1, 2}) {
    for (std::int64_t seq = 0; seq < 3; ++seq) {
      const WrenchRequest request = request_at(seq, 0.0, session);
      log_request(1'000 * seq, request);
      log_response(1'000 * seq + 100, request);
    }
  }
  const RecordedRun run = read_log().value();
  EXPECT_EQ(run.sessions, 2);
  ASSERT_EQ(run.bodies[0].rows.size(), 6);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(run.bodies[0].rows[i][kTime], 1e-3 * static_cast<double>(i), 1e-9);
  }
}

TEST_F(RunFileTest, KeepsTimeOrderWithMissingResponses) {
  // No responses to the first session, responses to every other request of the second.
  for (std::int64_t seq = 0; seq < 100; ++seq) log_request(1'000 * seq, request_at(seq, 1.0, 11));
  for (std::int64_t seq = 0; seq < 100; ++seq) {
    const WrenchRequest request = request_at(seq, -1.0, 22);
    log_request(200'000 + 1'000 * seq, request);
    if (seq % 2 == 0) log_response(200'000 + 1'000 * seq + 100, request);
  }
  const RecordedRun run = read_log().value();
  const std::vector<RunRow>& rows = run.bodies[0].rows;
  ASSERT_EQ(rows.size(), 200U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_NEAR(rows[i][kTime], 1e-3 * static_cast<double>(i), 1e-9);
    ASSERT_EQ(rows[i][kHeave], i < 100 ? 1.0 : -1.0);
  }
}

TEST_F(RunFileTest, KeepsDurationOfParallelAndReusedSessions) {
  for (std::int64_t i = 0; i < 100; ++i) {
    WrenchRequest one = request_at(i, 0.0, 1);
    WrenchRequest other = request_at(i, 0.0, 2);
    one.id.utime += 7;
    log_request(1'000 * i, other);
    log_request(1'000 * i + 7, one);
  }
  EXPECT_NEAR(read_log().value().bodies[0].rows.back()[kTime], 0.099, 1e-4);
  log_ = {};
  for (const std::int64_t start : {0, 5'000'000}) {
    for (std::int64_t seq = 0; seq < 3'000; ++seq) {
      log_request(start + 1'000 * seq, request_at(seq, 0.0));
      log_response(start + 1'000 * seq, request_at(seq, 0.0));
    }
  }
  const RecordedRun run = read_log().value();
  EXPECT_NEAR(run.bodies[0].rows.back()[kTime], 5.999, 1e-6);
}

TEST_F(RunFileTest, KeepsDurationWithUnrelatedClocks) {
  scene_ = box_scene();
  constexpr std::int64_t kLongAgo = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kUnixTime = 1'700'000'000'000'000;
  for (std::int64_t i = 0; i < 100; ++i) {
    for (const auto& [body, clock] :
         {std::pair(kBox, kLongAgo), {kFastBox, std::int64_t{0}}, {kOffsetBox, kUnixTime}}) {
      WrenchRequest request = request_at(i, 0.0, body);
      request.id.utime += clock;
      request.bodies[0].body_id = body;
      log_request(1'000 * i, request);
    }
  }
  const RecordedRun run = read_log().value();
  for (const BodyRun& body : run.bodies) {
    if (body.recorded == 0) continue;
    EXPECT_EQ(body.recorded, 100);
    EXPECT_NEAR(body.rows.front()[kTime], 0.0, 1e-9);
    EXPECT_NEAR(body.rows.back()[kTime], 0.099, 1e-9);
  }
}

TEST_F(RunFileTest, AcceptsByteOrderMarkAndCrLf) {
  const RecordedRun run = read_csv(
                              "\xef\xbb\xbfutime,body_id,px,py,pz,qw,qx,qy,qz\r\n"
                              "0,1,0,0,0,1,0,0,0\r\n"
                              "\r\n"
                              "1000,1,0,0,1,1,0,0,0\r\n")
                              .value();
  EXPECT_EQ(run.bodies[0].recorded, 2);
  EXPECT_TRUE(run.warnings.empty());
}

TEST_F(RunFileTest, CountsEvaluationsByKind) {
  const RecordedRun run = read_csv(
                              "utime,body_id,px,py,pz,qw,qx,qy,qz\n"
                              "0,1,0,0,0,1,0,0,0\n"      // partially submerged
                              "1000,1,0,0,0,1,0,0,0\n"   // unchanged
                              "2000,1,0,0,50,1,0,0,0\n"  // dry
                              "3000,1,0,0,0,0,0,0,0\n"   // zero quaternion
                              "4000,1,0,0,-50,1,0,0,0\n")
                              .value();
  const EvaluationCounts& evaluations = run.bodies[0].evaluations;
  EXPECT_EQ(evaluations.unchanged, 1);
  EXPECT_EQ(evaluations.dry, 1);
  EXPECT_EQ(evaluations.rejected, 1);
  EXPECT_EQ(evaluations.wet, 0) << "method exact computes fully submerged poses";
  EXPECT_EQ(evaluations.crossing, 2);
}

TEST_F(RunFileTest, ComputesEnergyOfLogIfMassIsKnown) {
  scene_ = scene_of(kOneBoxScene + "[body.client]\ndensity = 500.0\n");
  WrenchRequest falling = request_at(0, 10.0);
  falling.bodies[0].linear_velocity = {0.0, 0.0, -2.0};
  log_request(0, falling);
  const double mass = 24.0 * 500.0;
  EXPECT_NEAR(read_log().value().bodies[0].rows.at(0)[kEnergy], mass * (0.5 * 4.0 + kGravity * 10.0), 1e-6);
}

TEST_F(RunFileTest, MatchesPoseResponsesByBodyAndTime) {
  options_.poses = {.channels = {{"POSE", 1, ""}}};
  PoseRequestAdapter adapter(options_.poses, 70);
  for (std::int64_t i = 0; i < 10; ++i) {
    const bot_core::pose_t pose = upright_pose(0.1 * static_cast<double>(i), 5'000'000 + 1'000 * i);
    log_pose(1'000 * i, pose);
    const std::vector<std::uint8_t> request = [&] {
      const auto bytes = adapter.make_request(0, encoded_by_lcm(pose));
      return std::vector<std::uint8_t>(bytes->begin(), bytes->end());
    }();
    log_.add(1'000 * i + 250, kWrenchesChannel, handler_.handle(request));
  }
  const RecordedRun run = read_log().value();
  ASSERT_EQ(run.bodies[0].rows.size(), 10);
  EXPECT_EQ(run.computed, 0);
  EXPECT_EQ(run.sessions, 1);
  EXPECT_TRUE(run.warnings.empty());
  for (const RunRow& row : run.bodies[0].rows) EXPECT_NEAR(row[kRoundTrip], 250e-6, 1e-12);
  EXPECT_DOUBLE_EQ(run.bodies[0].rows[5][kTime], 5e-3);
  EXPECT_NEAR(run.bodies[0].rows[5][kFz], 6.0 * 1.5 * kDensity * kGravity, 1e-6);
}

TEST_F(RunFileTest, ComputesMissingPartsOfPoseResponses) {
  options_.poses = {.channels = {{"POSE", 1, "FORCE"}}};
  log_pose(0, upright_pose(0.5, 0));
  log_pose(1'000, upright_pose(0.0, 1'000));
  std::vector<std::uint8_t> bytes;
  encode_six_axis_force_torque(1'000, {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, bytes);
  log_.add(1'400, "FORCE", bytes);
  log_.add(1'500, "POSE", bytes);
  const RecordedRun run = read_log().value();
  ASSERT_EQ(run.bodies[0].rows.size(), 2);
  EXPECT_EQ(run.computed, 1);
  EXPECT_NEAR(run.bodies[0].rows[0][kFz], 9.0 * kDensity * kGravity, 1e-6);
  const RunRow& recorded = run.bodies[0].rows[1];
  EXPECT_EQ(std::vector(recorded.begin() + kFx, recorded.begin() + kVolume),
            (std::vector<double>{1, 2, 3, 4, 5, 6}))
      << "as recorded";
  EXPECT_NEAR(recorded[kVolume], 12.0, 1e-9) << "of the scene's box";
  EXPECT_NEAR(recorded[kRoundTrip], 400e-6, 1e-12);
  EXPECT_EQ(run.warnings, (std::vector<std::string>{"pose skipped: fingerprint of another type or version"}));
}

TEST_F(RunFileTest, ComputesPoseEnergyOnlyWithVelocityFrame) {
  scene_ = scene_of(kOneBoxScene + "[body.client]\ndensity = 500.0\n");
  bot_core::pose_t falling = upright_pose(10.0, 0);
  falling.vel[2] = -2.0;
  log_pose(0, falling);
  options_.poses = {.channels = {{"POSE", 1, ""}}};
  EXPECT_TRUE(std::isnan(read_log().value().bodies[0].rows.at(0)[kEnergy]));
  options_.poses.velocity_frame = VelocityFrame::kBody;
  const double mass = 24.0 * 500.0;
  EXPECT_NEAR(read_log().value().bodies[0].rows.at(0)[kEnergy], mass * (0.5 * 4.0 + kGravity * 10.0), 1e-6);
}

TEST_F(RunFileTest, AppendsPosesWithRestartedClock) {
  options_.poses = {.channels = {{"POSE", 1, ""}}};
  for (const std::int64_t utime : {5'000'000, 5'001'000, 5'000'500, 0, 1'000}) {
    log_pose(utime, upright_pose(0.0, utime));
  }
  const RecordedRun run = read_log().value();
  std::vector<double> times;
  for (const RunRow& row : run.bodies[0].rows) times.push_back(row[kTime]);
  ASSERT_EQ(times.size(), 5U);
  EXPECT_NEAR(times[1], 0.5e-3, 1e-9) << "a late pose is sorted by time";
  EXPECT_GE(times[3], times[2]);
  EXPECT_NEAR(times[4] - times[3], 1e-3, 1e-9);
}

TEST_F(RunFileTest, RejectsPoseChannelsForCsv) {
  options_.poses = {.channels = {{"POSE", 1, ""}}};
  const auto rejected = read_csv("utime,body_id,px,py,pz,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n");
  ASSERT_FALSE(rejected);
  EXPECT_TRUE(contains(rejected.error().message(), "CSV has no channels"));
}

// Two more bodies than a page shows, with the ids 1 to 1,002.
class RunFileManyBodies : public testing::Test {
 protected:
  static constexpr int kBodies = 1'002;

  static std::string many_bodies() {
    std::string text = kTestWater;
    for (int id = 1; id <= kBodies; ++id) {
      text += "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = [2, 3, 4] }\n";
    }
    return text;
  }
  // One row per body, the last body first.
  static std::string rows(const std::string& header, const std::string& row) {
    std::string text = header;
    for (int id = kBodies; id > 0; --id) text += "0," + std::to_string(id) + row;
    return text;
  }
  static std::string poses() { return rows("utime,body_id,px,py,pz,qw,qx,qy,qz\n", ",0,0,0,1,0,0,0\n"); }

  Expected<RecordedRun> read(const std::string& text) const {
    return read_run(directory_.write("run.csv", text), scene_, 1'000, options_);
  }

  TempDir directory_;
  RunFileOptions options_;
  Scene scene_ = scene_of(many_bodies());
};

TEST_F(RunFileManyBodies, ShowsFirstBodiesAndCountsOthers) {
  const RecordedRun run = read(poses()).value();
  EXPECT_EQ(run.computed, 1'000) << "nothing is computed for a body that is not shown";
  for (std::size_t i = 0; i < kBodies; ++i) {
    ASSERT_EQ(run.bodies[i].recorded, 1) << i;
    ASSERT_EQ(run.bodies[i].shown, i > 1) << i;
    ASSERT_EQ(run.bodies[i].rows.size(), i > 1 ? 1U : 0U) << i;
  }
  EXPECT_EQ(run.bodies[2].statuses[0], 1);
  EXPECT_NEAR(run.bodies[2].max_force, 12.0 * kDensity * kGravity, 1e-6);
  EXPECT_EQ(run.bodies[1].statuses[0], 0) << "unknown status";
  EXPECT_TRUE(std::isnan(run.bodies[1].max_force));
}

TEST_F(RunFileManyBodies, SummarizesEveryBody) {
  const std::string header = "utime,body_id,px,py,pz,qw,qx,qy,qz,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz\n";
  const RecordedRun run = read(rows(header, ",0,0,0,1,0,0,0,0,3,0,4,0,0,0,1,0,0,0\n") +
                               "1000,1,0,0,0,1,0,0,0,0,0,0,2,0,0,0,1,0,0,0\n"
                               "2000,1,0,0,0,1,0,0,0,6,0,0,9,0,0,0,1,0,0,0\n"
                               "3000,1,0,0,0,1,0,0,0,-7,0,0,0,0,0,0,1,0,0,0\n"
                               "4000,1,0,0,0,1,0,0,0,0,0,0,nan,0,0,0,1,0,0,0\n")
                              .value();
  const BodyRun& body = run.bodies[0];
  EXPECT_FALSE(body.shown);
  EXPECT_EQ(body.recorded, 5);
  EXPECT_EQ(body.statuses, (decltype(body.statuses){3, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(body.max_force, 5.0) << "of the rows that are OK";
  EXPECT_EQ(run.bodies.back().max_force, 5.0);
}

TEST_F(RunFileManyBodies, ShowsSelectedBodies) {
  options_.bodies = body_list("1-2,900", scene_).value();
  EXPECT_EQ(options_.bodies, (std::vector<std::size_t>{0, 1, 899}));
  const RecordedRun run = read(poses()).value();
  for (std::size_t i = 0; i < kBodies; ++i) {
    ASSERT_EQ(run.bodies[i].shown, i < 2 || i == 899) << i;
    ASSERT_EQ(run.bodies[i].recorded, 1) << i;
  }
  EXPECT_EQ(run.computed, 3);
}

TEST_F(RunFileManyBodies, RejectsRunWithoutSelectedBodies) {
  options_.bodies = body_list("1-10", scene_).value();
  const auto rejected = read("utime,body_id,px,py,pz,qw,qx,qy,qz\n0,77,0,0,0,1,0,0,0\n0,88,0,0,0,1,0,0,0\n");
  ASSERT_FALSE(rejected);
  EXPECT_TRUE(contains(rejected.error().message(),
                       "The run has rows about 2 bodies of the scene, the first with id 77"));
}

TEST_F(RunFileManyBodies, WritesAllBodiesToPageData) {
  const RecordedRun run = read(poses()).value();
  const auto data = parse_json(report_data(scene_, run, {.file = "run.csv", .version = "1"}));
  ASSERT_EQ(data["bodies"].size(), 1'002U);
  const nlohmann::json& other = data["bodies"][1];
  EXPECT_EQ(other["id"], 2);
  EXPECT_EQ(other["shown"], false);
  EXPECT_EQ(other["recorded"], 1);
  EXPECT_EQ(other["max_force"], nullptr);
  EXPECT_FALSE(other.contains("data"));
  EXPECT_EQ(data["bodies"][2]["shown"], true);
  EXPECT_EQ(data["selected"], false);
}

TEST_F(RunFileManyBodies, ParsesListsOfIdsAndRanges) {
  EXPECT_EQ(body_list("900,3,3-5,1002-2000", scene_).value(),
            (std::vector<std::size_t>{2, 3, 4, 899, 1'001}));
  EXPECT_EQ(body_list("-5-1", scene_).value(), std::vector<std::size_t>{0});
  for (const auto& [list, message] : std::vector<std::pair<std::string, std::string>>{
           {"1, 2", "--bodies 1, 2: ' 2'; expected ids and ranges of ids, such as 1-50,900."},
           {"", "''; expected ids"},
           {"1,", "''; expected ids"},
           {"5-1", "'5-1'; expected ids"},
           {"1-", "'1-'; expected ids"},
           {"1:5", "'1:5'; expected ids"},
           {"99999999999", "'99999999999'; expected ids"},
           {"1,2000", "no body has the id 2000; expected ids of test scene"},
           {"1-1002", "1002 bodies; expected at most 1000"}}) {
    const auto rejected = body_list(list, scene_);
    ASSERT_FALSE(rejected) << list;
    EXPECT_TRUE(contains(rejected.error().message(), message));
  }
}

}  // namespace
}  // namespace buoyancy::view
