// The load of waves on a body by two methods that are in wide use, as baselines for wave_load(): they sum
// over all components at many points of the whole wetted surface, and do not know their error.
//
// `fast_surface` takes the pressure at the centroid of every triangle whose centroid is wet. `exact_surface`
// takes the heights of the vertices over the instantaneous surface, clips every triangle where their linear
// interpolant is zero, and integrates the pressure over the wet pieces with three points, exact for quadratic
// functions. A point above the surface has no pressure. What the load is: wave_load.h.
//
// Of a sea on grids the spline is evaluated at the points, in double.
//
// Phases are reduced in double-double at the body's centre. The sums over components are in float32 where
// that costs less than about 1e-6 of the displaced volume, else in double. Complexity: O(triangles x
// components). No heap after a thread's first query of a mesh and a sea of their size.
#pragma once

#include "hydrostatics/hydrostatic_mesh.h"
#include "wave_loads/wave_load.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {

// mesh: closed, or its boundary dry. reference_B: [m], about B's origin. Both bounds are infinite, unless the
// body is above the highest possible crest: then all is zero.
WaveLoad fast_surface_in_waves(const HydrostaticMesh& mesh, const SeaSnapshot& sea, const Pose& pose,
                               const Vec3& reference_B);
WaveLoad exact_surface_in_waves(const HydrostaticMesh& mesh, const SeaSnapshot& sea, const Pose& pose,
                                const Vec3& reference_B);
// The same with sums in double for every body, as a reference for measurements.
WaveLoad exact_surface_in_double(const HydrostaticMesh& mesh, const SeaSnapshot& sea, const Pose& pose,
                                 const Vec3& reference_B);

}  // namespace buoyancy
