// What is asked of every result: numbers, within the gates of the oracle's, within the bound that came with
// it.
//
// Truth comes from balls, and from rational arithmetic where a ball is too wide to tell.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "hydrostatics/buoyancy.h"
#include "tests/random_search/search_pose.h"

namespace buoyancy {

// Who answers: the six methods, and `hierarchical` within the request's tolerance.
enum class Evaluator { kExact, kExactSurface, kHierarchical, kTolerance, kImproved, kFastSurface, kFast };
inline constexpr std::array kEvaluators{
    Evaluator::kExact,    Evaluator::kExactSurface, Evaluator::kHierarchical, Evaluator::kTolerance,
    Evaluator::kImproved, Evaluator::kFastSurface,  Evaluator::kFast};
const char* to_string(Evaluator answerer);
Method method_of(Evaluator answerer);

struct GivenResult {
  Evaluator answerer = Evaluator::kExact;
  std::string target;  // the instruction set, of `hierarchical`
  BuoyancyResult result;
};

// Of one result. Errors over G_V and G_tau are only of those who claim exactness, and of bodies that are
// neither slender nor made of thin faces (is_held_to_gates()); 0 of the others.
struct Figures {
  double force_over_gate = 0.0, torque_over_gate = 0.0;
  double force_over_bound = 0.0, torque_over_bound = 0.0;

  static constexpr std::array kNames{"force / gate", "torque / gate", "force / bound", "torque / bound"};
  std::array<double, 4> values() const {
    return {force_over_gate, torque_over_gate, force_over_bound, torque_over_bound};
  }
};

struct CheckReport {
  std::vector<Figures> figures;         // of each result
  std::vector<std::string> violations;  // one line each; empty: all is well
};

// source: the mesh as validated, in B; mesh: made of it.
CheckReport judge(const TriangleMesh& source, const HydrostaticMesh& mesh, const SearchPose& asked,
                const std::vector<GivenResult>& results);

// The gates of the exact methods in volume and in torque/(rho g): G_V and G_V L_r, of the paper's methods
// times 1 + depth/L (docs/stability.md).
struct Gates {
  double volume, torque;
};
Gates gates(Method method, const HydrostaticMesh& mesh, const SearchPose& asked);

}  // namespace buoyancy
