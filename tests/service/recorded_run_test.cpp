// Records a live run with LCM's own logger and replays it.
#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/service/replay_fixture.h"
#include "tests/service/running_service.h"
#include "tests/support/contains.h"
#include "tests/support/damaged_boxes.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

// The messages of a channel in a log that may still be written; incomplete events are skipped.
std::vector<RawBytes> events(const std::string& path, const std::string& channel) {
  std::vector<RawBytes> found;
  for (LoggedEvent& event : events_of(path, only_channel(channel))) found.push_back(std::move(event.bytes));
  return found;
}

// With a body 3 that has drag and requests its loads, and can be damaged.
const std::string kScene = kHydrostaticBoxScene + R"([[body]]
id = 3
shape = { type = "box", size = [2, 3, 4], segments = [2, 2, 2] }
outputs = ["wrench", "loads"]
[[body.compartment]]
shape = { type = "box", size = [1, 1, 1] }
flooded = 0
[[body.tank]]
shape = { type = "box", size = [1, 1, 1] }
position = [0, 0, -1]
fill = 0.5
[body.drag]
quadratic = [18, 22, 37, 1.5, 1.5, 1.5]
[body.added_mass]
matrix = [5, 126, 126, 0.1, 33, 33]
)";

void send_condition(RawLcmSocket& socket, const ConditionChange& change) {
  socket.send("BUOYANCY_CONDITION", encoded(change));
}

TEST(RecordedRun, ReplaysToSameBytesAsLiveRun) {
  const TempDir directory;
  const std::string recorded = directory.path("live.lcmlog");
  const std::string replayed = directory.path("replayed.lcmlog");
  const std::string scene = directory.write("scene.toml", kScene);
  RawLcmSocket socket;
  const RunningService service({}, kScene);
  ChildProcess logger(command_of({"lcm-logger", "-q", "-f", "--flush-interval=1", recorded}));
  std::error_code not_there_yet;
  while (std::filesystem::file_size(recorded, not_there_yet) + 1 <= 1) {
    socket.send("IS_THE_LOGGER_THERE", {1});
    ASSERT_FALSE(logger.wait(0.01)) << logger.standard_error();
  }

  // lcm-logger drops messages if more than 30 are pending, so the test waits for it. It flushes its file only
  // when it writes, at most once per millisecond, so a message may appear only with the next one.
  std::size_t checkpoints = 0;
  const auto wait_for_logger = [&] {
    constexpr std::size_t kMaxPending = 3;
    const std::size_t wanted = checkpoints + 1;
    std::size_t written = 0;
    while (written < wanted) {
      if (checkpoints < written + kMaxPending) {
        socket.send("CHECKPOINT", {1});
        ++checkpoints;
      }
      if (logger.wait(0.003)) return false;
      written = events(recorded, "CHECKPOINT").size();
    }
    return true;
  };
  constexpr std::int64_t kCheckpoint = 5;
  for (std::int64_t seq = 0; seq < 300; ++seq) {
    if (seq % kCheckpoint == 0) {
      ASSERT_TRUE(wait_for_logger()) << logger.standard_error();
    }
    // Changes that hold from the next request on; one of them cannot be used.
    const auto next_utime = one_body(0, seq + 1, 0.0).id.utime;
    if (seq % 40 == 7)
      send_condition(socket, flooded(next_utime, 0, 0.01 * static_cast<double>(seq % 99), 3));
    if (seq % 60 == 8) send_condition(socket, filled(next_utime, 0, seq == 188 ? 2.0 : 0.25, 3));
    WrenchRequest states = one_body(seq / 100, seq, 0.01 * static_cast<double>(seq) - 1.0);
    states.bodies.resize(static_cast<std::size_t>(1 + seq % 7), states.bodies[0]);
    states.bodies.back().body_id = static_cast<std::int32_t>(seq % 4);  // some of them unknown
    states.bodies.back().quaternion_wxyz = {0.8, 0.36, 0.48, 0.0};
    states.lead_time = seq % 5 == 0 ? 0.01 : 0.0;
    states.bodies.back().linear_velocity = {0.1, 0.2, -0.3};
    const int attempts = seq % 10 == 3 ? 2 : 1;
    for (int attempt = 0; attempt < attempts; ++attempt) {
      send_request(socket, states);
      ASSERT_EQ(receive(socket).id.seq, seq);
    }
  }
  // The loads of the last request follow its wrench.
  ASSERT_TRUE(socket.receive("BUOYANCY_LOADS", kWaitTimeout));
  ASSERT_TRUE(wait_for_logger()) << logger.standard_error();
  logger.send_signal(SIGINT);
  ASSERT_TRUE(logger.wait(kWaitTimeout));

  const FinishedProcess finished = run_program("buoyancy-replay", {"--scene", scene, recorded, replayed});
  ASSERT_EQ(finished.exit_code, 1) << "one condition cannot be used";
  EXPECT_TRUE(contains(finished.standard_error, "liquid_volume = 2"));
  const std::vector<RawBytes> live = events(recorded, "BUOYANCY_WRENCHES");
  EXPECT_EQ(live.size(), 330U);
  EXPECT_EQ(events(replayed, "BUOYANCY_WRENCHES"), live);
  const std::vector<RawBytes> live_hydrostatics = events(recorded, "BUOYANCY_HYDROSTATICS");
  EXPECT_GT(live_hydrostatics.size(), 50U);
  EXPECT_EQ(events(replayed, "BUOYANCY_HYDROSTATICS"), live_hydrostatics);
  const std::vector<RawBytes> live_loads = events(recorded, "BUOYANCY_LOADS");
  EXPECT_GT(live_loads.size(), 50U);
  EXPECT_EQ(events(replayed, "BUOYANCY_LOADS"), live_loads);
}

}  // namespace
}  // namespace buoyancy
