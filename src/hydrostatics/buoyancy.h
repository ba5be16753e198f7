// Computes the buoyant wrench of water at rest in the world from a body's pose. Every program that needs this
// wrench calls buoyancy().
//
// In layered water (base/water.h) the wrench is the sum over the terms of the pressure, and so are its
// bounds; dry and fully submerged are decided for each term. Volume and immersion are those under the
// surface, and the centre of buoyancy is the point at which the force acts: that of the displaced mass.
#pragma once

#include <span>

#include "hydrostatics/immersion.h"
#include "hydrostatics/solver.h"

namespace buoyancy {

enum class BuoyancyStatus {
  kOk,
  kOpenEdgeWet,
  kOutOfRange,
  kNotCertified,  // in waves: the bound on the force's error is above the weight of the whole displacement
};

struct BuoyancyResult {
  BuoyancyStatus status = BuoyancyStatus::kOk;
  Immersion immersion = Immersion::kPiercing;
  Vec3 force_W = Vec3::Zero();   // [N]
  Vec3 torque_W = Vec3::Zero();  // [N m], about the reference point
  double volume = 0.0;           // [m^3], submerged
  // [m], W axes, relative to p_WB; zero where volume <= its error bound. In layered water, the mean of the
  // centres of the terms, with their forces along up as weights.
  Vec3 center_of_buoyancy_W = Vec3::Zero();
  double force_error_bound = 0.0;   // [N], bound on |force_W - true force|
  double torque_error_bound = 0.0;  // [N m], bound on |torque_W - true torque|
  // Exact methods: |horizontal part of F| / (rho g V_T), which is 0 in exact arithmetic and is dropped.
  double dropped_force = 0.0;
  // Exact methods: |part of the torque along up| / (rho g V_T L), dropped for the same reason.
  double dropped_torque = 0.0;
};

// pose: finite, with a quaternion other than zero. reference_B: [m], the point that the torque is about. Any
// status other than kOk leaves force, torque, volume and centre zero. Allocates no more than the solver
// (Solver). Complexity: O(1) for a dry body with every method, and for a fully submerged body with
// `hierarchical`.
//
// Exact methods publish F = rho g V up and a torque without a component along up; the magnitudes of the
// dropped components indicate numerical health. The exact methods' force bound is rho g times
// HydrostaticMesh::rounding_bound(), and the torque bound is that times L_r; for `exact` and `exact_surface`
// both are multiplied by 1 + 3 depth/L; for slender bodies and thin faces both include what the cut faces
// add. The bounds of the approximations, and of `hierarchical` with a tolerance, include what was left out
// (docs/mathematics.md, "Error bounds"). Layered water costs a query more for each layer that the body
// reaches.
BuoyancyResult buoyancy(const Solver& solver, const Pose& pose, const Water& water, const Vec3& reference_B);

// The arguments of buoyancy() for one of several bodies.
struct BuoyancyQuery {
  const Solver* solver = nullptr;
  Pose pose;
  Vec3 reference_B = Vec3::Zero();  // [m]
};

// Sets results[i] to buoyancy() of queries[i], with the same bits. It is quicker for bodies that cross the
// surface, since their water planes are computed together. The spans have the same size.
void buoyancy(std::span<const BuoyancyQuery> queries, const Water& water, std::span<BuoyancyResult> results);

// The part of a fully submerged body's result that does not depend on the pose; in layered water, of the
// water above the layers.
struct FullySubmerged {
  double volume = 0.0;              // [m^3]
  double buoyant_force = 0.0;       // [N]
  Vec3 force_W = Vec3::Zero();      // [N]
  Vec3 lever_B = Vec3::Zero();      // [m], from the reference point to the volume's centroid
  Vec3 centroid_B = Vec3::Zero();   // [m], from B's origin
  double force_error_bound = 0.0;   // [N]
  double torque_error_bound = 0.0;  // [N m]
};

FullySubmerged submerged_constants(const HydrostaticMesh& mesh, const Water& water, const Vec3& reference_B);

// Sets `result` to what buoyancy() returns if quick_immersion() suffices, that is, if the body is dry or,
// with `hierarchical`, fully submerged, and in layered water crosses no layer's top. Otherwise returns false
// and leaves `result` unchanged. Complexity: O(1). submerged: submerged_constants() of the solver's mesh in
// this water, about the reference point.
bool try_buoyancy_from_bounds(const Solver& solver, const FullySubmerged& submerged, const Pose& pose,
                              const Water& water, const Vec3& reference_B, BuoyancyResult& result);

// Adds the loads of the layers to `result`, that of the water above them, which may have waves: the layers'
// tops do not move. A result whose status is not kOk, and that of a dry body, remain as they are.
void add_layers(const Solver& solver, const Pose& pose, const Water& water, const Vec3& reference_B,
                BuoyancyResult& result);

}  // namespace buoyancy
