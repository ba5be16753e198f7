// The service in waves, over UDP: the sea that it publishes, and one that it receives.
#include <cmath>
#include <csignal>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "messages/sea_state.h"
#include "tests/engine/grid_bytes.h"
#include "tests/service/box_in_waves.h"
#include "tests/service/raw_lcm.h"
#include "tests/service/running_service.h"
#include "tests/support/contains.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

const std::string kSwell = "depth = 30.0\nwaves = { type = \"regular\", height = 0.5, period = 5.0 }\n";
const std::string kHigherSwell =
    "waves = { type = \"regular\", height = 0.8, period = 5.0 }\ncurrent = { velocity = [0.5, 0.2, 0.1] }\n";
const std::string kBreakingWave = "waves = { type = \"regular\", height = 7.9, period = 4.0 }\n";

void send_sea(RawLcmSocket& socket, const SeaState& sea) {
  socket.send("BUOYANCY_SEA", encoded(sea));
}

SeaState receive_sea(RawLcmSocket& socket) {
  const std::optional<RawBytes> bytes = socket.receive("BUOYANCY_SEA", kWaitTimeout);
  if (!bytes) throw std::runtime_error("no sea");
  return decoded<SeaState>(*bytes);
}

// The response to a request that is sent anew until its status is the wanted one.
BodyWrench wrench_with_status(RawLcmSocket& socket, std::int64_t utime, BodyStatus wanted) {
  for (std::int64_t seq = 1;; ++seq) {
    WrenchRequest states = one_body(9, seq, 0.2);
    states.id.utime = utime;
    send_request(socket, states);
    const BodyWrench wrench = receive(socket).bodies.at(0);
    if (wrench.status == wanted) return wrench;
  }
}

TEST(ServiceInWaves, PublishesItsSeaOnceASecond) {
  RawLcmSocket socket;
  const RunningService service({}, box_in(kSwell));
  const auto status = wait_for_status(socket, [](const ServiceStatus&) { return true; });
  ASSERT_TRUE(status);
  const SeaState expected = sea_of(kSwell, status->instance_id);
  EXPECT_EQ(receive_sea(socket), expected);
  EXPECT_EQ(receive_sea(socket), expected);
}

// Between two statuses, a service publishes its sea.
void expect_no_sea(RawLcmSocket& socket) {
  for (int statuses = 0; statuses < 2;) {
    const auto message = socket.receive_any(kWaitTimeout);
    ASSERT_TRUE(message);
    EXPECT_NE(message->channel, "BUOYANCY_SEA");
    statuses += message->channel == "BUOYANCY_STATUS" ? 1 : 0;
  }
}

TEST(ServiceInWaves, PublishesTheSeaOfEachReload) {
  RawLcmSocket socket;
  RunningService service({}, box_in(kSwell));
  const std::int64_t instance = receive_sea(socket).instance_id;
  std::int64_t reloads = 0;
  for (const std::string& water : {kHigherSwell, std::string(), kSwell, kHigherSwell, std::string()}) {
    service.write("scene.toml", box_in(water));
    service.child().send_signal(SIGHUP);
    ++reloads;
    ASSERT_TRUE(wait_for_status(socket, [&](const ServiceStatus& now) { return now.reloads == reloads; }));
    if (water.empty()) {
      // One that was on its way before the status may still come.
      ASSERT_TRUE(wait_for_status(socket, [](const ServiceStatus&) { return true; }));
      expect_no_sea(socket);
    } else {
      SeaState sea;
      for (int i = 0; i < 2; ++i) sea = receive_sea(socket);
      EXPECT_EQ(sea, sea_of(water, instance));
    }
  }
}

TEST(ServiceInWaves, UsesTheSeaThatItReceives) {
  RawLcmSocket socket;
  const RunningService service({}, box_in("waves = \"received\"\n"));
  WrenchRequest early = one_body(9, 0, 0.2);
  send_request(socket, early);
  const BodyWrench without = receive(socket).bodies.at(0);
  EXPECT_EQ(without.status, BodyStatus::kNoSea);
  EXPECT_EQ(without.force, (std::array<double, 3>{}));

  SeaState sea = sea_of(kSwell, 77);
  sea.utime = 1'000'000;
  send_sea(socket, sea);
  const BodyWrench in_waves = wrench_with_status(socket, 2'000'000, BodyStatus::kOk);
  EXPECT_NE(in_waves.force[0], 0.0);
  EXPECT_EQ(wrench_with_status(socket, 999'999, BodyStatus::kNoSea).force, (std::array<double, 3>{}));

  SeaState other_gravity = sea;
  other_gravity.gravity = 9.81;
  send_sea(socket, other_gravity);
  const auto status =
      wait_for_status(socket, [](const ServiceStatus& now) { return now.counters.seas_rejected > 0; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->counters.seas_received, 1);
  EXPECT_GT(status->counters.wave_patches, 0);
  // The service logs warnings after it has published the status that counts them.
  ASSERT_TRUE(wait_for_status(socket, [](const ServiceStatus&) { return true; }));
  EXPECT_TRUE(contains(service.log(), "gravity = 9.81"));

  send_sea(socket, sea_of(kBreakingWave, 77));
  ASSERT_TRUE(
      wait_for_status(socket, [](const ServiceStatus& now) { return now.counters.seas_received > 1; }));
  ASSERT_TRUE(wait_for_status(socket, [](const ServiceStatus&) { return true; }));
  EXPECT_TRUE(contains(service.log(), "at which such waves break"));
}

// A wave that moves, on a grid around the box; 200 x 200 samples are prepared by a thread.
ByteVector moving_grid(std::int64_t utime, std::int32_t side) {
  SeaGridHeader header = kGridAroundOrigin;
  header.utime = utime;
  header.rows = header.columns = side;
  header.origin = {-10.0, -10.0};
  header.spacing = {40.0 / side, 40.0 / side};
  const double phase = 2e-6 * static_cast<double>(utime);
  return grid_bytes(header, [phase](double x1, double x2) { return 0.3 * std::cos(x1 + 0.5 * x2 - phase); });
}

// Grid and request follow each other without a pause, as in a simulator in lock-step.
TEST(ServiceInWaves, AnswersInTheGridThatWasSentBeforeTheRequest) {
  const std::string text = box_in("waves = \"grid\"\n");
  const Scene scene = scene_of(text);
  for (const std::int32_t side : {40, 200}) {
    RawLcmSocket socket;
    const RunningService service({}, text);
    RequestHandler handler(scene);
    int sent_again = 0;
    for (std::int64_t step = 0; step < 30; ++step) {
      const ByteVector grid = moving_grid(16'667 * step, side);
      ASSERT_TRUE(handler.receive_sea(grid));
      WrenchRequest states = one_body(9, step, 0.2);
      states.id.utime = 16'667 * step;
      const ByteVector request = encoded(states);
      const auto expected = decoded<WrenchResponse>(handler.handle(request));
      BodyWrench wrench;
      for (bool first = true; first || wrench.status == BodyStatus::kNoSea; first = false) {
        if (!first) ++sent_again;
        socket.send("BUOYANCY_SEA_GRID", grid);
        socket.send("BUOYANCY_STATES", request);
        wrench = receive(socket).bodies.at(0);
      }
      ASSERT_EQ(wrench.status, BodyStatus::kOk);
      EXPECT_EQ(wrench.force, expected.bodies[0].force);
      EXPECT_EQ(wrench.torque, expected.bodies[0].torque);
    }
    EXPECT_LT(sent_again, 5) << "the network may lose a grid, but requests wait for those before them";
    EXPECT_TRUE(contains(service.log(), "grids of the sea on BUOYANCY_SEA_GRID"));
  }
}

TEST(ServiceInWaves, RejectsAndCountsGridsThatItCannotUse) {
  ByteVector cut = moving_grid(0, 40);
  cut.pop_back();
  ByteVector not_finite = moving_grid(0, 200);
  for (std::size_t i = 1; i <= 4; ++i) not_finite[not_finite.size() - i] = 0xff;
  for (const auto& [bytes, text] : {std::pair{cut, "length does not fit the count"},
                                    {not_finite, "elevation[199][199] = "},
                                    {encoded(sea_of(kSwell, 77)), "sea_grid_t"}}) {
    RawLcmSocket socket;
    const RunningService service({}, box_in("waves = \"grid\"\n"));
    socket.send("BUOYANCY_SEA_GRID", bytes);
    ASSERT_TRUE(
        wait_for_status(socket, [](const ServiceStatus& now) { return now.counters.seas_rejected == 1; }));
    ASSERT_TRUE(wait_for_status(socket, [](const ServiceStatus&) { return true; }));
    EXPECT_TRUE(contains(service.log(), text)) << service.log();
  }
}

TEST(ServiceInWaves, LogsThatTheWavesOfItsSceneWouldBreak) {
  const RunningService service({}, box_in(kBreakingWave));
  EXPECT_TRUE(contains(service.log(), "at which such waves break"));
}

TEST(ServiceInWaves, PublishesNoSeaThatItReceives) {
  RawLcmSocket socket;
  const RunningService service({}, box_in("waves = \"received\"\n"));
  expect_no_sea(socket);
}

}  // namespace
}  // namespace buoyancy
