// Computes the wrench of waves on a body from its pose: what buoyancy() of hydrostatics/buoyancy.h is for
// water at rest.
//
//   hierarchical   the load within the body's tolerance, with a certified bound (wave_load.h)
//   fast_surface, exact_surface   the load as other tools compute it, with bounds of infinity
//                                 (wave_surface_methods.h)
// The methods fast, improved and exact do not work in waves: they sum volumes under a plane.
//
// In layered water the surface moves and the tops of the layers do not: the waves are those of water of the
// density above the layers, whose loads are added as in water at rest (add_layers()).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hydrostatics/buoyancy.h"
#include "wave_loads/patch_tree.h"
#include "wave_loads/prepared_sea.h"

namespace buoyancy {

// What queries in waves need of a mesh, besides HydrostaticMesh; built once per mesh.
struct WaveMesh {
  PatchTree patches;  // of `hierarchical`
  // Vertices of HydrostaticMesh::surface: the edges of an open mesh that one triangle has alone.
  std::vector<std::array<std::int32_t, 2>> boundary_edges;
};

WaveMesh make_wave_mesh(const HydrostaticMesh& mesh);

struct WaveBuoyancyResult {
  BuoyancyResult result;
  bool work_capped = false;    // the work reached its cap before the bound was within the tolerance
  bool sea_too_steep = false;  // the modelled pressure falls downwards at the surface somewhere on the body
  bool below_bed = false;      // the body reaches below the sea bed
  std::int32_t patches = 0;    // evaluated
  double volume_error_bound = 0.0;  // [m^3], bound on |result.volume - true volume|
};

// wave_mesh: of the solver's mesh. The solver's method is hierarchical, fast_surface or exact_surface. pose,
// reference_B, statuses: as for buoyancy(), and kNotCertified with `hierarchical`. Heap and complexity: those
// of the method.
WaveBuoyancyResult buoyancy_in_waves(const Solver& solver, const WaveMesh& wave_mesh, const SeaAtTime& sea,
                                     const Pose& pose, const Vec3& reference_B);

// Sets `outcome` to a result for the pose if bounds suffice for it: if the body is above the highest crest
// or, with `hierarchical`, so deep in calm water that waves change its load by less than the tolerance, which
// the bounds then include. Returns false, and leaves `outcome` unchanged, otherwise. submerged:
// submerged_constants() of the solver's mesh, about the reference point. Complexity: O(1).
bool try_buoyancy_in_waves_from_bounds(const Solver& solver, const FullySubmerged& submerged,
                                       const SeaAtTime& sea, const Pose& pose, const Vec3& reference_B,
                                       WaveBuoyancyResult& outcome);

}  // namespace buoyancy
