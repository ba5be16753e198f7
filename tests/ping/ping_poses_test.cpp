#include "client/ping/ping_poses.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/body_evaluation.h"
#include "messages/conversions.h"
#include "tests/ping/two_scenes.h"

namespace buoyancy::ping {
namespace {

constexpr std::int64_t kRequests = 200;

bool same_bits(const BodyState& a, const BodyState& b) {
  return a.body_id == b.body_id && a.position == b.position && a.quaternion_wxyz == b.quaternion_wxyz &&
         a.linear_velocity == b.linear_velocity && a.angular_velocity == b.angular_velocity;
}

std::vector<BodyState> states_of(const Scene& scene, std::uint64_t seed, std::int64_t request) {
  std::vector<BodyState> states;
  make_states(scene, {scene.water().level, 0.0}, seed, request, states);
  return states;
}

TEST(PingPoses, DependOnSeedAndRequestAlone) {
  const Scene scene = SceneText{}.scene();
  const Scene again = SceneText{}.scene();
  std::set<double> heights;
  for (std::int64_t request = 0; request < kRequests; ++request) {
    const std::vector<BodyState> states = states_of(scene, 3, request);
    ASSERT_TRUE(std::ranges::equal(states, states_of(again, 3, request), same_bits));
    heights.insert(states[0].position[2]);
    ASSERT_FALSE(std::ranges::equal(states, states_of(scene, 4, request), same_bits));
  }
  EXPECT_EQ(heights.size(), static_cast<std::size_t>(kRequests));
}

// The heights of the corners of a bounding box are computed here in another way.
TEST(PingPoses, PlaceBoundingBoxesAsAnnounced) {
  SceneText text;
  text.up = "[0.6, 0, 0.8]";
  text.level = "-3.5";
  text.shape = R"(type = "cylinder", radius = 0.2, height = 4.0, segments = 16)";
  const Scene scene = text.scene();
  const WaterSurface surface{-3.5, 2.0};
  std::vector<BodyState> states;
  std::array<int, 3> seen{};
  for (std::int64_t request = 0; request < kRequests; ++request) {
    make_states(scene, surface, 1, request, states);
    for (std::size_t i = 0; i < states.size(); ++i) {
      const HydrostaticMesh& mesh = scene.bodies()[i].solver.mesh();
      const auto& [w, x, y, z] = states[i].quaternion_wxyz;
      const Eigen::Quaterniond q = Eigen::Quaterniond(w, x, y, z).normalized();
      double lowest = 1e300;
      double highest = -1e300;
      for (int corner = 0; corner < 8; ++corner) {
        Vec3 point_B = mesh.center_B + mesh.box_min;
        for (int axis = 0; axis < 3; ++axis) {
          if ((corner >> axis) % 2 == 1) point_B[axis] = mesh.center_B[axis] + mesh.box_max[axis];
        }
        const double height =
            scene.water().up_W.dot(q * point_B + to_vec3(states[i].position)) - surface.level;
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
      }
      const Immersion immersion = immersion_of(request, i);
      ++seen[static_cast<std::size_t>(immersion)];
      if (immersion == Immersion::kDry) {
        ASSERT_GT(lowest, surface.max_elevation);
      } else if (immersion == Immersion::kSubmerged) {
        ASSERT_LT(highest, -surface.max_elevation);
      } else {
        ASSERT_LT(lowest, 0.0);
        ASSERT_GT(highest, 0.0);
      }
    }
  }
  for (const int count : seen) EXPECT_GE(count, kRequests / 4);
}

TEST(PingPoses, IncludeQuaternionsThatServiceNormalises) {
  const Scene scene = SceneText{}.scene();
  int normalised = 0;
  for (std::int64_t request = 0; request < kRequests; ++request) {
    const std::vector<BodyState> states = states_of(scene, 1, request);
    ASSERT_EQ(states.size(), scene.bodies().size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      ASSERT_EQ(states[i].body_id, scene.bodies()[i].id);
      const ValidatedPose pose = validate_pose(states[i], 0.0);
      ASSERT_EQ(pose.status, BodyStatus::kOk);
      normalised += static_cast<int>(pose.quaternion_normalised);
      ASSERT_GT(to_vec3(states[i].linear_velocity).norm(), 0.0);
      ASSERT_GT(to_vec3(states[i].angular_velocity).norm(), 0.0);
    }
  }
  EXPECT_GT(normalised, kRequests / 4);
}

}  // namespace
}  // namespace buoyancy::ping
