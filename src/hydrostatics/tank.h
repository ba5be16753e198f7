// The liquid in a tank: where it is, and how its free surface lies, at a given attitude.
//
// The surface is level, as in a tank that moves slowly: sloshing is not modelled, not even in waves. Its
// height is where the part of the tank below it, which the exact solver of displaced volumes computes
// (hierarchical.h), has the liquid's volume. The liquid's energy has its minimum there, so that its first
// moment is the derivative of that energy (docs/mathematics.md, "Compartments and tanks").
//
// A tank with a piston has no free surface: its liquid lies between the piston and the tank's end, at the
// same place of the body at every attitude.
#pragma once

#include <optional>
#include <span>

#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

struct Tank {
  const HydrostaticMesh* mesh = nullptr;  // closed, in the body's frame, with its tree; outlives the tank
  double liquid_volume = 0.0;             // [m^3], from 0 to the mesh's volume
  double density = 0.0;                   // [kg/m^3], of the liquid, >= 0
  // Unit, in B: the axis along which the liquid pushes a piston, away from the end that fills first. nullopt:
  // the liquid has a free surface.
  std::optional<Vec3> piston_axis_B = {};

  double liquid_mass() const { return density * liquid_volume; }  // [kg]
};

// Points are relative to the mesh's centre c.
struct TankLiquid {
  Vec3 centroid = Vec3::Zero();   // [m], of the liquid; 0 of an empty tank
  WaterPlane surface;             // about c, over the liquid or at the piston; where neither empty nor full
  bool has_free_surface = false;  // neither empty nor full, and no piston
  double volume = 0.0;            // [m^3], under `surface`: liquid_volume to 1e-14 of the mesh's volume
  double volume_error = 0.0;  // [m^3], bound on the error of `volume` and of its distance from the liquid's
};

// Finds the liquid's surface at an attitude. up_B: unit; with a piston it does not matter. A pure function:
// it does not start from an earlier result. Complexity: about seven displaced volumes; no heap.
TankLiquid tank_liquid(const Tank& tank, const Vec3& up_B);

// Returns the integral of y y^T over the free surface [m^4], about its centroid in B axes, or zero without a
// free surface. It reduces the stiffness by its product with the liquid's density and g. Complexity: that of
// hydrostatics().
Mat3 free_surface_second_moments(const Tank& tank, const TankLiquid& liquid);

// The liquids in the tanks of a body at an attitude, about a point of B.
struct LiquidSum {
  double mass = 0.0;                 // [kg]
  Vec3 moment = Vec3::Zero();        // [kg m], B axes: mass times the centroid
  Mat3 free_surface = Mat3::Zero();  // [kg m], B axes: densities times free_surface_second_moments()
};

enum class FreeSurfaces { kNo, kYes };

// Adds the liquid of a tank, with its free surface if requested. about_B: [m], the point of the sum.
void add_liquid(const Tank& tank, const TankLiquid& liquid, const Vec3& about_B, FreeSurfaces free_surfaces,
                LiquidSum& sum);
// Complexity: per tank that of tank_liquid(), and with free surfaces also that of hydrostatics().
LiquidSum liquid_sum(std::span<const Tank> tanks, const Vec3& up_B, const Vec3& about_B,
                     FreeSurfaces free_surfaces);

}  // namespace buoyancy
