// The service with compartments and tanks that change during the run, over UDP.
#include <chrono>
#include <csignal>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/service/running_service.h"
#include "tests/support/contains.h"
#include "tests/support/damaged_boxes.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

const std::string kChannel = "BUOYANCY_CONDITION";

void send_condition(RawLcmSocket& socket, const ConditionChange& change) {
  socket.send(kChannel, encoded(change));
}

BodyWrench wrench_at(RawLcmSocket& socket, std::int64_t utime) {
  static std::int64_t seq = 0;
  WrenchRequest states = one_body(9, ++seq, 0.2);
  states.id.utime = utime;
  send_request(socket, states);
  return receive(socket).bodies.at(0);
}

// Of body 1 in this condition, in the scene file.
BodyWrench wrench_of(RawLcmSocket& socket, const DamagedBoxes& condition) {
  const RunningService service({}, damaged_boxes(condition));
  return wrench_at(socket, 0);
}

// The wrench of a request that is sent anew until the wrench is the wanted one. Throws if none is in time.
template <typename Predicate>
BodyWrench wrench_once(RawLcmSocket& socket, std::int64_t utime, const Predicate& wanted) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (std::chrono::steady_clock::now() < limit) {
    const BodyWrench wrench = wrench_at(socket, utime);
    if (wanted(wrench)) return wrench;
  }
  throw std::runtime_error("no response has the wanted wrench");
}

TEST(ServiceWithConditions, FloodsACompartmentFromItsUtimeOn) {
  RawLcmSocket socket;
  const BodyWrench intact = wrench_of(socket, {});
  const BodyWrench damaged = wrench_of(socket, {.bow_flooded = "1"});
  ASSERT_LT(damaged.force[2], intact.force[2] - 1000.0);
  const RunningService service({}, damaged_boxes());
  EXPECT_EQ(wrench_at(socket, 1'000'000).force, intact.force);
  send_condition(socket, flooded(2'000'000, 0, 1.0));
  const BodyWrench later =
      wrench_once(socket, 3'000'000, [&](const BodyWrench& now) { return now.force != intact.force; });
  EXPECT_EQ(later.force, damaged.force);
  EXPECT_EQ(later.torque, damaged.torque);
  EXPECT_EQ(wrench_at(socket, 2'000'000).force, damaged.force);
  EXPECT_EQ(wrench_at(socket, 1'999'999).force, intact.force);
}

TEST(ServiceWithConditions, ReportsAChangeThatCannotBeUsed) {
  RawLcmSocket socket;
  const RunningService service({}, damaged_boxes());
  send_condition(socket, filled(1'000'000, 0, 1000.0));
  const BodyWrench unknown =
      wrench_once(socket, 1'000'000, [](const BodyWrench& now) { return now.status != BodyStatus::kOk; });
  EXPECT_EQ(unknown.status, BodyStatus::kBadCondition);
  EXPECT_EQ(unknown.force, (std::array<double, 3>{}));
  EXPECT_EQ(wrench_at(socket, 999'999).status, BodyStatus::kOk);
  const auto counted = wait_for_status(socket, [](const ServiceStatus& now) {
    return now.counters.bodies[static_cast<std::size_t>(BodyStatus::kBadCondition)] > 0;
  });
  ASSERT_TRUE(counted);
  EXPECT_EQ(counted->counters.conditions_rejected, 1);
  EXPECT_EQ(counted->counters.conditions_received, 0);
  // The service logs warnings after it has published the status that counts them.
  ASSERT_TRUE(wait_for_status(socket, [](const ServiceStatus&) { return true; }));
  for (const char* part : {"conditions rejected: 1", "liquid_volume = 1000", "body 1 (hull), ballast",
                           "from 0 to the tank's volume, 1 m^3", "bodies with status BAD_CONDITION: "}) {
    EXPECT_TRUE(contains(service.log(), part));
  }
}

TEST(ServiceWithConditions, ReceivesThemOnceASceneHasCompartments) {
  RawLcmSocket socket;
  RunningService service({}, kBoxScene);
  send_condition(socket, flooded(0, 0, 7.0));
  const auto reload = [&service](const std::string& scene, const std::string& until) {
    service.write("scene.toml", scene);
    service.child().send_signal(SIGHUP);
    ASSERT_TRUE(service.child().wait_for_text(until, kWaitTimeout)) << service.log();
  };
  reload(damaged_boxes(), "reloaded: 3 bodies (before: 2)");
  const BodyWrench intact = wrench_at(socket, 5);
  EXPECT_EQ(intact.status, BodyStatus::kOk) << "the one before was not received";
  send_condition(socket, flooded(0, 0, 1.0));
  const BodyWrench damaged =
      wrench_once(socket, 5, [&](const BodyWrench& now) { return now.force != intact.force; });
  EXPECT_LT(damaged.force[2], intact.force[2] - 1000.0);
  reload(damaged_boxes({.stern_flooded = "0.75"}), "reloaded: 3 bodies (before: 3)");
  EXPECT_LT(wrench_at(socket, 5).force[2], damaged.force[2] - 1000.0) << "the bow is flooded still";
  reload(kBoxScene, "reloaded: 2 bodies");
  send_condition(socket, flooded(0, 0, 1.0));
  EXPECT_EQ(wrench_at(socket, 5).status, BodyStatus::kOk);
}

TEST(ServiceWithConditions, ReceivesThemOnTheChannelGiven) {
  RawLcmSocket socket;
  const RunningService service({"--condition-channel", "DAMAGE"}, damaged_boxes());
  const BodyWrench intact = wrench_at(socket, 0);
  send_condition(socket, flooded(0, 0, 7.0));
  socket.send("DAMAGE", encoded(flooded(0, 0, 1.0)));
  const BodyWrench damaged =
      wrench_once(socket, 0, [&](const BodyWrench& now) { return now.force != intact.force; });
  EXPECT_EQ(damaged.status, BodyStatus::kOk);
}

}  // namespace
}  // namespace buoyancy
