#include "flotation/point_immersion.h"

#include <cmath>
#include <numbers>

namespace buoyancy {
namespace {

// The lowest of the points at a heel.
struct LowestPoint {
  RightingArm arm;
  std::size_t point = 0;
  double height = 0.0;  // [m], over the water

  bool is_wet() const { return height < 0.0; }
};

class ImmersionSearch {
 public:
  ImmersionSearch(const FloatingBody& body, const Water& water, std::span<const Vec3> points_B,
                  const RightingArmOptions& options)
      : body_(body), water_(water), points_B_(points_B), options_(options) {
    if (!options_.keel) options_.keel = 0.0;  // KN is not needed, so that its keel need not be found
  }

  std::optional<LowestPoint> at(double heel, double start_trim) const {
    const std::optional<RightingArm> arm = righting_arm(body_, water_, heel, options_, start_trim);
    if (!arm) return std::nullopt;
    const Vec3 up_B = up_at(options_.axes, {heel, arm->trim});
    LowestPoint lowest{.arm = *arm};
    for (std::size_t i = 0; i < points_B_.size(); ++i) {
      const double height = arm->height + up_B.dot(points_B_[i]);
      if (i > 0 && height >= lowest.height) continue;
      lowest.point = i;
      lowest.height = height;
    }
    return lowest;
  }

  // side: 1 starboard, -1 port.
  std::optional<PointImmersion> first(const LowestPoint& upright, double side) const {
    constexpr int kMaxHeel = 180;  // [degrees]
    LowestPoint dry = upright;
    for (int heel = 1; heel <= kMaxHeel; ++heel) {
      const std::optional<LowestPoint> next = at(side * heel * std::numbers::pi / kMaxHeel, dry.arm.trim);
      if (!next) return std::nullopt;
      if (next->is_wet()) return refined(dry, *next);
      dry = *next;
    }
    return std::nullopt;
  }

 private:
  // Bisects, since the lowest point and the trim may change within the step.
  PointImmersion refined(LowestPoint dry, LowestPoint wet) const {
    constexpr double kAccuracy = 1e-12;  // [rad]
    while (std::abs(wet.arm.heel - dry.arm.heel) > kAccuracy) {
      const std::optional<LowestPoint> middle = at(0.5 * (dry.arm.heel + wet.arm.heel), dry.arm.trim);
      if (!middle) break;
      (middle->is_wet() ? wet : dry) = *middle;
    }
    return {wet.arm.heel, wet.point};
  }

  const FloatingBody& body_;
  const Water& water_;
  std::span<const Vec3> points_B_;
  RightingArmOptions options_;
};

}  // namespace

FirstImmersions first_immersions(const FloatingBody& body, const Water& water, std::span<const Vec3> points_B,
                                 const RightingArmOptions& options) {
  const ImmersionSearch search(body, water, points_B, options);
  const std::optional<LowestPoint> upright = points_B.empty() ? std::nullopt : search.at(0.0, 0.0);
  if (!upright) return {};
  if (upright->is_wet()) {
    const PointImmersion now{0.0, upright->point};
    return {now, now};
  }
  return {search.first(*upright, 1.0), search.first(*upright, -1.0)};
}

}  // namespace buoyancy
