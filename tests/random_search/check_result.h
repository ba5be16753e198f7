// Checks results against the oracle. Rules for every result: it holds finite numbers, its errors are within
// the bounds published with it, and those of exact methods are within the gates G_V and G_tau.
//
// The truth comes from balls, and from rational arithmetic where a ball is too wide to decide.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "hydrostatics/buoyancy.h"
#include "tests/random_search/search_pose.h"

namespace buoyancy {

// The six methods, and `hierarchical` within the request's tolerance.
enum class Evaluator { kExact, kExactSurface, kHierarchical, kTolerance, kImproved, kFastSurface, kFast };
inline constexpr std::array kEvaluators{
    Evaluator::kExact,    Evaluator::kExactSurface, Evaluator::kHierarchical, Evaluator::kTolerance,
    Evaluator::kImproved, Evaluator::kFastSurface,  Evaluator::kFast};
const char* to_string(Evaluator evaluator);
Method method_of(Evaluator evaluator);

struct GivenResult {
  Evaluator evaluator = Evaluator::kExact;
  std::string target;  // the instruction set, for `hierarchical` only
  BuoyancyResult result;
};

// Error ratios of one result. Errors over G_V and G_tau are set only for exact methods and for bodies that
// are neither slender nor made of thin faces (HydrostaticMesh::meets_volume_tolerance()); 0 otherwise.
struct Figures {
  double force_over_gate = 0.0, torque_over_gate = 0.0;
  double force_over_bound = 0.0, torque_over_bound = 0.0;

  static constexpr std::array kNames{"force / gate", "torque / gate", "force / bound", "torque / bound"};
  std::array<double, 4> values() const {
    return {force_over_gate, torque_over_gate, force_over_bound, torque_over_bound};
  }
};

struct CheckReport {
  std::vector<Figures> figures;         // one per result
  std::vector<std::string> violations;  // one line each; empty if all checks pass
};

// source: the mesh as validated, in B. mesh: made from source.
CheckReport check_results(const TriangleMesh& source, const HydrostaticMesh& mesh,
                          const SearchPose& requested, const std::vector<GivenResult>& results);

// The gates of the exact methods, the largest errors allowed in volume and in torque/(rho g): G_V and G_V
// L_r, for the paper's methods times 1 + depth/L (docs/stability.md).
struct Gates {
  double volume, torque;
};
Gates gates(Method method, const HydrostaticMesh& mesh, const SearchPose& requested);

}  // namespace buoyancy
