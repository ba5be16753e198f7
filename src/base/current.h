// The current of the water beside the waves: the same everywhere, or a profile over the height.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/vec3.h"
#include "base/water.h"

namespace buoyancy {

struct CurrentPoint {
  double height = 0.0;             // [m], over the level of the water
  Vec3 velocity_W = Vec3::Zero();  // [m/s]

  bool operator==(const CurrentPoint&) const = default;
};

inline constexpr std::size_t kMaxCurrentPoints = 16;

// From the top down: heights fall. Between two heights the velocity is linear, and beyond the first and the
// last it is constant.
using CurrentProfile = std::vector<CurrentPoint>;  // at most kMaxCurrentPoints

// Precondition: the profile has a point. Complexity: O(points).
inline Vec3 velocity_at(const CurrentProfile& profile, double height) {
  const auto lower = std::find_if(profile.begin(), profile.end(),
                                  [height](const CurrentPoint& point) { return point.height <= height; });
  if (lower == profile.begin()) return profile.front().velocity_W;
  if (lower == profile.end()) return profile.back().velocity_W;
  const CurrentPoint& upper = *(lower - 1);
  const double share = (height - lower->height) / (upper.height - lower->height);
  return lower->velocity_W + share * (upper.velocity_W - lower->velocity_W);
}

struct Current {
  Vec3 velocity_W = Vec3::Zero();  // [m/s], at the level: it carries the waves
  CurrentProfile profile{};        // empty: velocity_W everywhere

  bool operator==(const Current&) const = default;

  // [m/s], at a point of this water.
  Vec3 at(const Water& water, const Vec3& p_W) const {
    return profile.empty() ? velocity_W : velocity_at(profile, water.up_W.dot(p_W) - water.level);
  }

  // [m/s], the largest at any height.
  double max_speed() const {
    double speed = velocity_W.norm();
    for (const CurrentPoint& point : profile) speed = std::max(speed, point.velocity_W.norm());
    return speed;
  }
};

}  // namespace buoyancy
