// What the results should have been, and how far a solver's results are from it.
//
// The truth comes from the tests' oracle in extended precision (64 bits of mantissa), whose own error is a
// thousandth of what it judges. It is computed once per set of poses and shared by all methods. Errors are
// relative to the whole: of force to rho g V_T, of torque, about B's origin, to rho g V_T L.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "benchmark_meshes.h"
#include "hydrostatics/buoyancy.h"

namespace buoyancy::bench {

struct ReferenceResult {
  Vec3 force_W;   // of kUnitWater: m^3
  Vec3 torque_W;  // m^4, about B's origin
};

// Poses and what they should be answered with.
struct PoseSet {
  std::string regime;  // "independent" or "coherent"
  std::vector<Pose> poses;
  std::vector<ReferenceResult> truth;
};

// O(poses times triangles), on all processors.
PoseSet with_reference_results(std::string regime, std::vector<Pose> poses, const TriangleMesh& source);

struct SolverErrors {
  double force = 0.0;         // the largest over the poses
  double torque = 0.0;        // likewise
  double force_median = 0.0;  // over the poses
  double bound = 0.0;         // the largest force error bound that was published
  double bound_median = 0.0;  // likewise
};

// Asks the solver for every pose and compares. Every result must keep its bounds. The bound of force must be
// at most the tolerance or 4 G_V of `hierarchical`, whichever is larger, and 1e-11 of the whole of the
// paper's exact methods, whose grow with the depth.
//
// Errors: a pose whose result is farther from the truth than its own bound, or whose bound is too large;
// names the mesh, the method and the pose.
Expected<SolverErrors> measure_errors(const BenchmarkMesh& model, const Solver& solver, const PoseSet& set);

}  // namespace buoyancy::bench
