// Righting arms: the lever of the couple of buoyancy and weight that turns a heeled body back.
//
// At each heel the body displaces its mass, and the trim is free, so that no moment about the transverse axis
// is left, or fixed. Of the trims that balance, the one of a minimum of the energy near the start is taken. A
// short body may have none: then it is the nearest trim that balances, which the body would not keep.
// Axes and angles are those of ship_axes.h: heel is positive to starboard, GZ is positive where it turns the
// body back to port. With C the centre of buoyancy, G that of mass, K the keel on the centre plane (where the
// port coordinate is 0) and s the horizontal direction to starboard,
//   GZ = (C - G) . s,   KN = (C - K) . s.
// The area under the curve is that from heel 0. It is the difference of the energy, divided by the weight,
// and so exact to rounding for every step of the heel; the part that a free trim adds is a trapezoidal sum.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <tl/expected.hpp>

#include "flotation/floating_body.h"
#include "flotation/ship_axes.h"

namespace buoyancy {

struct RightingArmOptions {
  ShipAxes axes{};
  std::optional<double> fixed_trim;  // [rad]; nullopt: free
  std::optional<double> keel;  // [m], of K along up from B's origin; nullopt: the lowest vertex along up
  // Called after each heel of a curve with the number of heels that are done and of all; may be empty.
  std::function<void(std::int64_t done, std::int64_t total)> progress;
};

struct RightingArm {
  double heel = 0.0;    // [rad]
  double trim = 0.0;    // [rad]
  double draft = 0.0;   // [m], depth of the lowest vertex
  double gz = 0.0;      // [m]
  double kn = 0.0;      // [m]
  double energy = 0.0;  // [J], as FloatingState::energy
  double height = 0.0;  // [m], of B's origin over the water
};

// start_trim: [rad], where the search for the trim starts. Returns nullopt where the body does not float at
// this heel (FlotationOutcome), and where no trim below 89 degrees balances. A pure function: heels may be
// computed in parallel. Complexity: about five rounds of three displacements, and lowest_along() for the
// draft.
std::optional<RightingArm> righting_arm(const FloatingBody& body, const Water& water, double heel,
                                        const RightingArmOptions& options = {}, double start_trim = 0.0);

// Returns the arm at which GZ is `lever` [m], between two of the same body of which one is below and one
// above it, to 1e-13 rad; nullopt as righting_arm(). low.heel < high.heel. Complexity: some ten righting
// arms.
std::optional<RightingArm> arm_at_lever(const FloatingBody& body, const Water& water, const RightingArm& low,
                                        const RightingArm& high, double lever,
                                        const RightingArmOptions& options = {});

// Returns the slope of GZ at heel 0 [m], which is GM, with free surfaces, for a body that rests there;
// nullopt as righting_arm(). It is a central difference of 1e-4 rad. Complexity: two righting arms.
std::optional<double> upright_metacentric_height(const FloatingBody& body, const Water& water,
                                                 const RightingArmOptions& options = {});

struct RightingCurvePoint {
  RightingArm arm;
  double area = 0.0;  // [m rad], of GZ from heel 0
};

// A heel other than 0 at which the arm vanishes.
struct ArmCrossing {
  double heel = 0.0;     // [rad]
  bool returns = false;  // true if the arm turns the body back to this heel, as at an angle of loll
};

struct RightingCurve {
  std::vector<RightingCurvePoint> points;  // in the order of the heels
  std::vector<ArmCrossing> crossings;      // ascending; between the requested heels
  // The largest arm to either side, between the requested heels; nullopt where none is above 0.
  std::optional<RightingArm> max_starboard, max_port;
  // [rad], the first heel outwards to either side at which righting_arm() has no result. This heel and those
  // beyond it have no points, since their areas are unknown.
  std::optional<double> unbalanced_starboard, unbalanced_port;

  // [rad], the end of the range of stability to starboard (port: below 0): the first heel beyond 0, or
  // beyond the angle of loll, at which the arm vanishes.
  std::optional<double> vanishing_starboard() const;
  std::optional<double> vanishing_port() const;
};

// heels: [rad], -pi to pi, ascending. Each trim starts from that of its neighbour towards heel 0. Returns
// nullopt where righting_arm() has no result at heel 0. Crossings and maxima are refined to 1e-10 rad and
// 1e-7 rad, which takes some 60 more arms.
std::optional<RightingCurve> righting_curve(const FloatingBody& body, const Water& water,
                                            std::span<const double> heels,
                                            const RightingArmOptions& options = {});

}  // namespace buoyancy
