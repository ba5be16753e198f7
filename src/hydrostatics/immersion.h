// Classifies a body as dry, fully submerged or surface-piercing by conservative bounds, so that work can be
// skipped.
//
// The bounds are those of the mesh's box about its centre c; every comparison has a margin for rounding, so
// that kDry and kSubmerged are certain, and kPiercing only means that the bounds do not decide. An open mesh
// is never kSubmerged.
#pragma once

#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

enum class Immersion { kDry, kSubmerged, kPiercing };

// Complexity: O(1).
Immersion immersion(const HydrostaticMesh& mesh, const WaterPlane& plane);

// Does the same in plain double before the plane is known, at a tenth of the cost of the plane, which bodies
// clear of the surface then never need. Wherever this returns kDry or kSubmerged, immersion() of the exact
// plane returns the same. Returns kPiercing for a pose that is not finite, and for a quaternion whose norm is
// below 1e-50 or squares to infinity. Complexity: O(1).
Immersion quick_immersion(const HydrostaticMesh& mesh, const Pose& pose, const Water& water);

}  // namespace buoyancy
