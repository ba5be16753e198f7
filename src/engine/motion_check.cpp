#include "engine/motion_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "base/angles.h"
#include "base/format.h"

namespace buoyancy {
namespace {

constexpr double kSlow = 0.01;             // [m/s] or [rad/s]
constexpr double kDisagreement = 0.5;      // of the larger of two displacements
constexpr double kAgreement = 0.2;         // likewise
constexpr double kShortInterval = 0.0999;  // [s]
constexpr double kSinglePrecision = 1e-6;  // relative: smaller changes may be rounding to float32
constexpr double kMicrosecondsPerSecond = 1e6;

constexpr unsigned bit(MotionMistake mistake) {
  return 1U << static_cast<unsigned>(mistake);
}

Vec3 to_vec3(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

Eigen::Quaterniond read_wxyz(const std::array<double, 4>& q) {
  return {q[0], q[1], q[2], q[3]};
}

Eigen::Quaterniond read_xyzw(const std::array<double, 4>& q) {
  return {q[3], q[0], q[1], q[2]};
}

// Returns the rotation vector [rad] of a small turn; its error is a twentieth at 1 rad.
Vec3 rotation_between(const Eigen::Quaterniond& before, const Eigen::Quaterniond& now) {
  const Eigen::Quaterniond turn = now * before.conjugate();
  return std::copysign(2.0, turn.w()) * turn.vec();
}

bool is_within(double share, const Vec3& a, const Vec3& b) {
  return (a - b).squaredNorm() <= share * share * std::max(a.squaredNorm(), b.squaredNorm());
}

// Returns the likely cause, and what to do.
std::pair<const char*, const char*> explain(const MotionFinding& finding) {
  switch (finding.mistake) {
    case MotionMistake::kQuaternionXyzw:
      return {"the quaternion has the order x, y, z, w", "Send w, x, y, z"};
    case MotionMistake::kBodyFrame:
      return {"the velocity is in the body's frame",
              "Turn it into the world frame with the body's quaternion"};
    case MotionMistake::kNorthEastDown:
      return {"the velocity is in north, east, down, or points the other way, and the position is not",
              "Use the axes of the scene for both"};
    case MotionMistake::kDegrees:
      return {"the velocity is in degrees per second", "Send radians per second"};
    case MotionMistake::kZero:
      return {"the simulator does not set the velocity", "Send it: loads depend on it"};
    case MotionMistake::kScale:
      return {
          "another unit of the velocity, the opposite sign, or a utime that is not the simulation's time "
          "in microseconds",
          "Compare them with body_state_t"};
    case MotionMistake::kUnknown:
      break;
  }
  return {"the velocity is in another frame or of another point than the body's origin",
          "Compare it with body_state_t"};
}

}  // namespace

struct MotionCheck::Pair {
  double interval = 0.0;  // [s], > 0
  BodyState before, now;
  Vec3 moved = Vec3::Zero();  // [m] or [rad], W
  double resolution = 0.0;    // [m] or [rad]: a smaller motion says nothing
  Vec3 stated_before = Vec3::Zero(), stated_now = Vec3::Zero();  // [m/s] or [rad/s]

  Vec3 stated() const { return 0.5 * interval * (stated_before + stated_now); }

  bool is_telling() const {
    const double a = moved.norm(), b = stated().norm();
    const double size = std::max(a, b);
    return std::isfinite(a) && std::isfinite(b) && size > kSlow * interval && size > resolution;
  }
  bool is_contradiction() const {
    return !is_within(kDisagreement, moved, stated()) &&
           !is_within(kDisagreement, moved, interval * stated_before) &&
           !is_within(kDisagreement, moved, interval * stated_now);
  }
};

Warning MotionFinding::warning() const {
  const std::string unit = is_angular ? " rad/s" : " m/s";
  const auto [cause, hint] = explain(*this);
  const std::string subject = "session " + std::to_string(session_id) + ", body " + std::to_string(body_id);
  if (contradictions == 0) {
    return {subject, "it starts where the scene file says, but turned", "the orientation of the scene file",
            cause, hint};
  }
  return {subject,
          (is_angular ? "angular_velocity = " : "linear_velocity = ") + format_vector(stated, 3) + unit +
              " where the body " + (is_angular ? "turns by " : "moves by ") + format_vector(moved, 3) + unit +
              ", " + std::to_string(contradictions) + " requests in a row",
          "the velocity of its motion, in the world frame", cause, hint};
}

std::optional<MotionFinding> start_in_xyzw(const RequestView& first, const Scene& scene) {
  constexpr double kSamePlace = 1e-6;  // [m], and relative
  constexpr double kSameTurn = 1e-6;   // of 1 - |cos(angle / 2)|
  constexpr double kOtherTurn = 1e-3;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const BodyState state = first.body(i);
    const std::optional<std::size_t> index = scene.index_of(state.body_id, i);
    if (!index) continue;
    const DynamicsSpec& start = scene.bodies()[*index].dynamics;
    const double distance = (to_vec3(state.position) - start.position).norm();
    if (start.start != StartKind::kPose || !(distance <= kSamePlace * (1.0 + start.position.norm())))
      continue;
    const auto turn = [&start](const Eigen::Quaterniond& q) {
      return 1.0 - std::abs(q.dot(start.orientation));
    };
    if (!(std::abs(turn(read_xyzw(state.quaternion_wxyz))) <= kSameTurn)) continue;
    if (turn(read_wxyz(state.quaternion_wxyz)) <= kOtherTurn) continue;
    return MotionFinding{.session_id = first.id().session_id,
                         .body_id = state.body_id,
                         .is_angular = true,
                         .mistake = MotionMistake::kQuaternionXyzw};
  }
  return std::nullopt;
}

std::optional<MotionFinding> MotionCheck::check(const RequestView* before, const RequestView& now,
                                                const Scene& scene) {
  if (!std::exchange(has_begun_, true)) return start_in_xyzw(now, scene);
  if (before == nullptr) return std::nullopt;
  return compare(*before, now, scene.bodies_with_hydrodynamics() > 0 || now.lead_time() != 0.0);
}

std::optional<MotionFinding> MotionCheck::compare(const RequestView& before, const RequestView& now,
                                                  bool uses_velocities) {
  const double interval =
      (static_cast<double>(now.id().utime) - static_cast<double>(before.id().utime)) / kMicrosecondsPerSecond;
  if (interval <= 0.0 || (is_found_[0] && is_found_[1])) return std::nullopt;
  std::optional<MotionFinding> finding;
  const std::size_t bodies = std::min(before.size(), now.size());
  for (std::size_t place = 0; place < kBodies && first_ + place < bodies && !finding; ++place) {
    Pair pair;
    pair.interval = interval;
    pair.before = before.body(first_ + place);
    pair.now = now.body(first_ + place);
    const BodyState &a = pair.before, &b = pair.now;
    if (a.body_id != b.body_id) continue;
    const bool is_zero = a.linear_velocity == b.linear_velocity && a.angular_velocity == b.angular_velocity &&
                         to_vec3(a.linear_velocity).isZero(0.0) && to_vec3(a.angular_velocity).isZero(0.0);
    if (is_zero && !uses_velocities) continue;
    pair.moved = to_vec3(b.position) - to_vec3(a.position);
    pair.resolution = kSinglePrecision * to_vec3(b.position).norm();
    pair.stated_before = to_vec3(a.linear_velocity);
    pair.stated_now = to_vec3(b.linear_velocity);
    finding = compare_body(place, false, pair);
    if (finding) break;
    pair.moved = rotation_between(read_wxyz(a.quaternion_wxyz), read_wxyz(b.quaternion_wxyz));
    pair.resolution = kSinglePrecision;
    pair.stated_before = to_vec3(a.angular_velocity);
    pair.stated_now = to_vec3(b.angular_velocity);
    finding = compare_body(place, true, pair);
  }
  if (finding) finding->session_id = now.id().session_id;
  follow_next(bodies);
  return finding;
}

std::optional<MotionFinding> MotionCheck::compare_body(std::size_t place, bool is_angular, const Pair& pair) {
  const auto kind = static_cast<std::size_t>(is_angular);
  if (is_found_[kind] || !pair.is_telling()) return std::nullopt;
  Streak& streak = streaks_[place][kind];
  if (!pair.is_contradiction()) {
    streak = {};
    return std::nullopt;
  }
  const Vec3 stated = pair.stated();
  unsigned mistakes = 0;
  const auto add_if = [&mistakes](bool explains, MotionMistake mistake) {
    if (explains) mistakes |= bit(mistake);
  };
  const auto explains = [&pair](const Vec3& right) { return is_within(kAgreement, pair.moved, right); };
  const double scale = pair.moved.dot(stated) / stated.squaredNorm();  // NaN: nothing is stated
  if (streak.contradictions == 0) streak.scale = scale;
  if (is_angular) {
    const Vec3 rotation_xyzw =
        rotation_between(read_xyzw(pair.before.quaternion_wxyz), read_xyzw(pair.now.quaternion_wxyz));
    add_if(is_within(kAgreement, rotation_xyzw, stated), MotionMistake::kQuaternionXyzw);
    add_if(explains(kRadiansPerDegree * stated), MotionMistake::kDegrees);
  }
  add_if(explains(read_wxyz(pair.now.quaternion_wxyz) * stated), MotionMistake::kBodyFrame);
  add_if(explains({stated.y(), stated.x(), -stated.z()}), MotionMistake::kNorthEastDown);
  add_if(stated.isZero(0.0), MotionMistake::kZero);
  add_if(scale != 0.0 && explains(streak.scale * stated), MotionMistake::kScale);
  // A vibration that is sampled once or twice per period looks like one of the other mistakes.
  constexpr unsigned kUnmistakable =
      bit(MotionMistake::kQuaternionXyzw) | bit(MotionMistake::kBodyFrame) | bit(MotionMistake::kDegrees);
  if ((mistakes & kUnmistakable) == 0 && pair.interval > kShortInterval) return std::nullopt;

  streak.mistakes = streak.contradictions == 0 ? mistakes : streak.mistakes & mistakes;
  ++streak.contradictions;
  if (streak.contradictions < (streak.mistakes != 0 ? kExplained : kUnexplained)) return std::nullopt;
  const Streak found = std::exchange(streak, {});
  is_found_[kind] = true;
  auto mistake = MotionMistake::kQuaternionXyzw;
  while (mistake != MotionMistake::kUnknown && (found.mistakes & bit(mistake)) == 0) {
    mistake = static_cast<MotionMistake>(static_cast<unsigned>(mistake) + 1);
  }
  return MotionFinding{.body_id = pair.now.body_id,
                       .is_angular = is_angular,
                       .mistake = mistake,
                       .moved = pair.moved / pair.interval,
                       .stated = stated / pair.interval,
                       .contradictions = found.contradictions};
}

void MotionCheck::follow_next(std::size_t bodies) {
  if (++pairs_ < kPairsOfGroup || bodies <= kBodies) return;
  const bool is_suspicious = std::ranges::any_of(streaks_, [](const auto& streaks) {
    return streaks[0].contradictions + streaks[1].contradictions > 0;
  });
  if (is_suspicious) return;
  first_ = first_ + kBodies < bodies ? first_ + kBodies : 0;
  pairs_ = 0;
}

void MotionMonitor::add(Bytes bytes, const Scene& scene) {
  const auto request = RequestView::of(bytes);
  if (!request) return;
  const std::int64_t id = request->id().session_id;
  auto session = std::ranges::find(sessions_, id, &Session::id);
  const bool is_new = session == sessions_.end();
  if (is_new && sessions_.size() < kMaxSessions) {
    session = sessions_.insert(sessions_.end(), Session{});
  } else if (is_new) {
    session = std::ranges::min_element(sessions_, {}, &Session::used);
    session->check = {};
  }
  session->id = id;
  session->used = ++clock_;
  const auto before = RequestView::of(session->last_request);
  const auto finding = session->check.check(is_new || !before ? nullptr : &*before, *request, scene);
  if (finding && findings_.size() < kMaxFindings) findings_.push_back(*finding);
  session->last_request.assign(bytes.begin(), bytes.end());
}

}  // namespace buoyancy
