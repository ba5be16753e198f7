// Which part of a body displaces how much: the terms of the sum over its meshes.
#pragma once

#include <vector>

#include "flotation/floating_body.h"

namespace buoyancy {

struct DisplacedPart {
  double volume = 0.0;           // [m^3], below 0 for a compartment that is open to the sea
  double mass = 0.0;             // [kg], of the displaced water
  Vec3 center_B = Vec3::Zero();  // [m], of that mass; NaN where the volume is 0
};

// Returns what each mesh of the body displaces at a pose, in the order of body.volumes(). The volumes add up
// to that of floating_state() within the rounding of the evaluation. Complexity: that of `hierarchical` per
// mesh.
std::vector<DisplacedPart> displaced_parts(const FloatingBody& body, const Pose& pose, const Water& water);

}  // namespace buoyancy
