// The bodies that the catalogue's rows test, and their evaluation by every exact method.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hydrostatics/buoyancy.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {

// Density times gravity is 1: forces are in [m^3], torques in [m^4].
inline const Water kStressWater{.up_W = Vec3::UnitZ(), .level = 0.25, .density = 1.0, .gravity = 1.0};

struct StressedBody {
  std::string name;
  TriangleMesh source;
  HydrostaticMesh mesh;
  BoundingBox box;

  StressedBody(std::string body_name, TriangleMesh from);

  double volume_tolerance() const { return mesh.volume_tolerance(); }  // G_V
  double torque_tolerance(const Vec3& reference_B) const {             // G_tau
    return mesh.volume_tolerance() * mesh.max_lever_arm(reference_B);
  }
};

// Closed bodies small enough for rational arithmetic: simple, hollow, knotted, thin, in several parts, tiny,
// huge, far from their origin.
const std::vector<StressedBody>& stressed_bodies();

// Random and adversarial poses in turn; every fourth time `water` gets a random up direction.
Pose stressed_pose(RandomPoses& random, const StressedBody& body, int turn, Water& water);

// A random point in or near the body as the reference point of torques.
Vec3 reference_near(RandomPoses& random, const StressedBody& body);

// Calls check(random, body, turn) for `turns` turns with every body, whose random numbers start at `seed`.
void for_each_turn(std::uint64_t seed, int turns,
                   const std::function<void(RandomPoses&, const StressedBody&, int)>& check);

// Calls visit(name, solver) for every exact method, and for `hierarchical` on every instruction set of this
// processor.
void visit_exact_solvers(const HydrostaticMesh& mesh,
                         const std::function<void(const std::string&, const Solver&)>& visit);

// The factor on an exact method's tolerances at this pose. The paper's two sum over a submerged body instead
// of using its constants, and the terms of that sum are as large as A_s times the depth: 1 + depth/L in the
// catalogue. Thin plates, whose V_T is negligible against that, need a factor of 8 on depth/L (measured on a
// plate of 1 : 1e8 in 10 x 10 squares: 4.3).
double depth_factor(const Solver& solver, const Pose& pose, const Water& water);

// In the order of visit_exact_solvers().
std::vector<BuoyancyResult> results_of(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                                       const Vec3& reference_B);

bool same_bits(const BuoyancyResult& a, const BuoyancyResult& b);

}  // namespace buoyancy
