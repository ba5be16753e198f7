// The load of waves on a body: Froude-Krylov and hydrostatic, on the instantaneous wetted surface, with a
// bound on its error.
//
//   F = -rho g int psi n dA,   tau = -rho g int (x - ref) x psi n dA
// where psi is the pressure over rho g where the point is below the instantaneous surface, and 0 elsewhere
// (docs/wave_mathematics.md). The surface is integrated patch by patch with a quadratic model of the
// pressure; patches are refined until the sum of their bounds is within the tolerance, until they are single
// triangles, or until the work reaches its cap. The bounds that are returned hold in every case; they are
// certified but for the rounding of sums over components, whose worst case is not added ("What is not
// covered" in docs/wave_mathematics.md). That of the volume does not decide what is refined: under waves that
// are short against the body it may exceed the tolerance.
//
// Complexity: hardly depends on the numbers of triangles and of components. No heap once a
// thread's buffers are as large as its queries need.
#pragma once

#include <cstdint>

#include "hydrostatics/hydrostatic_mesh.h"
#include "wave_loads/patch_tree.h"
#include "wave_loads/sea_expansion.h"
#include "waves/elevation_spline.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {

struct WaveLoad {
  Vec3 force = Vec3::Zero();   // [m^3], B axes: F / (rho g)
  Vec3 torque = Vec3::Zero();  // [m^4], B axes: torque about the reference point / (rho g)
  double volume = 0.0;         // [m^3], under the instantaneous surface
  Vec3 moment = Vec3::Zero();  // [m^4], B axes: integral of x - c over the displaced volume
  double force_bound = 0.0;    // [m^3], on |error of force|
  double torque_bound = 0.0;   // [m^4]
  double volume_bound = 0.0;   // [m^3], on |error of volume|
  bool capped = false;         // the bound did not get within the tolerance
  bool too_steep = false;      // somewhere the pressure does not rise downwards at the surface
  std::int32_t patches = 0;    // evaluated
  std::int32_t cells = 0;      // expanded
};

// What a query needs besides its pose; all prepared once.
struct WaveBody {
  const HydrostaticMesh* mesh = nullptr;  // closed, or its boundary dry
  const PatchTree* tree = nullptr;        // of mesh->surface
  double tolerance = 1e-3;                // relative to the volume of the mesh; above 0
};

// The box of the mesh at a pose, from above, somewhat wider than the rounding of positions makes it.
HorizontalBox footprint_of(const HydrostaticMesh& mesh, const Pose& pose, const HorizontalAxes& axes);

// expansion: of the sea; of a sea on grids, any. Where a grid is not periodic, it holds the body's footprint.
// reference_B: [m], about B's origin.
WaveLoad wave_load(const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                   const Pose& pose, const Vec3& reference_B);

}  // namespace buoyancy
