// Where to put ballast so that a body floats or hangs at a given attitude: the inverse of equilibrium
// (docs/mathematics.md, "Ballast").
//
// The mass, or else the draft, decides how deep the body lies. The centre of all mass must then lie on the
// line through the centre of buoyancy along the world's up. A submerged body is at rest in this sense even
// where it rises or sinks: its attitude is, and no torque acts.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "flotation/equilibrium.h"
#include "flotation/floating_body.h"
#include "flotation/ship_axes.h"

namespace buoyancy {

struct BallastTask {
  ShipAxes axes = {};
  HeelTrim target = {};  // [rad]
  // [m], depth of the lowest vertex, as in Equilibrium; not of a submerged body.
  std::optional<double> draft = {};
  std::optional<double> mass = {};  // [kg], of the ballast, > 0. Mass, draft or both are set.
  // [m], at most two. None and no `along`: the place is free. One: there. Two: the ballast is split.
  std::vector<Vec3> places_B = {};
  // Unit; the ballast lies on the line along it through the only place, or else through B's origin.
  std::optional<Vec3> along_B = {};
};

struct BallastPlace {
  Vec3 position_B = Vec3::Zero();  // [m]
  double mass = 0.0;               // [kg]
};

struct Ballast {
  std::vector<BallastPlace> places;      // one, or two if two were given
  double mass = 0.0;                     // [kg], of the ballast
  double mass_with_body = 0.0;           // [kg], of body and ballast, without liquids in tanks
  Vec3 center_of_mass_B = Vec3::Zero();  // [m], of that mass
  double total_mass = 0.0;               // [kg], with liquids
  double displaced_mass = 0.0;           // [kg], of the water
  FlotationOutcome outcome = FlotationOutcome::kFloats;  // kFloats, kSinks or kNeutral
  double draft = 0.0;                                    // [m]; 0 of a submerged body
  // [m], principal metacentric heights, ascending, free surfaces of tanks included; the target is stable if
  // both are above 0. The axes are those about which the body turns, unit, B.
  std::array<double, 2> metacentric_heights{};
  std::array<Vec3, 2> turning_axes_B{Vec3::UnitX(), Vec3::UnitY()};
  // [m], of one place: moved along the world's up, the ballast leaves the target stable below this point.
  std::optional<Vec3> stability_limit_B;
  bool is_in_box = true;  // every place with mass is in the bounding box of the hull, in B

  bool is_submerged() const { return outcome != FlotationOutcome::kFloats; }
  bool is_stable() const { return metacentric_heights[0] > 0.0; }
};

// Largest turn [rad] that a moment which is left over may cause.
inline constexpr double kBallastAttitude = 1e-7;

// body: without the ballast, its tanks filled. A free height, of a place that is free or on a vertical line,
// is that of the hull's lowest vertex, where ballast makes a body most stable; of two places over each other
// the lower one gets all. Errors: neither mass nor draft; more than two places; numbers that are not finite;
// a draft or a mass at which the body is dry, under water or takes in water, or which contradict each other;
// a place, line or split that leaves a moment which turns the body by more than kBallastAttitude; a negative
// mass at a place. Complexity: that of about ten displacements.
Expected<Ballast> find_ballast(const FloatingBody& body, const Water& water, const BallastTask& task);

}  // namespace buoyancy
