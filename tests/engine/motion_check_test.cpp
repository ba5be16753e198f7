#include "engine/motion_check.h"

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/box_scene.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

constexpr double kStep = 0.005;  // [s]

std::array<double, 3> to_array(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
Vec3 to_vec3(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

// A body that tumbles and swings, far from the origin and from upright.
struct Motion {
  Vec3 start, velocity, swing, angular_velocity;
  Eigen::Quaterniond q_WB;

  explicit Motion(RandomPoses& random)
      : start(100.0 * random.direction()),
        velocity(random.vector(0.5, 3.0)),
        swing(random.vector(0.1, 0.5)),
        angular_velocity(random.vector(0.5, 3.0)),
        q_WB(Eigen::AngleAxisd{random.uniform(1.0, 3.0), random.direction()}) {}

  BodyState at(double t) const {
    const Eigen::Quaterniond q =
        Eigen::AngleAxisd(angular_velocity.norm() * t, angular_velocity.normalized()) * q_WB;
    return {.body_id = 7,
            .position = to_array(start + velocity * t + swing * std::sin(2.0 * t)),
            .quaternion_wxyz = {q.w(), q.x(), q.y(), q.z()},
            .linear_velocity = to_array(velocity + 2.0 * swing * std::cos(2.0 * t)),
            .angular_velocity = to_array(angular_velocity)};
  }
};

using Change = std::function<void(BodyState&, int step)>;

// The findings about a motion of which every state is changed.
std::vector<MotionFinding> findings(const Motion& motion, int steps, const Change& change,
                                    bool uses_velocities = false, double interval = kStep, int bodies = 1) {
  MotionCheck check;
  std::vector<MotionFinding> found;
  std::array<ByteVector, 2> bytes;
  for (int step = 0; step <= steps; ++step) {
    WrenchRequest request;
    request.id = {
        .utime = 1'000'000'000'000 + std::llround(step * interval * 1e6), .session_id = 5, .seq = step};
    if (uses_velocities) request.lead_time = 1.0;
    for (int body = 0; body < bodies; ++body) {
      request.bodies.push_back(motion.at(step * interval));
      request.bodies.back().body_id += body;
      change(request.bodies.back(), step);
    }
    encode(request, bytes.at(step % 2));
    const auto now = RequestView::of(bytes.at(step % 2));
    const auto before = RequestView::of(bytes.at((step + 1) % 2));
    const auto finding = check.check(step == 0 ? nullptr : &*before, *now, shared_box_scene());
    if (finding) found.push_back(*finding);
  }
  return found;
}

Eigen::Quaterniond quaternion_of(const BodyState& state) {
  const auto& q = state.quaternion_wxyz;
  return {q[0], q[1], q[2], q[3]};
}

struct Mistake {
  std::string name;
  MotionMistake mistake;
  bool is_linear, is_angular;
  Change change;
};

const std::vector<Mistake>& mistakes() {
  static const std::vector<Mistake> all{
      {"body frame", MotionMistake::kBodyFrame, true, true,
       [](BodyState& state, int) {
         const Eigen::Quaterniond q_BW = quaternion_of(state).conjugate();
         state.linear_velocity = to_array(q_BW * to_vec3(state.linear_velocity));
         state.angular_velocity = to_array(q_BW * to_vec3(state.angular_velocity));
       }},
      {"order of the quaternion", MotionMistake::kQuaternionXyzw, false, true,
       [](BodyState& state, int) {
         const auto [w, x, y, z] = state.quaternion_wxyz;
         state.quaternion_wxyz = {x, y, z, w};
       }},
      {"degrees", MotionMistake::kDegrees, false, true,
       [](BodyState& state, int) {
         for (double& component : state.angular_velocity) component *= 180.0 / M_PI;
       }},
      {"north, east, down", MotionMistake::kNorthEastDown, true, false,
       [](BodyState& state, int) {
         const auto [x, y, z] = state.linear_velocity;
         state.linear_velocity = {y, x, -z};
       }},
      {"millimetres", MotionMistake::kScale, true, false,
       [](BodyState& state, int) {
         for (double& component : state.linear_velocity) component *= 1000.0;
       }},
      {"half the angular velocity", MotionMistake::kScale, false, true,
       [](BodyState& state, int) {
         for (double& component : state.angular_velocity) component *= 0.4;
       }},
      {"no angular velocity", MotionMistake::kZero, false, true,
       [](BodyState& state, int) { state.angular_velocity = {}; }},
  };
  return all;
}

TEST(MotionCheck, NamesTheMistakeThatExplainsContradictions) {
  RandomPoses random(3);
  for (int i = 0; i < 100; ++i) {
    const Motion motion(random);
    for (const Mistake& mistake : mistakes()) {
      const std::vector<MotionFinding> found = findings(motion, 2 * MotionCheck::kExplained, mistake.change);
      bool has_linear = false, has_angular = false;
      for (const MotionFinding& finding : found) {
        (finding.is_angular ? has_angular : has_linear) = true;
        EXPECT_EQ(finding.mistake, mistake.mistake) << mistake.name << ", " << i;
        EXPECT_EQ(finding.contradictions, MotionCheck::kExplained) << mistake.name << ", " << i;
        EXPECT_EQ(finding.session_id, 5);
        EXPECT_EQ(finding.body_id, 7);
      }
      // A turn about an axis that the mistake leaves where it is contradicts nothing.
      if (mistake.mistake == MotionMistake::kScale || mistake.mistake == MotionMistake::kDegrees ||
          mistake.mistake == MotionMistake::kZero) {
        EXPECT_EQ(has_linear, mistake.is_linear) << mistake.name << ", " << i;
        EXPECT_EQ(has_angular, mistake.is_angular) << mistake.name << ", " << i;
      }
      EXPECT_LE(has_linear, mistake.is_linear) << mistake.name << ", " << i;
      EXPECT_LE(has_angular, mistake.is_angular) << mistake.name << ", " << i;
    }
  }
}

TEST(MotionCheck, FindsMostOtherFrames) {
  RandomPoses random(4);
  int found = 0;
  constexpr int kMotions = 200;
  for (int i = 0; i < kMotions; ++i) {
    found += static_cast<int>(findings(Motion(random), 40, mistakes()[0].change).size());
    found += static_cast<int>(findings(Motion(random), 40, mistakes()[1].change).size());
  }
  EXPECT_GT(found, 5 * kMotions / 2) << "of three velocities of each motion";
}

TEST(MotionCheck, AcceptsTheMotionAsItIs) {
  RandomPoses random(5);
  for (int i = 0; i < 100; ++i) {
    const Motion motion(random);
    EXPECT_TRUE(findings(
                    motion, 200, [](BodyState&, int) {}, true)
                    .empty())
        << i;
    // Every tenth state is somewhere else, and every seventh at another velocity.
    const Change jumps = [](BodyState& state, int step) {
      if (step % 10 < 2) state.position[0] += 10.0 * step;
      if (step % 7 == 0) state.angular_velocity = {9.0, -9.0, 9.0};
    };
    EXPECT_TRUE(findings(motion, 200, jumps, true).empty()) << i;
    // A vibration that is sampled about once in a period.
    const double period = random.uniform(0.1, 1.0);
    const Change other = [&motion, period](BodyState& state, int step) {
      const double w = 2.0 * M_PI / period, t = step * 0.3;
      state.position = to_array(motion.start + motion.swing * std::sin(w * t));
      state.linear_velocity = to_array(motion.swing * w * std::cos(w * t));
    };
    for (const MotionFinding& finding : findings(motion, 200, other, true, 0.3))
      ADD_FAILURE() << finding.warning().message();
  }
}

TEST(MotionCheck, TakesVelocitiesThatNobodyUsesAsNotSet) {
  RandomPoses random(6);
  const Motion motion(random);
  const Change none = [](BodyState& state, int) { state.linear_velocity = state.angular_velocity = {}; };
  EXPECT_TRUE(findings(motion, 200, none, false).empty());
  const std::vector<MotionFinding> found = findings(motion, 200, none, true);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].mistake, MotionMistake::kZero);
  EXPECT_EQ(found[1].mistake, MotionMistake::kZero);
}

TEST(MotionCheck, NeedsThreeTimesAsManyContradictionsWithoutAnExplanation) {
  RandomPoses random(7);
  const Motion motion(random);
  const Change unlike = [](BodyState& state, int step) {
    state.linear_velocity = {5.0 * std::sin(1.7 * step), 5.0 * std::cos(2.9 * step), 5.0};
  };
  EXPECT_TRUE(findings(motion, MotionCheck::kUnexplained - 1, unlike).empty());
  const std::vector<MotionFinding> found = findings(motion, 10 * MotionCheck::kUnexplained, unlike);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].mistake, MotionMistake::kUnknown);
  EXPECT_GE(found[0].contradictions, MotionCheck::kUnexplained);
}

TEST(MotionCheck, PassesOverMotionThatIsTooSlowToTell) {
  RandomPoses random(8);
  Motion motion(random);
  motion.velocity *= 1e-3;
  motion.swing *= 1e-3;
  motion.angular_velocity *= 1e-3;
  for (const Mistake& mistake : mistakes()) {
    if (mistake.mistake == MotionMistake::kScale || mistake.mistake == MotionMistake::kDegrees) continue;
    EXPECT_TRUE(findings(motion, 200, mistake.change, true).empty()) << mistake.name;
  }
  // Single precision at 100 m: the position stands still for several steps, and jumps.
  const Change rounded = [](BodyState& state, int) {
    for (double& component : state.position) component = static_cast<float>(component);
  };
  motion.velocity *= 20.0;
  EXPECT_TRUE(findings(motion, 1000, rounded, true, 1e-4).empty());
}

TEST(MotionCheck, PassesOverStatesThatAreNoNumbers) {
  RandomPoses random(9);
  for (const double value : {std::nan(""), HUGE_VAL, 1e308, -1e308}) {
    const Change spoilt = [value](BodyState& state, int step) {
      state.position[step % 3] = value;
      state.quaternion_wxyz[step % 4] = value;
    };
    EXPECT_TRUE(findings(Motion(random), 100, spoilt, true).empty()) << value;
    const Change unknown = [value](BodyState& state, int) {
      state.linear_velocity.fill(value);
      state.angular_velocity.fill(value);
    };
    if (std::isfinite(value)) continue;
    EXPECT_TRUE(findings(Motion(random), 100, unknown, true).empty()) << value;
  }
}

TEST(MotionCheck, ReachesEveryBodyOfALargeRequest) {
  RandomPoses random(10);
  const Motion motion(random);
  const Change one_is_wrong = [](BodyState& state, int step) {
    if (state.body_id == 7 + 37) mistakes()[4].change(state, step);
  };
  const std::vector<MotionFinding> found = findings(motion, 1000, one_is_wrong, false, kStep, 40);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].body_id, 7 + 37);
}

TEST(MotionCheck, SaysWhatContradictsWhatAndWhy) {
  const MotionFinding finding{.session_id = 5,
                              .body_id = 7,
                              .is_angular = true,
                              .mistake = MotionMistake::kQuaternionXyzw,
                              .moved = {0.0, 0.0, -1.0},
                              .stated = {1.0, 0.0, 0.0},
                              .contradictions = 10};
  EXPECT_EQ(finding.warning().message(),
            "session 5, body 7: angular_velocity = 1, 0, 0 rad/s where the body turns by 0, 0, -1 rad/s, 10 "
            "requests in "
            "a row; expected the velocity of its motion, in the world frame. Likely cause: the quaternion "
            "has the order "
            "x, y, z, w. Send w, x, y, z.");
}

}  // namespace
}  // namespace buoyancy
