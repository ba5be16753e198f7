// Tank tables: what a tank holds, and how its free surface lies, over the sounding.
//
// The sounding is what a tape reads in a straight pipe: the height of the liquid's level over the foot of the
// pipe, along the ship's up axis. With trim or heel, liquid lower than the foot is left at a sounding of 0.
// That of a tank with a piston is the travel of the piston, and the attitude does not matter.
#pragma once

#include <optional>

#include "flotation/ship_axes.h"
#include "hydrostatics/tank.h"

namespace buoyancy {

struct SoundingPipe {
  Vec3 foot_B = Vec3::Zero();  // [m], where the sounding is 0
  double depth = 0.0;          // [m], the sounding at which the upright tank is full
};

// foot_B: nullopt: at the height of the lowest point of the upright tank, under the centre of its volume. It
// does not matter with a piston. Complexity: that of lowest_vertex().
SoundingPipe sounding_pipe(const Tank& tank, const ShipAxes& axes, const std::optional<Vec3>& foot_B = {});

struct TankTableRow {
  HeelTrim angles;
  double sounding = 0.0;               // [m]
  double volume = 0.0;                 // [m^3], of the liquid
  double mass = 0.0;                   // [kg]
  Vec3 centroid_B = Vec3::Zero();      // [m], of the liquid; NaN of an empty tank
  double free_surface_moment_t = 0.0;  // [kg m], density times second moment about the longitudinal axis
  double free_surface_moment_l = 0.0;  // [kg m], about the transverse axis; both horizontal
};

// tank: its liquid_volume does not count. angles: both between -pi/2 and pi/2. A volume that rounding cannot
// tell from that of an empty or a full tank is that of one. A pure function. Complexity: that of
// hydrostatics().
TankTableRow tank_table_row(const Tank& tank, const ShipAxes& axes, const HeelTrim& angles,
                            const SoundingPipe& pipe, double sounding);

}  // namespace buoyancy
