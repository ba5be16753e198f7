// The loads of a recorded run: those of the file, and those that the report computes.
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "messages/conversions.h"
#include "messages/sea_state.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/recorded_log.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"
#include "tests/view/moving_bodies.h"
#include "view/report/report_page.h"
#include "view/report/run_file.h"

namespace buoyancy::view {
namespace {

constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026
constexpr int kSteps = 40;

// The run of the bodies of a scene, as the service handles it.
class RunLoadsTest : public testing::Test {
 protected:
  explicit RunLoadsTest(const std::string& scene = moving_bodies())
      : scene_(scene_of(scene)), handler_(scene_) {}

  // Handles random motions of all bodies, and appends requests, responses and loads to the log.
  void handle(bool with_response = true, bool with_loads = true) {
    const auto utime = kNow + 10'000 * static_cast<std::int64_t>(requests_.size());
    WrenchRequest request{
        .id = {.utime = utime, .session_id = 1, .seq = utime}, .lead_time = 0.0, .bodies = {}};
    for (const Body& body : scene_.bodies()) request.bodies.push_back(random_motion(body.id, random_));
    handle(request, with_response, with_loads);
  }
  void handle(const WrenchRequest& request, bool with_response, bool with_loads) {
    const ByteVector bytes = encoded(request);
    log(kStatesChannel, bytes);
    requests_.push_back(request);
    const Bytes response = handler_.handle(bytes);
    responses_.push_back(decoded<WrenchResponse>(response));
    loads_.push_back(decoded<BodiesLoads>(handler_.last_loads()));
    if (with_response) log(kWrenchesChannel, response);
    if (with_loads) log(kLoadsChannel, handler_.last_loads());
  }
  void log(std::string_view channel, Bytes bytes) { log_.add(kNow + log_.events(), channel, bytes); }

  // The requests as a CSV file without responses.
  std::string csv(bool with_velocities = true) const {
    std::string text = "utime,body_id,px,py,pz,qw,qx,qy,qz";
    text += with_velocities ? ",vx,vy,vz,wx,wy,wz\n" : "\n";
    const auto append = [&text](const auto& values) {
      for (const double value : values) {
        std::array<char, 40> digits{};
        std::snprintf(digits.data(), digits.size(), ",%.17g", value);
        text += digits.data();
      }
    };
    for (const WrenchRequest& request : requests_) {
      for (const BodyState& state : request.bodies) {
        text += std::to_string(request.id.utime) + ',' + std::to_string(state.body_id);
        append(state.position);
        append(state.quaternion_wxyz);
        if (with_velocities) {
          append(state.linear_velocity);
          append(state.angular_velocity);
        }
        text += '\n';
      }
    }
    return text;
  }
  RecordedRun read_csv(const std::string& text) const { return read("run.csv", text); }
  RecordedRun read_log() const { return read("run.lcmlog", log_.text()); }
  RecordedRun read(const std::string& name, const std::string& contents) const {
    return read_run(directory_.write(name, contents), scene_, 10'000, {}).value();
  }

  // Bodies 1 and 3 publish their loads; they are the first and the second body of each message.
  void expect_service_loads(const RecordedRun& run) const {
    for (const std::size_t body : {std::size_t{0}, std::size_t{2}}) {
      ASSERT_EQ(run.bodies[body].loads.size(), loads_.size());
      for (std::size_t i = 0; i < loads_.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "body " << body << ", row " << i);
        expect_equal(run.bodies[body].loads[i], loads_[i].bodies[body / 2]);
      }
    }
  }
  static void expect_equal(const LoadRow& row, const BodyLoads& loads) {
    EXPECT_NEAR(row[kImmersion], loads.immersion, 1e-12);
    const auto expect_near = [&row](std::size_t first, const std::array<double, 3>& values, double allowed) {
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(row[first + i], values[i], allowed) << first + i;
    };
    constexpr double kRounding = 1e-8;  // [N, N m], beside up to 2e4
    expect_near(kBuoyancyLoad, loads.buoyancy_force, kRounding);
    expect_near(kBuoyancyLoad + 3, loads.buoyancy_torque, kRounding);
    expect_near(kDragLoad, loads.drag_force, kRounding);
    expect_near(kDragLoad + 3, loads.drag_torque, kRounding);
    expect_near(kAddedMassLoad, loads.added_mass_force, kRounding);
    expect_near(kAddedMassLoad + 3, loads.added_mass_torque, kRounding);
    expect_near(kWaterVelocity, loads.water_velocity, 1e-12);
  }
  void expect_service_wrenches(const RecordedRun& run) const {
    for (std::size_t body = 0; body < run.bodies.size(); ++body) {
      for (std::size_t i = 0; i < responses_.size(); ++i) {
        const BodyWrench& wrench = responses_[i].bodies[body];
        const RunRow& row = run.bodies[body].rows[i];
        EXPECT_EQ(row[kStatus], 0.0);
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_NEAR(row[kFx + k], wrench.force[k], 1e-8) << "body " << body << ", row " << i;
          EXPECT_NEAR(row[kTx + k], wrench.torque[k], 1e-8) << "body " << body << ", row " << i;
        }
      }
    }
  }

  TempDir directory_;
  Scene scene_;
  RequestHandler handler_;
  std::mt19937_64 random_{1};
  std::vector<WrenchRequest> requests_;
  std::vector<WrenchResponse> responses_;
  std::vector<BodiesLoads> loads_;
  RecordedLog log_;
};

class RunLoadsInWaves : public RunLoadsTest {
 protected:
  RunLoadsInWaves()
      : RunLoadsTest(moving_bodies("[[water.waves]]\ntype = \"regular\"\nheight = 0.5\nperiod = 3.0\n")) {}
};

class RunLoadsInReceivedSea : public RunLoadsTest {
 protected:
  RunLoadsInReceivedSea() : RunLoadsTest(moving_bodies("waves = \"received\"\n")) {}

  void receive_sea(const std::string& waves) {
    SeaState state = to_sea_state(*scene_of(moving_bodies(waves)).sea(), 7);
    state.utime = kNow;
    const ByteVector bytes = encoded(state);
    log(kSeaChannel, bytes);
    ASSERT_TRUE(handler_.receive_sea(bytes));
  }
};

TEST_F(RunLoadsTest, ComputesLoadsOfServiceForStates) {
  for (int i = 0; i < kSteps; ++i) handle();
  const RecordedRun run = read_csv(csv());
  expect_service_loads(run);
  expect_service_wrenches(run);
  EXPECT_EQ(run.bodies[0].loads_computed, kSteps);
  EXPECT_EQ(run.bodies[0].loads_recorded, 0);
  EXPECT_FALSE(run.bodies[0].loads_without_velocities);
  EXPECT_EQ(run.bodies[1].loads.size(), kSteps) << "drag, although its outputs do not include loads";
  EXPECT_TRUE(run.bodies[3].loads.empty());
}

TEST_F(RunLoadsInWaves, ComputesLoadsOfServiceForStates) {
  for (int i = 0; i < kSteps; ++i) handle();
  const RecordedRun run = read_csv(csv());
  expect_service_loads(run);
  expect_service_wrenches(run);
}

// The second sea replaces the first one, which the rows in front of it keep.
TEST_F(RunLoadsInReceivedSea, ComputesLoadsInSeaOfTheirRow) {
  receive_sea("[[water.waves]]\ntype = \"regular\"\nheight = 0.5\nperiod = 3.0\n");
  for (int i = 0; i < 5; ++i) handle(true, false);
  receive_sea("[[water.waves]]\ntype = \"regular\"\nheight = 1.0\nperiod = 5.0\ndirection = 90\n");
  for (int i = 0; i < 5; ++i) handle(true, false);
  const RecordedRun run = read_log();
  expect_service_loads(run);
  EXPECT_EQ(run.bodies[0].loads_computed, 10);
}

TEST_F(RunLoadsTest, TakesLoadsOfLog) {
  handle(true, true);
  handle(true, false);
  const auto change = [](BodiesLoads& loads) {
    loads.bodies[0].immersion = 0.75;
    loads.bodies[0].drag_force = {1.0, 2.0, 3.0};
  };
  handle(true, false);
  change(loads_.back());
  log(kLoadsChannel, encoded(loads_.back()));
  const RecordedRun run = read_log();
  expect_service_loads(run);
  EXPECT_EQ(run.bodies[0].loads[2][kImmersion], 0.75) << "as recorded";
  EXPECT_EQ(run.bodies[0].loads_recorded, 2);
  EXPECT_EQ(run.bodies[0].loads_computed, 1);
}

TEST_F(RunLoadsTest, ComputesLoadsThatLogHasNotForRequestsWithoutResponse) {
  handle(false, false);
  const RecordedRun run = read_log();
  expect_service_loads(run);
  expect_service_wrenches(run);
}

TEST_F(RunLoadsTest, SkipsMalformedAndForeignLoads) {
  handle(true, false);
  BodiesLoads other = loads_[0];
  other.id.session_id = 77;
  other.bodies[0].immersion = 0.125;
  log(kLoadsChannel, encoded(other));
  ByteVector bytes = encoded(loads_[0]);
  bytes.pop_back();
  log(kLoadsChannel, bytes);
  const RecordedRun run = read_log();
  expect_service_loads(run);
  EXPECT_EQ(run.bodies[0].loads_recorded, 0);
  ASSERT_EQ(run.warnings.size(), 1U);
  EXPECT_TRUE(run.warnings[0].starts_with("loads skipped: ")) << run.warnings[0];
}

TEST_F(RunLoadsTest, LeavesLoadsOfInvalidTwistUnknown) {
  WrenchRequest request{.id = {.utime = kNow, .session_id = 1, .seq = 1}, .lead_time = 0.0, .bodies = {}};
  for (const std::int32_t id : {1, 2, 3}) {
    request.bodies.push_back(random_motion(id, random_));
    request.bodies.back().linear_velocity[1] = std::numeric_limits<double>::quiet_NaN();
  }
  handle(request, false, false);
  const RecordedRun run = read_log();
  for (const std::size_t body : {0, 1}) {
    EXPECT_EQ(run.bodies[body].rows[0][kStatus], static_cast<double>(BodyStatus::kNonFiniteTwist));
    for (const double value : run.bodies[body].loads[0]) EXPECT_TRUE(std::isnan(value));
  }
  EXPECT_EQ(run.bodies[0].loads_computed, 0);
  EXPECT_EQ(run.bodies[2].rows[0][kStatus], 0.0) << "without drag or added mass";
  expect_equal(run.bodies[2].loads[0], loads_[0].bodies[1]);
}

TEST_F(RunLoadsTest, TakesBodiesWithoutVelocitiesAsResting) {
  for (int i = 0; i < kSteps; ++i) handle();
  const RecordedRun run = read_csv(csv(false));
  EXPECT_TRUE(run.bodies[0].loads_without_velocities);
  EXPECT_FALSE(run.bodies[2].loads_without_velocities) << "its loads do not depend on them";
  for (const LoadRow& row : run.bodies[2].loads) EXPECT_EQ(row[kDragLoad], 0.0);
  bool current = false;
  for (const LoadRow& row : run.bodies[0].loads) current = current || row[kDragLoad] > 1.0;
  EXPECT_TRUE(current) << "the drag of the current along x";
}

TEST_F(RunLoadsTest, KeepsLoadsWithTheirRowsWhenDecimating) {
  for (int i = 0; i < 2'000; ++i) handle(true, i % 2 == 0);
  const RecordedRun run = read_run(directory_.write("run.lcmlog", log_.text()), scene_, 800, {}).value();
  const BodyRun& body = run.bodies[0];
  ASSERT_LT(body.rows.size(), 300U);
  ASSERT_EQ(body.loads.size(), body.rows.size());
  for (std::size_t i = 0; i < body.rows.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const LoadRow& loads = body.loads[i];
      EXPECT_NEAR(loads[kBuoyancyLoad + k] + loads[kDragLoad + k] + loads[kAddedMassLoad + k],
                  body.rows[i][kFx + k], 1e-8);
    }
  }
  EXPECT_GT(body.loads_recorded, 0);
  EXPECT_EQ(body.loads_recorded + body.loads_computed, static_cast<std::int64_t>(body.rows.size()));
}

TEST_F(RunLoadsTest, WritesLoadsOfBodiesThatHaveThem) {
  handle();
  const RecordedRun run = read_log();
  const nlohmann::json data = parse_json(report_data(scene_, run, {.file = "run.lcmlog", .version = "1"}));
  EXPECT_EQ(data["model"]["loads"]["waves"], false);
  EXPECT_EQ(data["bodies"][0]["loads"]["recorded"], 1);
  EXPECT_EQ(data["bodies"][1]["loads"]["computed"], 1);
  EXPECT_FALSE(data["bodies"][3].contains("loads"));
  const nlohmann::json& model = data["model"]["bodies"];
  EXPECT_EQ(model[0]["loads"],
            nlohmann::json({{"drag_center", {0.1, 0.0, -0.2}}, {"added_mass", true}, {"published", true}}));
  EXPECT_EQ(model[1]["loads"]["added_mass"], false);
  EXPECT_EQ(model[2]["loads"]["drag_center"], nullptr);
  EXPECT_FALSE(model[3].contains("loads"));
}

TEST(RunLoads, AddNothingToPageWithoutSuchBodies) {
  const TempDir directory;
  const Scene scene = scene_of(kOneBoxScene);
  const RecordedRun run =
      read_run(directory.write("run.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n"), scene,
               100, {})
          .value();
  const std::string data = report_data(scene, run, {.file = "run.csv", .version = "1"});
  EXPECT_FALSE(contains(data, "loads"));
  EXPECT_FALSE(contains(report_page(data, "three.js"), "class LoadPlots"));
  EXPECT_FALSE(contains(report_page(data, "three.js"), "<!-- loads"));
  EXPECT_TRUE(contains(report_page(data, "three.js", {.loads = true}), "class LoadPlots"));
}

}  // namespace
}  // namespace buoyancy::view
