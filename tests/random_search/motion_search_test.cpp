#include "tests/random_search/motion_search.h"

#include <algorithm>
#include <thread>

#include <gtest/gtest.h>

#include "tests/stress/stress_case.h"

namespace buoyancy {
namespace {

TEST(MotionSearch, FindsNoMotionThatGainsEnergyIn200Cases) {
  const std::int64_t cases = tries(200);
  const MotionSearchStats stats =
      search_motions(3, 0, cases, std::max(1U, std::thread::hardware_concurrency()));
  for (const FailedMotionCase& failure : stats.failures) {
    ADD_FAILURE() << "case " << failure.number << ": " << failure.violation << "\n" << failure.text;
  }
  std::int64_t done = 0;
  for (const MotionFigures& figures : stats.figures) done += figures.cases;
  EXPECT_EQ(done, cases);
  EXPECT_GT(stats.figures[1].rise_undamped.value, 0.0);
}

TEST(MotionSearch, GivesTheSameResultsWithAnyNumberOfThreads) {
  EXPECT_EQ(markdown(search_motions(4, 0, 12, 1)), markdown(search_motions(4, 0, 12, 3)));
}

TEST(MotionSearch, DrawsBodiesOfBothKindsWithinTheirLimits) {
  double heaviest = 0.0;
  for (std::int64_t number = 0; number < 40; ++number) {
    const MotionCase motion = random_motion_case(5, number);
    EXPECT_EQ(motion.kind, number % 2 == 0 ? MotionKind::kSubmerged : MotionKind::kPiercing);
    EXPECT_LE(motion.options.step, 0.1);
    const Scene scene = Scene::prepare(motion.scene).value();
    const BodyDescription& body = motion.scene.bodies.front();
    const RigidBody rigid = make_rigid_body(scene.bodies().front(), scene.water()).value();
    if (body.added_mass) heaviest = std::max(heaviest, body.added_mass->matrix(0, 0) / rigid.mass);
  }
  EXPECT_GT(heaviest, 5.0);
  EXPECT_LE(heaviest, 50.0);
}

}  // namespace
}  // namespace buoyancy
