// From a body's pose to the buoyant wrench in the world: the one function that service, replay and client all
// end in.
#pragma once

#include "hydrostatics/immersion.h"
#include "hydrostatics/solver.h"

namespace buoyancy {

enum class BuoyancyStatus { kOk, kOpenEdgeWet, kOutOfRange };

struct BuoyancyResult {
  BuoyancyStatus status = BuoyancyStatus::kOk;
  Immersion immersion = Immersion::kPiercing;
  Vec3 force_W = Vec3::Zero();   // N
  Vec3 torque_W = Vec3::Zero();  // N m, about the reference point
  double volume = 0.0;           // m^3, submerged
  Vec3 center_of_buoyancy_W =
      Vec3::Zero();                 // m, W axes, relative to p_WB; zero where volume <= its error bound
  double force_error_bound = 0.0;   // N: the true force is no farther away
  double torque_error_bound = 0.0;  // N m; likewise
  double dropped_force =
      0.0;  // exact methods: |horizontal part of F| / (rho g V_T), dropped because it must be 0
  double dropped_torque = 0.0;  // exact methods: |part of torque along up| / (rho g V_T L), likewise
};

// pose: finite, quaternion not zero. reference_B: m, the point that torque is about.
// Anything but kOk leaves force, torque, volume and centre zero. Allocates nothing. A dry body costs its
// bounds alone, whatever the method; so does a wholly wet one with `hierarchical`.
//
// Exact methods publish F = rho g V up and a torque without component along up (design: what they drop is a
// health figure). Their bounds are rho g times HydrostaticMesh::rounding_bound(), of torque times L_r; of
// `exact` and `exact_surface` times 1 + 3 depth/L; of slender bodies and thin faces with what the cut faces
// add. Those of the approximations, and of `hierarchical` within a tolerance, add what was left out
// (docs/mathematics.md, "Error bounds").
BuoyancyResult buoyancy(const Solver& solver, const Pose& pose, const Water& water, const Vec3& reference_B);

// What no pose changes in the result of a wholly wet body.
struct FullySubmerged {
  double volume = 0.0;              // m^3
  double lift = 0.0;                // N
  Vec3 force_W = Vec3::Zero();      // N
  Vec3 lever_B = Vec3::Zero();      // m, from the reference point to the volume's centroid
  Vec3 centroid_B = Vec3::Zero();   // m, from B's origin
  double force_error_bound = 0.0;   // N
  double torque_error_bound = 0.0;  // N m
};

FullySubmerged fully_submerged(const HydrostaticMesh& mesh, const Water& water, const Vec3& reference_B);

// What buoyancy() answers, where quick_immersion() says enough for it: of a dry body, and with
// `hierarchical` of a wholly wet one. False: it takes more, and answer is as it was. O(1).
// wet: of the solver's mesh in this water, about the point that torque is about.
bool try_buoyancy_from_bounds(const Solver& solver, const FullySubmerged& wet, const Pose& pose,
                              const Water& water, BuoyancyResult& result);

}  // namespace buoyancy
