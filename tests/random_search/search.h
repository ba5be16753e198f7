// The random search: cases numbered from 0, each the same for the same seed whatever the number of threads
// and wherever a run begins. 32 questions are asked of each mesh.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/random_search/check_result.h"

namespace buoyancy {

inline constexpr std::int64_t kQuestionsPerMesh = 32;

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
struct Tally {
  std::int64_t cases = 0;
  std::int64_t answers = 0;
  std::int64_t failed_cases = 0;
  std::array<std::array<Largest, Figures::kNames.size()>, kAnswerers.size()> largest{};
  std::vector<FailedCase> failures;  // the first hundred

  Tally& operator+=(const Tally& other);
};

// What is asked for an answer: the product, or in tests something broken.
using Answering = std::function<std::vector<GivenAnswer>(const HydrostaticMesh&, const SearchQuestion&)>;

// The answers of every method, of `hierarchical` on the instruction set in use.
std::vector<GivenAnswer> product_answers(const HydrostaticMesh& mesh, const SearchQuestion& asked);

// Cases begin <= number < end; both multiples of kQuestionsPerMesh. `hierarchical` is asked on every
// instruction set in turn (force_simd_target: nobody else may ask meanwhile).
Tally search(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads);
// The same of others' answers, on one thread.
Tally search(std::uint64_t seed, std::int64_t begin, std::int64_t end, const Answering& answering);

// A case by itself.
struct SearchCase {
  std::string kind;
  TriangleMesh mesh;
  SearchQuestion asked;
};
SearchCase search_case(std::uint64_t seed, std::int64_t number);

}  // namespace buoyancy
