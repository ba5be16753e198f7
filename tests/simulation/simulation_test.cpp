#include "simulation/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/in_process_run.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

// What is said about a body with this status.
std::string error_of(BodyStatus status) {
  const Scene scene = scene_of(
      "[[body]]\nid = 1\nname = \"crate\"\nshape = { type = \"box\" }\n"
      "[body.client]\ndensity = 500\nposition = [0, 0, 0]\n");
  Simulation simulation = simulation_of(scene, {});
  WrenchResponse response;
  response.id = simulation.request().id;
  response.bodies.resize(1);
  response.bodies[0] = {.body_id = 1, .status = status};
  simulation.accept(response);
  const Expected<void> checked = simulation.check_wrenches();
  return checked ? "no error" : checked.error().message();
}

TEST(Simulation, EndsWithReasonAndHintIfAWrenchIsNotOk) {
  EXPECT_EQ(error_of(BodyStatus::kOk), "no error");
  EXPECT_THAT(error_of(BodyStatus::kUnknownBody), HasSubstr("buoyancyd runs a different scene"));
  EXPECT_THAT(error_of(BodyStatus::kOpenEdgeWet), HasSubstr("its boundary is submerged"));
  EXPECT_THAT(error_of(BodyStatus::kOutOfRange), HasSubstr("Use a smaller --step"));
  EXPECT_THAT(error_of(BodyStatus::kBadCondition), HasSubstr("correct what publishes BUOYANCY_CONDITION"));
  EXPECT_EQ(
      error_of(BodyStatus::kNoSea),
      "body 1 (crate) at 0.000000 s: status NO_SEA; expected status OK. Likely cause: the scene's waves "
      "are received, and buoyancyd has not received a sea for this time. Start what publishes "
      "BUOYANCY_SEA, or BUOYANCY_SEA_GRID, before the client.");
}

}  // namespace
}  // namespace buoyancy
