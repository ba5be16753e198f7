// Compares the velocities that a simulator states with the motion of its bodies from one request to the next.
// Where they contradict each other, the simulator uses another frame, unit or order than body_state_t has.
//
// Two states of a body contradict each other if what the body moves between them, and what the two stated
// velocities or their mean would move it, differ by more than half of the larger one. A single contradiction
// means little: a body is placed elsewhere, or hits another. A finding needs kExplained contradictions in a
// row that one mistake explains, each within a fifth, or kUnexplained ones. Only a body frame, degrees and
// the order of a quaternion can be told from a vibration where requests are 0.1 s apart or more. Motion that
// is too slow to tell is passed over.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/vec3.h"
#include "messages/wire_views.h"
#include "scene/scene.h"

namespace buoyancy {

// A mistake that explains why stated velocities differ from the motion; the first one that does counts.
enum class MotionMistake : std::uint8_t {
  kQuaternionXyzw,  // the order of the quaternion; the velocity may be right
  kBodyFrame,
  kNorthEastDown,
  kDegrees,
  kZero,
  kScale,  // of the velocity or of utime; negative: the opposite direction
  kUnknown,
};

struct MotionFinding {
  std::int64_t session_id = 0;
  std::int32_t body_id = 0;
  bool is_angular = false;
  MotionMistake mistake = MotionMistake::kUnknown;
  Vec3 moved = Vec3::Zero();   // [m/s] or [rad/s], W: mean velocity between the last two requests
  Vec3 stated = Vec3::Zero();  // likewise: mean of the two stated ones
  int contradictions = 0;      // in a row; 0: found by start_in_xyzw()

  Warning warning() const;
};

// Finds a body of a session's first request that is where the scene file has it start, and whose quaternion
// would be the one of the file if its order were x, y, z, w. O(bodies).
std::optional<MotionFinding> start_in_xyzw(const RequestView& first, const Scene& scene);

// Checks the requests of one session. It follows a few bodies at a time, and the next ones once those agree,
// so that its cost does not depend on the number of bodies.
class MotionCheck {
 public:
  static constexpr int kExplained = 10;
  static constexpr int kUnexplained = 30;

  // Checks the session's first request with start_in_xyzw(), and compares each further one with the one
  // before it; nullptr if that is unknown. A body is compared if it has the same place in both. If all of a
  // body's velocities are 0, they count only where they are used: with a lead_time, and in scenes with drag
  // or added mass. The comparisons find at most one mistake of linear velocities and one of angular ones in a
  // session. O(bodies) at first, then O(1).
  std::optional<MotionFinding> check(const RequestView* before, const RequestView& now, const Scene& scene);

 private:
  static constexpr std::size_t kBodies = 4;  // that are followed at a time
  static constexpr int kPairsOfGroup = 64;   // before the next ones are followed

  // The contradictions in a row of one velocity of one body.
  struct Streak {
    int contradictions = 0;
    unsigned mistakes = 0;  // bits by MotionMistake: those that explain all of them
    double scale = 0.0;     // of the first one: moved over stated
  };
  // How a body moved, and what it stated.
  struct Pair;

  std::optional<MotionFinding> compare(const RequestView& before, const RequestView& now,
                                       bool uses_velocities);
  std::optional<MotionFinding> compare_body(std::size_t place, bool is_angular, const Pair& pair);
  void follow_next(std::size_t bodies);

  bool has_begun_ = false;
  std::size_t first_ = 0;                                 // place of the first body that is followed
  int pairs_ = 0;                                         // compared requests, since it is
  std::array<std::array<Streak, 2>, kBodies> streaks_{};  // of linear and angular velocity
  std::array<bool, 2> is_found_{};                        // likewise
};

// Checks the requests of many sessions, each in the order of its steps.
class MotionMonitor {
 public:
  static constexpr std::size_t kMaxSessions = 64;  // the least recently used one is evicted
  static constexpr std::size_t kMaxFindings = 64;

  // Ignores bytes that are no request. O(sessions + bytes).
  void add(Bytes request, const Scene& scene);
  const std::vector<MotionFinding>& findings() const { return findings_; }  // the first ones

 private:
  struct Session {
    std::int64_t id = 0;
    std::uint64_t used = 0;  // value of clock_ at the last use
    MotionCheck check;
    std::vector<std::uint8_t> last_request;
  };
  std::vector<Session> sessions_;
  std::uint64_t clock_ = 0;
  std::vector<MotionFinding> findings_;
};

}  // namespace buoyancy
