#include "tests/random_search/search.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "hydrostatics/wetted_tree_sum.h"
#include "tests/random_search/random_mesh.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxFailures = 100;

std::uint64_t mesh_seed(std::uint64_t seed, std::int64_t mesh) {
  std::seed_seq mix{seed, static_cast<std::uint64_t>(mesh)};
  std::array<std::uint32_t, 2> bits{};
  mix.generate(bits.begin(), bits.end());
  return std::uint64_t{bits[0]} << 32U | bits[1];
}

// A mesh and what is asked of it.
struct MeshCases {
  std::int64_t first = 0;
  std::string kind;
  TriangleMesh source;
  HydrostaticMesh mesh;
  std::vector<SearchPose> asked;
  std::vector<std::vector<GivenResult>> results;  // to each
};

MeshCases make_cases(std::uint64_t seed, std::int64_t mesh_number) {
  MeshCases cases;
  const std::uint64_t own_seed = mesh_seed(seed, mesh_number);
  RandomMesh drawn = random_mesh(own_seed);
  cases.first = mesh_number * kRequestsPerMesh;
  cases.kind = std::move(drawn.kind);
  cases.mesh = make_hydrostatic_mesh(drawn.validated);
  cases.source = std::move(drawn.validated.mesh);
  RandomPoses random(own_seed + 1);
  for (std::int64_t i = 0; i < kRequestsPerMesh; ++i)
    cases.asked.push_back(random_request(cases.source, random));
  cases.results.resize(cases.asked.size());
  return cases;
}

BuoyancyResult result_of(Evaluator answerer, const HydrostaticMesh& mesh, const SearchPose& asked) {
  const double tolerance = answerer == Evaluator::kTolerance ? asked.tolerance : 0.0;
  return buoyancy(Solver(mesh, method_of(answerer), tolerance), asked.pose, asked.water, asked.reference_B);
}

void add_hierarchical(MeshCases& cases, const std::string& target) {
  for (std::size_t i = 0; i < cases.asked.size(); ++i) {
    for (const Evaluator answerer : {Evaluator::kHierarchical, Evaluator::kTolerance})
      cases.results[i].push_back({answerer, target, result_of(answerer, cases.mesh, cases.asked[i])});
  }
}

void add_others(MeshCases& cases) {
  for (std::size_t i = 0; i < cases.asked.size(); ++i) {
    for (const Evaluator answerer : kEvaluators) {
      if (method_of(answerer) != Method::kHierarchical)
        cases.results[i].push_back({answerer, "", result_of(answerer, cases.mesh, cases.asked[i])});
    }
  }
}

SearchStats stats_of(const MeshCases& cases) {
  SearchStats tally;
  for (std::size_t i = 0; i < cases.asked.size(); ++i) {
    const std::int64_t number = cases.first + static_cast<std::int64_t>(i);
    const CheckReport judgement = judge(cases.source, cases.mesh, cases.asked[i], cases.results[i]);
    ++tally.cases;
    tally.results += static_cast<std::int64_t>(cases.results[i].size());
    for (std::size_t n = 0; n < judgement.figures.size(); ++n) {
      auto& row = tally.largest[static_cast<std::size_t>(cases.results[i][n].answerer)];
      const auto values = judgement.figures[n].values();
      for (std::size_t column = 0; column < values.size(); ++column) {
        if (values[column] > row[column].value) row[column] = {values[column], number};
      }
    }
    if (judgement.violations.empty()) continue;
    ++tally.failed_cases;
    tally.failures.push_back({number, cases.kind, judgement.violations});
  }
  return tally;
}

template <typename Work>
void in_parallel(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (unsigned n = 1; n < threads; ++n) others.emplace_back(loop);
  loop();
}

}  // namespace

SearchStats& SearchStats::operator+=(const SearchStats& other) {
  cases += other.cases;
  results += other.results;
  failed_cases += other.failed_cases;
  for (std::size_t row = 0; row < largest.size(); ++row) {
    for (std::size_t column = 0; column < largest[row].size(); ++column) {
      if (other.largest[row][column].value > largest[row][column].value)
        largest[row][column] = other.largest[row][column];
    }
  }
  for (const FailedCase& failure : other.failures) {
    if (failures.size() < kMaxFailures) failures.push_back(failure);
  }
  return *this;
}

std::vector<GivenResult> product_results(const HydrostaticMesh& mesh, const SearchPose& asked) {
  std::vector<GivenResult> results;
  for (const Evaluator answerer : kEvaluators) {
    const bool dispatched = method_of(answerer) == Method::kHierarchical;
    results.push_back({answerer, dispatched ? simd_target() : "", result_of(answerer, mesh, asked)});
  }
  return results;
}

SearchStats search(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads) {
  std::vector<MeshCases> meshes(static_cast<std::size_t>((end - begin) / kRequestsPerMesh));
  const std::int64_t first_mesh = begin / kRequestsPerMesh;
  in_parallel(meshes.size(), threads, [&](std::size_t i) {
    meshes[i] = make_cases(seed, first_mesh + static_cast<std::int64_t>(i));
    add_others(meshes[i]);
  });
  for (const std::string& target : simd_targets()) {
    force_simd_target(target);
    in_parallel(meshes.size(), threads, [&](std::size_t i) { add_hierarchical(meshes[i], target); });
  }
  force_simd_target("");
  std::vector<SearchStats> tallies(meshes.size());
  in_parallel(meshes.size(), threads, [&](std::size_t i) { tallies[i] = stats_of(meshes[i]); });
  SearchStats total;
  for (const SearchStats& tally : tallies) total += tally;
  return total;
}

SearchStats search(std::uint64_t seed, std::int64_t begin, std::int64_t end, const EvaluateAll& answering) {
  SearchStats total;
  for (std::int64_t mesh = begin / kRequestsPerMesh; mesh < end / kRequestsPerMesh; ++mesh) {
    MeshCases cases = make_cases(seed, mesh);
    for (std::size_t i = 0; i < cases.asked.size(); ++i)
      cases.results[i] = answering(cases.mesh, cases.asked[i]);
    total += stats_of(cases);
  }
  return total;
}

SearchCase search_case(std::uint64_t seed, std::int64_t number) {
  MeshCases cases = make_cases(seed, number / kRequestsPerMesh);
  return {std::move(cases.kind), std::move(cases.source),
          cases.asked[static_cast<std::size_t>(number % kRequestsPerMesh)]};
}

}  // namespace buoyancy
