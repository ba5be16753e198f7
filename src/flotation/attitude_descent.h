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

  // Descends by a trust region over two angles, with the exact gradient and Hessian, and accepts a step only
  // if the energy falls. Where rounding hides the fall, it is taken from the gradient along the step, and a
  // step that climbs the side of a curved valley is led back to its bottom. On the way the body displaces its
  // mass only as accurately as the step needs; at the end, to rounding. The descent ends where the gradient
  // is zero to rounding and no curvature is negative. It leaves saddle points along their negative curvature
  // and keeps the other side of each for take_further_starts(). Returns nullopt at a known minimum, where an
  // open mesh takes in water on the way, and where nothing is found within 200 steps.
  std::optional<Minimum> minimum_from(const BalancedAttitude& start, const IsKnown& is_known);

  // Returns the stationary point of any kind that Newton's method on the gradient finds from a start, or
  // nullopt. A step is accepted only if the gradient shrinks.
  std::optional<Minimum> stationary_from(const BalancedAttitude& start) const;

  // Returns and clears the starts on the other sides of saddle points and ridges.
  std::vector<Vec3> take_further_starts();

 private:
  const Balance* balance_;
  std::vector<Vec3> further_starts_;
};

}  // namespace buoyancy
