// The heels at which points of a body go under water: the immersion of the deck edge, and downflooding where
// the points are openings that let water in.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "flotation/righting_arms.h"

namespace buoyancy {

struct PointImmersion {
  double heel = 0.0;      // [rad], below 0 to port
  std::size_t point = 0;  // the first that goes under
};

// nullopt: no point goes under to this side, or righting_arm() has no result before one does.
struct FirstImmersions {
  std::optional<PointImmersion> starboard, port;
};

// Returns the smallest heels to either side at which one of the points is under water. The attitudes are
// those of righting_arm(): the body displaces its mass and trims as the options say. points_B: [m], finite. A
// point that is under water upright has heel 0. Heels are searched in steps of one degree, which may miss a
// point that is under water for less, and are refined to 1e-12 rad. Complexity: up to 360 righting arms.
FirstImmersions first_immersions(const FloatingBody& body, const Water& water, std::span<const Vec3> points_B,
                                 const RightingArmOptions& options = {});

}  // namespace buoyancy
