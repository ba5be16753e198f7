// States of a body that get a status and zeros instead of a wrench.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/engine/box_scene.h"

namespace buoyancy {

struct InvalidState {
  std::string name;
  BodyState state;
  double lead_time;
  BodyStatus status;
};

inline std::vector<InvalidState> invalid_states() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
  constexpr double kLargest = std::numeric_limits<double>::max();
  using S = BodyStatus;
  std::vector<InvalidState> list;
  const auto add = [&list](const std::string& name, S expected, double lead_time, const auto& corrupt) {
    list.push_back({name, upright(kBox, 0.0), lead_time, expected});
    corrupt(list.back().state);
  };
  for (const std::int32_t id :
       {kNoBody, 0, -1, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()}) {
    add("id " + std::to_string(id), S::kUnknownBody, 0.0, [=](BodyState& s) { s.body_id = id; });
  }
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    const auto named = [&](const char* what) { return std::to_string(value) + " in " + what; };
    for (std::size_t i = 0; i < 3; ++i) {
      add(named("position"), S::kNonFinitePose, 0.0, [=](BodyState& s) { s.position[i] = value; });
      for (const double lead_time : {0.01, -0.01, kDenormal}) {
        add(named("velocity"), S::kNonFiniteTwist, lead_time,
            [=](BodyState& s) { s.linear_velocity[i] = value; });
        add(named("spin"), S::kNonFiniteTwist, lead_time,
            [=](BodyState& s) { s.angular_velocity[i] = value; });
      }
    }
    for (std::size_t i = 0; i < 4; ++i)
      add(named("quaternion"), S::kNonFinitePose, 0.0, [=](BodyState& s) { s.quaternion_wxyz[i] = value; });
    add(named("lead time"), S::kBadLeadTime, value, [](BodyState&) {});
  }
  const std::vector<std::pair<const char*, std::array<double, 4>>> quaternions{
      {"zeros", {0, 0, 0, 0}},
      {"minus zeros", {-0.0, -0.0, -0.0, -0.0}},
      {"denormals", {kDenormal, kDenormal, 0, 0}},
      {"squares that underflow", {1e-200, 0, 0, 0}},
      {"squares that overflow", {1e200, 1e200, 0, 0}},
      {"the largest", {kLargest, kLargest, kLargest, kLargest}},
      {"degrees", {0, 0, 0, 90}},
      {"too long", {1.0011, 0, 0, 0}},
      {"too short", {0, 0, 0.9989, 0}}};
  for (const auto& [name, quaternion] : quaternions) {
    add(name, S::kBadQuaternion, 0.0, [q = quaternion](BodyState& s) { s.quaternion_wxyz = q; });
  }
  for (const double norm : {0.5, 1.0 - 1.1e-3, 1.0 + 1.1e-3, 2.0, 1e200, kLargest}) {
    add("a norm of " + std::to_string(norm), S::kBadQuaternion, 0.0, [=](BodyState& s) {
      s.quaternion_wxyz = {0.6 * norm, 0, 0.8 * norm, 0};
    });
  }
  add("a velocity that leads too far", S::kOutOfRange, 2.0,
      [](BodyState& s) { s.linear_velocity[0] = kLargest; });
  add("a spin that leads too far", S::kOutOfRange, -2.0,
      [](BodyState& s) { s.angular_velocity[1] = kLargest; });
  add("too long a lead time", S::kOutOfRange, kLargest, [](BodyState& s) { s.linear_velocity[2] = 2.0; });
  return list;
}

}  // namespace buoyancy
