// Replays of logs with requests for the water at points.
#include "engine/request_handler.h"
#include "tests/engine/sea_bytes.h"
#include "tests/service/replay_fixture.h"
#include "tests/support/contains.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

const std::string kReceivingScene = kTestWater + R"(waves = "received"
[[water.layer]]
below = -1
density = 1025
[[body]]
id = 1
shape = { type = "box", size = [2, 3, 4], segments = [2, 2, 2] }
tolerance = 1e-3
)";
constexpr int kRequests = 3'000;  // more than a batch holds

std::vector<std::uint8_t> points_request(std::int64_t utime) {
  const auto t = static_cast<double>(utime);
  const std::vector<WaterPoint> points{{{t, 0.0, -2.0}}, {{0.0, t, -0.1}}, {{0.0, 0.0, 5.0}}};
  std::vector<std::uint8_t> bytes;
  encode(BorrowedWaterPoints{{utime, 0, utime}, points}, bytes);
  return bytes;
}

std::vector<std::uint8_t> sea_at(int i) {
  return sea_bytes("waves = { type = \"regular\", period = 5, height = " + std::to_string(0.1 * (1 + i % 3)) +
                       " }\ndensity = 1000\n",
                   i);
}

bool has_sea(int i) {
  return i % 500 == 20;
}

class ReplayOfPoints : public Replay {
 protected:
  void SetUp() override { scene_ = write("sea.toml", kReceivingScene); }

  static std::string log() {
    std::string text;
    for (int i = 0; i < kRequests; ++i) {
      if (has_sea(i)) text += event("BUOYANCY_SEA", i, gravity_of_scene(sea_at(i)));
      text += event("BUOYANCY_WATER_POINTS", i, points_request(i));
      if (i % 10 == 0) text += event("BUOYANCY_STATES", i, request(i, 0.0));
    }
    return text;
  }

  // The scenes of these tests have a gravity of 10.
  static std::vector<std::uint8_t> gravity_of_scene(const std::vector<std::uint8_t>& sea) {
    auto state = decoded<SeaState>(sea);
    state.gravity = kGravity;
    return encoded(state);
  }

  static bool is_samples(std::string_view channel) { return channel == kWaterSamplesChannel; }
};

TEST_F(ReplayOfPoints, AnswersLikeOneHandlerOnAnyThreads) {
  const std::string input = write("in.lcmlog", log());
  const Scene scene = scene_of(kReceivingScene);
  for (const char* jobs : {"1", "4"}) {
    const FinishedProcess finished = replay(input, path("out.lcmlog"), {"--jobs", jobs});
    ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
    EXPECT_TRUE(contains(finished.standard_output, "points of the water")) << finished.standard_output;
    const std::vector<LoggedEvent> found = events_of(path("out.lcmlog"), is_samples);
    ASSERT_EQ(found.size(), std::size_t{kRequests});
    EXPECT_EQ(events_of(path("out.lcmlog")).size(), std::size_t{kRequests} + kRequests / 10);
    RequestHandler handler(scene, {.threads = 1});
    for (int i = 0; i < kRequests; ++i) {
      if (has_sea(i)) {
        ASSERT_TRUE(handler.receive_sea(gravity_of_scene(sea_at(i))));
      }
      const LoggedEvent& event = found[static_cast<std::size_t>(i)];
      ASSERT_EQ(event.timestamp, i);
      ASSERT_TRUE(std::ranges::equal(event.bytes, handler.handle(points_request(i)))) << i;
    }
    EXPECT_EQ(handler.counters().water_points_failed, 3 * 20) << "before the first sea";
  }
}

TEST_F(ReplayOfPoints, JoinsPartsToTheWholeOutput) {
  scene_ = write("scene.toml", kOneBoxScene);
  std::string text;
  for (int i = 0; i < kRequests; ++i) text += event("ASK", i, points_request(i));
  const std::string input = write("in.lcmlog", text);
  const std::vector<std::string> channels{"--water-points-channel", "ASK", "--water-samples-channel",
                                          "ANSWER"};
  ASSERT_EQ(replay(input, path("whole.lcmlog"), channels).exit_code, 0);
  EXPECT_EQ(events_of(path("whole.lcmlog"), only_channel("ANSWER")).size(), std::size_t{kRequests});
  for (const char* part : {"2/2", "1/2"}) {
    std::vector<std::string> options = channels;
    options.insert(options.end(), {"--part", part});
    ASSERT_EQ(replay(input, path("out.lcmlog"), options).exit_code, 0);
  }
  ASSERT_EQ(run({"--join", "2", input, path("out.lcmlog")}).exit_code, 0);
  EXPECT_TRUE(read_file(path("out.lcmlog")) == read_file(path("whole.lcmlog")));
}

TEST_F(ReplayOfPoints, WritesNoRowOfACsv) {
  scene_ = write("scene.toml", kOneBoxScene);
  const std::string input =
      write("in.lcmlog", event("BUOYANCY_WATER_POINTS", 1, points_request(1)) + log_of_requests(2));
  ASSERT_EQ(replay(input, path("out.csv")).exit_code, 0);
  EXPECT_EQ(std::ranges::count(read_file(path("out.csv")), '\n'), 3);
}

TEST_F(ReplayOfPoints, RejectsAMessageOfTheOtherType) {
  scene_ = write("scene.toml", kOneBoxScene);
  const std::string input = write("in.lcmlog", event("BUOYANCY_WATER_POINTS", 7, request(1, 0.0)) +
                                                   event("BUOYANCY_STATES", 8, points_request(1)));
  const FinishedProcess finished = replay(input, path("out.lcmlog"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error,
                       "event at 7 us is not a valid request: fingerprint of another type or version"));
  EXPECT_TRUE(contains(finished.standard_error, "event at 8 us is not a valid request"));
}

}  // namespace
}  // namespace buoyancy
