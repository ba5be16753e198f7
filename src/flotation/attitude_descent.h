// Minimises the energy of a floating body over its attitudes, from one start.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "flotation/balance.h"

namespace buoyancy {

struct Minimum {
  BalancedAttitude attitude;
  EnergyCurvature curvature;
};

// Returns true where the descent may end, since it approaches a minimum that is known already. target: the
// attitude that the model of the energy predicts, at a distance of `step` [rad]; step < 0: there is none.
using IsKnown = std::function<bool(const BalancedAttitude& at, const Vec3& target_B, double step)>;

class AttitudeDescent {
 public:
  explicit AttitudeDescent(const Balance& balance) : balance_(&balance) {}

  // Descends by a trust region over two angles, with the exact gradient and Hessian; a step is accepted only
  // if the energy falls. Where rounding hides the fall, it is that of the gradient along the step, and a step
  // that climbs the side of a curved valley is led back to its bottom. On the way the body displaces its mass
  // only as nearly as the step needs; at the end, to rounding. Ends where the gradient is zero to rounding
  // and no curvature is negative. Saddle points are left along their negative curvature; the other side of
  // each is added to further_starts(). Returns nullopt at a known minimum, where an open mesh takes in water
  // along the way, and where nothing is found within 200 steps.
  std::optional<Minimum> minimum_from(const BalancedAttitude& start, const IsKnown& is_known);

  // The stationary point of any kind that Newton's method on the gradient finds from a start: a step is
  // accepted only if the gradient shrinks. nullopt: none.
  std::optional<Minimum> stationary_from(const BalancedAttitude& start) const;

  // Starts on the other sides of saddle points and ridges; cleared by the call.
  std::vector<Vec3> take_further_starts();

 private:
  const Balance* balance_;
  std::vector<Vec3> further_starts_;
};

}  // namespace buoyancy
