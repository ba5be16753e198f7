// Replays in waves: the sea of the scene, and one that the log holds.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "engine/request_handler.h"
#include "messages/sea_state.h"
#include "messages/status.h"
#include "tests/engine/grid_bytes.h"
#include "tests/service/box_in_waves.h"
#include "tests/service/replay_fixture.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

const std::string kSwell = "waves = { type = \"regular\", height = 0.5, period = 5.0 }\n";
const std::string kHigherSwell = "waves = { type = \"regular\", height = 0.8, period = 4.0 }\n";
const std::string kReceived = "waves = \"received\"\n";

std::vector<std::uint8_t> sea_bytes(const std::string& water, std::int64_t utime) {
  SeaState state = sea_of(water, 3);
  state.utime = utime;
  return encoded(state);
}

std::string contents_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<BodyWrench> wrenches_of(const std::string& path) {
  std::vector<BodyWrench> wrenches;
  for (const LoggedEvent& logged :
       events_of(path, [](std::string_view name) { return name == kWrenchesChannel; })) {
    WrenchResponse response;
    if (!decode(logged.bytes, response)) wrenches.push_back(response.bodies.at(0));
  }
  return wrenches;
}

class ReplayInWaves : public Replay {};

TEST_F(ReplayInWaves, UsesTheUtimeOfEachRequest) {
  scene_ = write("waves.toml", box_in(kSwell));
  std::string log;
  for (int i = 0; i < 4; ++i) log += event("BUOYANCY_STATES", 10 + i, request(1'000'000 * i, 0.0));
  const FinishedProcess finished = replay(write("in.lcmlog", log), path("out.lcmlog"));
  ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  const std::vector<BodyWrench> wrenches = wrenches_of(path("out.lcmlog"));
  ASSERT_EQ(wrenches.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_NE(wrenches[i].force, wrenches[0].force) << i;
}

// More requests than a batch holds, and seas between them.
std::string log_with_seas() {
  std::string log;
  for (int i = 0; i < 6'000; ++i) {
    const std::int64_t utime = 10'000 * i;
    if (i == 1'500) log += event("BUOYANCY_SEA", utime, sea_bytes(kSwell, utime));
    const std::string& sent_again = i < 4'200 ? kSwell : kHigherSwell;
    if (i > 1'500 && i % 500 == 0) log += event("BUOYANCY_SEA", utime, sea_bytes(sent_again, utime));
    if (i == 4'200) log += event("BUOYANCY_SEA", utime, sea_bytes(kHigherSwell, utime));
    log += event("BUOYANCY_STATES", utime, request(utime, 0.0));
  }
  return log;
}

TEST_F(ReplayInWaves, ReceivesTheSeaOfTheLogOnAnyThreads) {
  scene_ = write("received.toml", box_in(kReceived));
  const std::string input = write("in.lcmlog", log_with_seas());
  std::string expected;
  for (const char* jobs : {"1", "3", "8"}) {
    const FinishedProcess finished = replay(input, path("out.lcmlog"), {"--jobs", jobs});
    ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
    const std::string output = contents_of(path("out.lcmlog"));
    if (expected.empty()) expected = output;
    EXPECT_EQ(output, expected) << jobs << " threads";
  }
  const std::vector<BodyWrench> received = wrenches_of(path("out.lcmlog"));
  ASSERT_EQ(received.size(), 6'000U);
  EXPECT_EQ(received[1'499].status, BodyStatus::kNoSea);
  EXPECT_EQ(received[1'500].status, BodyStatus::kOk);
  const auto same_as_in = [&](const std::string& water, std::size_t first, std::size_t end) {
    scene_ = write("described.toml", box_in(water));
    ASSERT_EQ(replay(input, path("described.lcmlog")).exit_code, 0);
    const std::vector<BodyWrench> described = wrenches_of(path("described.lcmlog"));
    for (std::size_t i = first; i < end; i += 7) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(received[i].force[axis], described[i].force[axis], 1e-3) << i;
      }
    }
  };
  same_as_in(kSwell, 1'500, 4'200);
  same_as_in(kHigherSwell, 4'200, 6'000);
}

ByteVector moving_grid(std::int64_t utime) {
  SeaGridHeader header = kGridAroundOrigin;
  header.utime = utime;
  header.origin = {0.0, 0.0};
  const double phase = 2e-6 * static_cast<double>(utime);
  return grid_bytes(header, [phase](double x1, double x2) { return 0.3 * std::cos(x1 + 0.5 * x2 - phase); });
}

// Requests at the times of grids, between them, and, with a lead time, after the last one.
TEST_F(ReplayInWaves, ReceivesTheGridsOfTheLogOnAnyThreads) {
  const std::string text = box_in("waves = \"grid\"\n");
  scene_ = write("grids.toml", text);
  const Scene scene = scene_of(text);
  RequestHandler handler(scene);
  std::string log;
  std::vector<BodyWrench> expected;
  for (std::int64_t i = 0; i < 4'000; ++i) {
    const std::int64_t utime = 1'000 * i;
    if (i % 20 == 0 && i < 3'900) {
      const ByteVector grid = moving_grid(utime);
      log += event("BUOYANCY_SEA_GRID", utime, grid);
      ASSERT_TRUE(handler.receive_sea(grid));
    }
    const ByteVector bytes = request(utime - (i % 3 == 0 ? 15'000 : i % 20 * 1'000), 0.0);
    log += event("BUOYANCY_STATES", utime, bytes);
    expected.push_back(decoded<WrenchResponse>(handler.handle(bytes)).bodies.at(0));
  }
  const std::string input = write("in.lcmlog", log);
  for (const char* jobs : {"1", "3", "8"}) {
    const FinishedProcess finished = replay(input, path("out.lcmlog"), {"--jobs", jobs});
    ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
    const std::vector<BodyWrench> received = wrenches_of(path("out.lcmlog"));
    ASSERT_EQ(received.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(received[i].status, expected[i].status) << i;
      ASSERT_EQ(received[i].force, expected[i].force) << i;
    }
  }
  EXPECT_EQ(expected.front().status, BodyStatus::kNoSea);
  EXPECT_EQ(expected[1'000].status, BodyStatus::kOk);
  EXPECT_EQ(expected.back().status, BodyStatus::kNoSea);
}

TEST_F(ReplayInWaves, ReportsASeaThatCannotBeUsed) {
  scene_ = write("received.toml", box_in(kReceived));
  std::vector<std::uint8_t> cut = sea_bytes(kSwell, 0);
  cut.pop_back();
  const std::string log = event("BUOYANCY_SEA", 1, sea_bytes(kSwell, 0)) + event("BUOYANCY_SEA", 2, cut) +
                          event("BUOYANCY_STATES", 3, request(5, 0.0));
  const FinishedProcess finished = replay(write("in.lcmlog", log), path("out.lcmlog"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "event at 2 us: a message of the sea"));
  EXPECT_EQ(wrenches_of(path("out.lcmlog")).at(0).status, BodyStatus::kOk) << "the sea before remains";
}

TEST_F(ReplayInWaves, RefusesInputThatHasNoSea) {
  scene_ = write("received.toml", box_in(kReceived));
  const FinishedProcess csv =
      replay(write("in.csv", "utime,body_id,px,py,pz,qw,qx,qy,qz\n0,1,0,0,0,1,0,0,0\n"), path("out.csv"));
  EXPECT_EQ(csv.exit_code, 2);
  EXPECT_TRUE(contains(csv.standard_error, "a CSV file has poses only"));
  const FinishedProcess part =
      replay(write("in.lcmlog", log_of_requests(3)), path("out.lcmlog"), {"--part", "1/2"});
  EXPECT_EQ(part.exit_code, 2);
  EXPECT_TRUE(contains(part.standard_error, "may have been received in an earlier part"));
}

TEST_F(ReplayInWaves, JoinsPartsOfASceneWithASea) {
  scene_ = write("waves.toml", box_in(kSwell));
  const std::string input = write("in.lcmlog", log_of_requests(3'000));
  ASSERT_EQ(replay(input, path("whole.lcmlog")).exit_code, 0);
  for (const char* part : {"1/2", "2/2"}) {
    const FinishedProcess finished = replay(input, path("out.lcmlog"), {"--part", part});
    ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  }
  const FinishedProcess joined = run({"--join", "2", input, path("out.lcmlog")});
  ASSERT_EQ(joined.exit_code, 0) << joined.standard_error;
  EXPECT_EQ(contents_of(path("out.lcmlog")), contents_of(path("whole.lcmlog")));
}

}  // namespace
}  // namespace buoyancy
