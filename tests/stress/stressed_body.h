// The bodies that the catalogue's rows are tried on, and their results by every method that claims to be
// exact.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hydrostatics/buoyancy.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {

// Density times gravity is 1: forces are m^3, torques m^4.
inline const Water kStressWater{.up_W = Vec3::UnitZ(), .level = 0.25, .density = 1.0, .gravity = 1.0};

// x_B -> q x_B: coordinates of all their digits.
TriangleMesh turned(TriangleMesh mesh, const Eigen::Quaterniond& q);

struct StressedBody {
  std::string name;
  TriangleMesh source;
  HydrostaticMesh mesh;
  BoundingBox box;

  StressedBody(std::string called, TriangleMesh from);

  double volume_tolerance() const { return mesh.volume_tolerance(); }  // G_V
  double torque_tolerance(const Vec3& reference_B) const {                  // G_tau
    return mesh.volume_tolerance() * mesh.max_lever_arm(reference_B);
  }
};

// Closed, small enough for rational arithmetic: plain, hollow, knotted, thin, in pieces, tiny, huge, far from
// its origin.
const std::vector<StressedBody>& stressed_bodies();

// A random or an adversarial pose, by turns; every fourth time `water` gets an up direction that is no axis.
Pose stressed_pose(RandomPoses& random, const StressedBody& body, int turn, Water& water);

// Somewhere in or near the body, so that torques are about a point that is none of its own.
Vec3 reference_near(RandomPoses& random, const StressedBody& body);

// visit(name, solver) for every method that claims to be exact, `hierarchical` on every instruction set of
// this processor.
void visit_exact_solvers(const HydrostaticMesh& mesh,
                         const std::function<void(const std::string&, const Solver&)>& visit);

// By how much an exact method's gates are wider at this pose. The paper's two sum up a submerged body instead
// of taking its constants, and the terms of that sum are as large as A_s times the depth: in the catalogue 1
// + depth/L. On thin plates, whose V_T is next to nothing against that, they are measured to need the 8 (a
// plate of 1 : 1e8 in 10 x 10 squares: 4.3).
double depth_factor(const Solver& solver, const Pose& pose, const Water& water);

bool same_bits(const BuoyancyResult& a, const BuoyancyResult& b);

}  // namespace buoyancy
