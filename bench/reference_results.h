// Reference results, and the errors of a solver's results against them.
//
// The reference comes from the tests' oracle in extended precision (64 bits of mantissa), whose own error is
// a thousandth of the errors that it measures. It is computed once per set of poses and shared by all
// methods. Errors are relative to the whole: of force to rho g V_T, of torque, about B's origin, to rho g V_T
// L.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "benchmark_meshes.h"
#include "hydrostatics/buoyancy.h"
#include "plain_exact.h"

namespace buoyancy::bench {

struct ReferenceResult {
  Vec3 force_W;   // [m^3], for kUnitWater
  Vec3 torque_W;  // [m^4], about B's origin
};

// Poses with their reference results.
struct PoseSet {
  std::string regime;  // as in measurement.h
  std::vector<Pose> poses;
  std::vector<ReferenceResult> truth;
};

// Costs O(poses x triangles), on all processors.
PoseSet with_reference_results(std::string regime, std::vector<Pose> poses, const TriangleMesh& source);

struct SolverErrors {
  double force = 0.0;         // maximum over the poses
  double torque = 0.0;        // maximum over the poses
  double force_median = 0.0;  // median over the poses
  double bound = 0.0;         // maximum of the published force error bounds; NaN if none are published
  double bound_median = 0.0;  // median of the published force error bounds; NaN if none are published
};

// Evaluates the solver at every pose and compares. Every error must be within its published bound. The force
// bound must be at most the larger of the tolerance and 4 G_V for `hierarchical`, and at most 1e-11 of the
// whole for the paper's exact methods, whose bounds grow with the depth.
//
// Errors: a result whose error exceeds its own bound, or whose bound is too large. The error names the mesh,
// the method and the pose.
Expected<SolverErrors> measure_errors(const BenchmarkMesh& model, const Solver& solver, const PoseSet& set);

// Evaluates the plain method, which publishes no bound, at every pose.
SolverErrors measure_errors(const BenchmarkMesh& model, PlainExact& plain, const PoseSet& set);

}  // namespace buoyancy::bench
