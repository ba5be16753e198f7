// Arrays of poses give the wrenches that the service's request handler gives, bit for bit.

#include "query/pose_evaluation.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "query/query_mesh.h"
#include "tests/query/pose_table.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026
constexpr double kNaNumber = std::numeric_limits<double>::quiet_NaN();

// Bodies of a rock: plain, an approximation, with drag and loads, one whose torque is about a corner, and one
// that is flooded and has a tank, drag and loads.
std::string bodies(const std::string& water) {
  const std::string rock = "shape = { type = \"rock\", frequency = 8, radius = 1.0, seed = 5 }\n";
  return water + "[[body]]\nid = 1\n" + rock +                      //
         "[[body]]\nid = 2\nmethod = \"exact_surface\"\n" + rock +  //
         "[[body]]\nid = 3\noutputs = [\"wrench\", \"loads\"]\n" + rock +
         "[body.drag]\nlinear = [20, 60, 60, 5, 5, 8]\n[body.added_mass]\nmatrix = [5, 126, 126, 1, 33, "
         "33]\n" +
         "[[body]]\nid = 4\nreference_point = [0.5, -0.5, 1]\n" + rock +
         "[[body]]\nid = 5\nreference_point = [0.2, 0.1, 0]\noutputs = [\"wrench\", \"loads\"]\n" + rock +
         "[[body.compartment]]\nshape = { type = \"box\", size = [0.5, 0.6, 0.7] }\nflooded = 0.7\n"
         "[[body.tank]]\nshape = { type = \"box\", size = [0.5, 0.4, 0.3] }\nposition = [0, 0.5, 0]\nfill = "
         "0.4\n"
         "[body.drag]\nlinear = [20, 60, 60, 5, 5, 8]\n";
}

const std::string kSea =
    "[water]\ndepth = 30\nwaves = { type = \"jonswap\", significant_wave_height = 0.5, peak_period = 4.0, "
    "frequencies = 40, "
    "seed = 3 }\n[water.current]\nvelocity = [0.3, -0.2, 0.1]\n";

struct Answer {
  WrenchResponse response;
  BodiesLoads loads;
};

// Asks about every pose in a request of its own, so that nothing of one is reused for the next.
Answer ask(RequestHandler& handler, const BodyState& state, std::int64_t utime) {
  static std::int64_t seq = 0;
  Answer answer;
  answer.response =
      decoded<WrenchResponse>(handler.handle(encoded(WrenchRequest{{utime, 1, ++seq}, 0.0, {state}})));
  if (!handler.last_loads().empty()) answer.loads = decoded<BodiesLoads>(handler.last_loads());
  return answer;
}

ByteVector bytes_of(const BodyLoads& loads) {
  return encoded(BodiesLoads{.id = {}, .bodies = {loads}});
}

TEST(PoseEvaluation, HasTheBitsOfTheServicesResponses) {
  for (const std::string& water : {std::string(), kSea}) {
    const Scene scene = scene_of(bodies(water));
    RequestHandler handler(scene);
    PoseTable poses = random_poses(200, 1.0, 7);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses.utimes.push_back(kNow + static_cast<std::int64_t>(i / 50) * 1'234'567);
    }
    for (const Body& body : scene.bodies()) {
      WrenchTable wrenches(poses.size());
      evaluate_poses(body, water_of(scene), poses.arrays(), wrenches.arrays());
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const Answer answer = ask(handler, poses.state(i, body.id), poses.utimes[i]);
        ASSERT_TRUE(equals(wrenches, i, answer.response.bodies[0])) << "body " << body.id << ", pose " << i;
      }
    }
  }
}

TEST(PoseEvaluation, GivesTheLoadsOfABody) {
  for (const std::string& water : {std::string(), kSea}) {
    const Scene scene = scene_of(bodies(water));
    RequestHandler handler(scene);
    PoseTable poses = random_poses(60, 1.0, 8);
    poses.utimes = {kNow};
    for (const std::int32_t id : {3, 5}) {
      WrenchTable wrenches(poses.size());
      std::vector<BodyLoads> loads(poses.size());
      evaluate_poses(*scene.find(id), water_of(scene), poses.arrays(), wrenches.arrays(), loads);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const Answer answer = ask(handler, poses.state(i, id), kNow);
        ASSERT_TRUE(equals(wrenches, i, answer.response.bodies[0])) << i;
        ASSERT_EQ(bytes_of(loads[i]), bytes_of(answer.loads.bodies.at(0))) << i;
      }
    }
  }
}

TEST(PoseEvaluation, DoesNotDependOnThreads) {
  for (const std::string& water : {std::string(), kSea}) {
    const Scene scene = scene_of(bodies(water));
    PoseTable poses = random_poses(3000, 1.0, 9);
    poses.utimes = {kNow};
    for (const Body& body : scene.bodies()) {
      WrenchTable expected(poses.size());
      evaluate_poses(body, water_of(scene), poses.arrays(), expected.arrays(), {}, 1);
      for (const unsigned threads : {0U, 2U, 3U}) {
        WrenchTable wrenches(poses.size());
        evaluate_poses(body, water_of(scene), poses.arrays(), wrenches.arrays(), {}, threads);
        EXPECT_EQ(wrenches, expected) << threads << " threads, body " << body.id;
      }
    }
  }
}

TEST(PoseEvaluation, ReportsPosesThatCannotBeEvaluated) {
  const Scene scene = scene_of(bodies(""));
  PoseTable poses = random_poses(20, 1.0, 10);
  poses.positions[3 * 2 + 1] = kNaNumber;
  poses.quaternions[4 * 5] += 0.1;
  poses.quaternions[4 * 7 + 3] = std::numeric_limits<double>::infinity();
  poses.linear_velocities[3 * 9] = kNaNumber;
  poses.positions[3 * 11 + 2] = -1e308;
  poses.positions[3 * 11] = 1e308;
  for (const std::int32_t id : {1, 3}) {
    const Body& body = *scene.find(id);
    RequestHandler handler(scene);
    WrenchTable wrenches(poses.size());
    evaluate_poses(body, water_of(scene), poses.arrays(), wrenches.arrays());
    const auto status = [&](std::size_t i) { return static_cast<BodyStatus>(wrenches.statuses[i]); };
    EXPECT_EQ(status(2), BodyStatus::kNonFinitePose);
    EXPECT_EQ(status(5), BodyStatus::kBadQuaternion);
    EXPECT_EQ(status(7), BodyStatus::kNonFinitePose);
    EXPECT_EQ(status(9), id == 3 ? BodyStatus::kNonFiniteTwist : BodyStatus::kOk);
    EXPECT_EQ(status(0), BodyStatus::kOk);
    EXPECT_EQ(wrenches.forces[3 * 5 + 2], 0.0);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_TRUE(equals(wrenches, i, ask(handler, poses.state(i, id), 0).response.bodies[0])) << i;
    }
  }
}

TEST(PoseEvaluation, KnowsNoSeaThatComesInMessages) {
  const Scene scene = scene_of(
      "[water]\nwaves = \"received\"\n[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1] }\n");
  const PoseTable poses = random_poses(3, 1.0, 11);
  WrenchTable wrenches(poses.size());
  evaluate_poses(scene.bodies()[0], water_of(scene), poses.arrays(), wrenches.arrays());
  EXPECT_EQ(wrenches.statuses, std::vector(3, static_cast<std::int32_t>(BodyStatus::kNoSea)));
}

TEST(PoseEvaluation, TakesNoPoses) {
  const Scene scene = scene_of(bodies(""));
  WrenchTable wrenches(0);
  evaluate_poses(scene.bodies()[0], water_of(scene), PoseTable{}.arrays(), wrenches.arrays(), {}, 0);
  EXPECT_TRUE(wrenches.statuses.empty());
}

TEST(PoseEvaluation, GivesTheHydrostaticsOfEachPose) {
  const Scene scene = scene_of(bodies(""));
  PoseTable poses = random_poses(300, 1.0, 12);
  poses.quaternions[4 * 5] += 0.1;
  for (const std::int32_t id : {4, 5}) {
    const Body& body = *scene.find(id);
    std::vector<BodyHydrostatics> results(poses.size());
    evaluate_hydrostatics(body, scene.water(), poses.arrays(), results, 2);
    WrenchTable wrenches(poses.size());
    evaluate_poses(body, water_of(scene), poses.arrays(), wrenches.arrays());
    ServiceCounters counters;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_EQ(static_cast<std::int32_t>(results[i].status), wrenches.statuses[i]);
      const ValidatedPose validated = validate_pose(poses.state(i, body.id), 0.0);
      const BodyHydrostatics expected =
          buoyancy::evaluate_hydrostatics(body, scene.water(), validated.pose, validated.status, counters);
      EXPECT_EQ(results[i].submerged_volume, expected.submerged_volume);
      EXPECT_EQ(results[i].stiffness, expected.stiffness);
    }
    EXPECT_EQ(results[5].status, BodyStatus::kBadQuaternion);
  }
}

}  // namespace
}  // namespace buoyancy
