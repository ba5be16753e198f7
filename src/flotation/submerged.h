// How a fully submerged body rests and what moves it: a vehicle under water, or a body that sinks
// (docs/mathematics.md, "Fully submerged bodies").
//
// The centre of buoyancy no longer depends on the attitude. Whether the body hovers, rises or sinks, the
// torque of buoyancy and weight about the centre of all mass G vanishes where the centre of buoyancy is over
// G. Drag that acts beside that line does not count.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "flotation/equilibrium.h"

namespace buoyancy {

enum class VerticalMotion { kRises, kSinks, kHovers };

// The names that programs print: "rises", "sinks", "hovers".
std::string_view to_string(VerticalMotion motion);

struct SubmergedRest {
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  // with the heading of attitude_at()
  HeelTrim angles;                                           // [rad]
  // kSphere: the centre of buoyancy is at G, so that any attitude is one of rest; the upright one is
  // reported.
  AttitudeFamily family = AttitudeFamily::kNone;
  double bg = 0.0;  // [m], height of the centre of buoyancy over G
  // [N m], ascending: rho g V (BG - GG') sin 1 degree about the two principal horizontal axes, with GG' the
  // rise of G by the free surfaces of tanks. Without these the two are equal.
  std::array<double, 2> moments_per_degree{};
  double net_weight = 0.0;  // [N], weight less buoyancy
  VerticalMotion motion = VerticalMotion::kHovers;
};

// A lever within this part of a body's size, such as its reach(), is only rounding, also of generated meshes.
// Centres of buoyancy and mass that are no farther apart count as one point.
inline constexpr double kNoLever = 1e-6;

// Returns the attitude of rest of the lowest energy. With free surfaces a body may have several: the search
// descends from upright and from the axes of B, and of equally low ones the first is kept. Returns nullopt
// for an open mesh, for a body that displaces nothing, and where a number is beyond double's range.
// Complexity: seven descents (attitude_descent.h), of one step without free surfaces.
std::optional<SubmergedRest> submerged_rest(const FloatingBody& body, const Water& water,
                                            const ShipAxes& axes = {});

}  // namespace buoyancy
