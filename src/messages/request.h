// Core types of a request and its response: the content of body_states_t and body_wrenches_t, without LCM.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace buoyancy {

struct BodyState {
  std::int32_t body_id = 0;
  std::array<double, 3> position{};          // [m], W frame
  std::array<double, 4> quaternion_wxyz{};   // q_WB
  std::array<double, 3> linear_velocity{};   // [m/s], W frame, velocity of B's origin
  std::array<double, 3> angular_velocity{};  // [rad/s], W frame
};

// Identifies a request; its response carries the same values.
struct RequestId {
  std::int64_t utime = 0;  // [us], the client's clock
  std::int64_t session_id = 0;
  std::int64_t seq = 0;
};

// What a request asks about: the bodies of a body_states_t or the points of a water_points_t.
enum class RequestKind : std::uint8_t { kBodies, kWaterPoints };

// Sessions are of one kind: requests of two kinds with the same session_id belong to two sessions.
struct SessionKey {
  std::int64_t id = 0;
  RequestKind kind = RequestKind::kBodies;

  // NOLINTNEXTLINE(google-explicit-constructor): most sessions are of bodies
  SessionKey(std::int64_t session_id, RequestKind of = RequestKind::kBodies) : id(session_id), kind(of) {}
  bool operator==(const SessionKey&) const = default;
};

// What the fixed fields of a request say.
struct RequestHeader {
  RequestKind kind = RequestKind::kBodies;
  RequestId id;
  double lead_time = 0.0;  // [s], of bodies
  std::size_t size = 0;    // number of bodies or points

  SessionKey session() const { return {id.session_id, kind}; }
};

struct WrenchRequest {
  RequestId id;
  double lead_time = 0.0;  // [s]
  std::vector<BodyState> bodies;
};

// A request whose bodies are stored by the caller, so that they need not be copied.
struct BorrowedRequest {
  RequestId id;
  double lead_time = 0.0;  // [s]
  std::span<const BodyState> bodies;

  BorrowedRequest(const RequestId& of, double lead, std::span<const BodyState> states)
      : id(of), lead_time(lead), bodies(states) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a request lends its bodies wherever they may be borrowed
  BorrowedRequest(const WrenchRequest& request)
      : id(request.id), lead_time(request.lead_time), bodies(request.bodies) {}
};

// The values equal the constants of body_wrench_t.lcm.
enum class BodyStatus : std::int32_t {
  kOk = 0,
  kUnknownBody = 1,
  kNonFinitePose = 2,
  kBadQuaternion = 3,
  kNonFiniteTwist = 4,
  kBadLeadTime = 5,
  kOpenEdgeWet = 6,
  kOutOfRange = 7,
  kNoSea = 8,
  kBadCondition = 9,
  kNotCertified = 10,
};
inline constexpr int kBodyStatusCount = 11;
// The constant's name in the message definition, such as "UNKNOWN_BODY"; "UNKNOWN_STATUS" for any other
// value.
const char* to_string(BodyStatus status);

struct BodyWrench {
  std::int32_t body_id = 0;
  BodyStatus status = BodyStatus::kOk;
  std::array<double, 3> force{};               // [N], W frame
  std::array<double, 3> torque{};              // [N m], W frame
  double submerged_volume = 0.0;               // [m^3]
  std::array<double, 3> center_of_buoyancy{};  // [m], W axes, relative to position
  double force_error_bound = 0.0;              // [N]
  double torque_error_bound = 0.0;             // [N m]
};

struct WrenchResponse {
  RequestId id;
  std::vector<BodyWrench> bodies;
};

}  // namespace buoyancy
