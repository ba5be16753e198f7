// The random search: cases numbered from 0, each the same for the same seed whatever the number of threads
// and wherever a run begins. 32 requests are asked of each mesh.
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
  std::int64_t at = -1;  // number of the case
};

struct FailedCase {
  std::int64_t number = 0;
  std::string mesh;  // what kind
  std::vector<std::string> violations;
};

// What a run found; runs add up.
struct SearchStats {
  std::int64_t cases = 0;
  std::int64_t results = 0;
  std::int64_t failed_cases = 0;
  std::array<std::array<Largest, Figures::kNames.size()>, kEvaluators.size()> largest{};
  std::vector<FailedCase> failures;  // the first hundred

  SearchStats& operator+=(const SearchStats& other);
};

// What is asked for a result: the product, or in tests something broken.
using EvaluateAll = std::function<std::vector<GivenResult>(const HydrostaticMesh&, const SearchPose&)>;

// The results of every method, of `hierarchical` on the instruction set in use.
std::vector<GivenResult> product_results(const HydrostaticMesh& mesh, const SearchPose& asked);

// Cases begin <= number < end; both multiples of kRequestsPerMesh. `hierarchical` is asked on every
// instruction set in turn (force_simd_target: nobody else may ask meanwhile).
SearchStats search(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads);
// The same of others' answers, on one thread.
SearchStats search(std::uint64_t seed, std::int64_t begin, std::int64_t end, const EvaluateAll& answering);

// A case by itself.
struct SearchCase {
  std::string kind;
  TriangleMesh mesh;
  SearchPose asked;
};
SearchCase search_case(std::uint64_t seed, std::int64_t number);

}  // namespace buoyancy
