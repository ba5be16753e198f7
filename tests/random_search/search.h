// The random search in still water: results of all methods must hold the rules of check_result.h. Each mesh
// has 32 requests.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/random_search/check_result.h"
#include "tests/random_search/search_engine.h"

namespace buoyancy {

inline constexpr std::int64_t kRequestsPerMesh = 32;

// Evaluates a request by all evaluators; tests substitute a broken implementation for the product's.
using EvaluateAll = std::function<std::vector<GivenResult>(const HydrostaticMesh&, const SearchPose&)>;

BuoyancyResult result_of(Evaluator evaluator, const HydrostaticMesh& mesh, const SearchPose& requested);
// The product's results by every evaluator, with `hierarchical` on the instruction set in use.
std::vector<GivenResult> product_results(const HydrostaticMesh& mesh, const SearchPose& requested);

// Runs the cases begin <= number < end; both are multiples of kRequestsPerMesh. `hierarchical` runs on every
// instruction set in turn; because of force_simd_target(), no other thread may run it meanwhile.
SearchStats search(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads);
// The same with another implementation, on one thread.
SearchStats search(std::uint64_t seed, std::int64_t begin, std::int64_t end, const EvaluateAll& evaluate);

// A single case.
struct SearchCase {
  std::string kind;
  TriangleMesh mesh;
  SearchPose requested;
};
SearchCase search_case(std::uint64_t seed, std::int64_t number);

// Shrinks and prints failing cases.
RandomSearch still_water_search();

}  // namespace buoyancy
