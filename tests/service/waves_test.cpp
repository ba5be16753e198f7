// The service in waves, over UDP: the sea that it publishes, and one that it receives.
#include <csignal>
#include <limits>

#include <gtest/gtest.h>

#include "messages/sea_state.h"
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
