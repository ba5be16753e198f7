// How a body lies in the water: what can be skipped is decided here, by bounds that are certain.
//
// The bounds are those of the mesh's box about its centre c; every comparison has a margin for rounding, so
// that kDry and kSubmerged are facts and kPiercing only means "look closer". An open mesh is never
// kSubmerged.
#pragma once

#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

enum class Immersion { kDry, kSubmerged, kPiercing };

// O(1).
Immersion immersion(const HydrostaticMesh& mesh, const WaterPlane& plane);

// The same before the plane is known, in plain double, at a tenth of the cost of computing the plane: a scene
// pays no more for its bodies that are out of the water or deep in it. What this calls dry or wet the other
// calls so too, of the exact plane. A pose that is not finite, or of a quaternion whose norm is below 1e-50
// or squares to infinity, is kPiercing. O(1).
Immersion quick_immersion(const HydrostaticMesh& mesh, const Pose& pose, const Water& water);

}  // namespace buoyancy
