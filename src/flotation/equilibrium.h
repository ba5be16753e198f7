// The attitudes at which a body floats in water at rest.
//
// The stable equilibria are the minima of the energy m g z_G - rho g V z_B over height and attitude. They are
// found by descents from many attitudes (docs/mathematics.md, "Equilibrium and righting arms"): each is an
// equilibrium to rounding, and the energy rises around it. The search is no proof that there is no other one:
// for random bodies with three attitudes on average it finds 98 % of them, always one.
//
// A body whose energy does not change along a curve of attitudes (a cylinder that turns about its axis) or at
// all (a sphere with its centre of mass in the middle) is reported once per curve, with the family set. A
// mesh of such a shape has facets, and so has its energy: attitudes count as one family where the energy
// differs by less than kFlatCurve m g V^(1/3) along the curve, or than kFlatSphere m g V^(1/3) everywhere.
// The facets of a regular prism of 40 sides and of a sphere of 5,000 triangles are within these.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "flotation/floating_body.h"
#include "flotation/ship_axes.h"

namespace buoyancy {

inline constexpr double kFlatCurve = 1e-5;
inline constexpr double kFlatSphere = 1e-3;

enum class FlotationOutcome {
  kFloats,        // there is a stable attitude
  kSinks,         // it is heavier than the water that it can displace
  kNeutral,       // equal within 1e-9: it rests at any depth, its centre of mass under that of buoyancy
  kTakesInWater,  // an open mesh whose boundary is under water before it floats at rest
  kOutOfRange,    // a number is beyond double's range, or no descent ended within its steps
};

enum class AttitudeFamily {
  kNone,    // an isolated attitude
  kCurve,   // one of a curve of attitudes of equal energy
  kSphere,  // any attitude has the same energy
};

// The names that programs print: "neutrally_buoyant", "curve".
std::string_view to_string(FlotationOutcome outcome);
std::string_view to_string(AttitudeFamily family);

// Returns what the mass alone decides: kSinks, kNeutral or else kFloats, and kFloats for every open mesh.
FlotationOutcome outcome_by_mass(const FloatingBody& body, const Water& water);
// The same of a closed body. displaced: [kg], of the water that it displaces fully submerged.
FlotationOutcome outcome_by_mass(double mass, double displaced);

struct Equilibrium {
  // Directions of rotation in which the energy falls: 0 stable, 1 a saddle point, 2 a maximum.
  int unstable_directions = 0;
  AttitudeFamily family = AttitudeFamily::kNone;
  // B's origin is on the line through W's origin along up. The heading is that of attitude_at(): the body's
  // forward axis lies over W's x axis.
  Pose pose;
  double draft = 0.0;  // [m], depth of the lowest vertex
  HeelTrim angles;     // [rad]
  FloatingState state;
  // Norms of the state's force and torque. In exact arithmetic both are 0; each is within its bound, which is
  // the error bound of the state and what rounding of the pose's numbers changes.
  double residual_force = 0.0;   // [N]
  double residual_torque = 0.0;  // [N m]
  double force_bound = 0.0;      // [N]
  double torque_bound = 0.0;     // [N m]
  // [N m], eigenvalues of the energy's Hessian over the attitudes at constant displacement, ascending: m g GM
  // about the waterplane's principal axes. Where one is negative, the body capsizes about the axis of
  // state.hydrostatics with that metacentric height.
  std::array<double, 2> stiffness{};

  bool is_stable() const { return unstable_directions == 0; }
};

struct EquilibriumOptions {
  ShipAxes axes{};
  bool unstable = false;            // report the saddle points and maxima that are found, too
  std::size_t max_attitudes = 128;  // the lowest are kept
  // Called after each start of the search with the number of starts so far and an estimate of their total,
  // which grows while more attitudes are found; may be empty.
  std::function<void(std::int64_t done, std::int64_t total)> progress{};
};

struct Equilibria {
  FlotationOutcome outcome = FlotationOutcome::kOutOfRange;
  std::vector<Equilibrium> attitudes;  // the lowest energy first
  bool is_truncated = false;           // there are more than max_attitudes
};

// Finds the attitudes at which a body floats. Symmetric bodies have several attitudes of the same energy,
// which are all reported. Complexity: about 30 descents of four steps, each of one or two displacements and a
// waterline (waterline.h), and three displacements per start; curves of attitudes take up to 60 steps more.
Equilibria find_equilibria(const FloatingBody& body, const Water& water,
                           const EquilibriumOptions& options = {});

// Returns the equilibrium that a body turns to from an attitude if the energy can only fall, or nullopt if
// there is none (FlotationOutcome).
std::optional<Equilibrium> find_equilibrium_from(const FloatingBody& body, const Water& water,
                                                 const Eigen::Quaterniond& q_WB, const ShipAxes& axes = {});

}  // namespace buoyancy
