// The parts of which a body consists, and the compartments, open to the sea, and the tanks that are in it.
//
// All three are closed meshes in the body's frame. A part displaces water; all parts of a body are one mesh
// (Body::prepared_mesh), so that nothing that uses it knows of parts. A compartment takes away what it would
// displace, times its permeability: buoyancy lost. A tank holds liquid whose weight acts where the liquid is.
//
// The water in a compartment has the level of the sea around it, and belongs to the sea. The liquid in a tank
// is part of the body: its weight is part of the body's wrench, and not of its mass ([body.client] mass).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hydrostatics/solver.h"
#include "hydrostatics/tank.h"
#include "scene/prepared_mesh.h"

namespace buoyancy {

struct BodyPart {
  std::string name;
  const PreparedMesh* prepared_mesh = nullptr;  // in the body's frame; owned by the scene
};

struct BodyCompartment {
  std::string name;
  const PreparedMesh* prepared_mesh = nullptr;  // in the body's frame, with its tree; owned by the scene
  Solver solver;                                // with the body's method and tolerance
  double permeability = 1.0;                    // above 0, at most 1
  double flooded = 1.0;                         // at the start, see BodyCondition
};

struct BodyTank {
  std::string name;
  const PreparedMesh* prepared_mesh = nullptr;  // in the body's frame, with its tree; owned by the scene
  double density = 0.0;                         // [kg/m^3], of the liquid
  double liquid_volume = 0.0;                   // [m^3], at the start
  std::optional<Vec3> piston_axis_B = {};       // see Tank

  double capacity() const { return prepared_mesh->mesh.volume; }  // [m^3]
};

// Compartments and tanks in the order of the scene file.
struct Subdivision {
  std::vector<BodyCompartment> compartments;
  std::vector<BodyTank> tanks;
};

// The state of a body's compartments and tanks, in the order of its subdivision.
struct BodyCondition {
  std::vector<double> flooded;         // 0 to 1: the share of a compartment that is open to the sea
  std::vector<double> liquid_volumes;  // [m^3], from 0 to the tank's capacity

  bool operator==(const BodyCondition&) const = default;
};

// Returns the condition in the scene file.
BodyCondition initial_condition(const Subdivision& subdivision);

// Returns the factor of a compartment's displacement in the sums of its body, from -1 to 0.
inline double factor_of(const BodyCompartment& compartment, double flooded) {
  return -compartment.permeability * flooded;
}

// Returns the tank with this volume of liquid [m^3] in it.
inline Tank with_liquid(const BodyTank& tank, double liquid_volume) {
  return {.mesh = &tank.prepared_mesh->mesh,
          .liquid_volume = liquid_volume,
          .density = tank.density,
          .piston_axis_B = tank.piston_axis_B};
}

}  // namespace buoyancy
