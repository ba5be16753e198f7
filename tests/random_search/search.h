// The random search. Cases are numbered from 0; each depends only on the seed and its number, not on the
// number of threads or on where a run begins. Each mesh has 32 requests.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/random_search/check_result.h"

namespace buoyancy {

inline constexpr std::int64_t kRequestsPerMesh = 32;

struct Largest {
  double value = 0.0;
  std::int64_t at = -1;  // the case's number
};

struct FailedCase {
  std::int64_t number = 0;
  std::string mesh;  // RandomMesh::kind
  std::vector<std::string> violations;
};

// The results of a run; those of several runs can be added.
struct SearchStats {
  std::int64_t cases = 0;
  std::int64_t results = 0;
  std::int64_t failed_cases = 0;
  std::array<std::array<Largest, Figures::kNames.size()>, kEvaluators.size()> largest{};
  std::vector<FailedCase> failures;  // the first hundred

  SearchStats& operator+=(const SearchStats& other);
};

// Evaluates a request by all evaluators; tests substitute a broken implementation for the product's.
using EvaluateAll = std::function<std::vector<GivenResult>(const HydrostaticMesh&, const SearchPose&)>;

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

}  // namespace buoyancy
