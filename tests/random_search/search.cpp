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

// A mesh, its requests and their results.
struct MeshCases {
  std::int64_t first = 0;
  std::string kind;
  TriangleMesh source;
  HydrostaticMesh mesh;
  std::vector<SearchPose> requested;
  std::vector<std::vector<GivenResult>> results;  // of each request
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
    cases.requested.push_back(random_search_pose(cases.source, random));
  cases.results.resize(cases.requested.size());
  return cases;
}

BuoyancyResult result_of(Evaluator evaluator, const HydrostaticMesh& mesh, const SearchPose& requested) {
  const double tolerance = evaluator == Evaluator::kTolerance ? requested.tolerance : 0.0;
  return buoyancy(Solver(mesh, method_of(evaluator), tolerance), requested.pose, requested.water,
                  requested.reference_B);
}

void add_hierarchical(MeshCases& cases, const std::string& target) {
  for (std::size_t i = 0; i < cases.requested.size(); ++i) {
    for (const Evaluator evaluator : {Evaluator::kHierarchical, Evaluator::kTolerance})
      cases.results[i].push_back({evaluator, target, result_of(evaluator, cases.mesh, cases.requested[i])});
  }
}

void add_others(MeshCases& cases) {
  for (std::size_t i = 0; i < cases.requested.size(); ++i) {
    for (const Evaluator evaluator : kEvaluators) {
      if (method_of(evaluator) != Method::kHierarchical)
        cases.results[i].push_back({evaluator, "", result_of(evaluator, cases.mesh, cases.requested[i])});
    }
  }
}

SearchStats stats_of(const MeshCases& cases) {
  SearchStats stats;
  for (std::size_t i = 0; i < cases.requested.size(); ++i) {
    const std::int64_t number = cases.first + static_cast<std::int64_t>(i);
    const CheckReport report = check_results(cases.source, cases.mesh, cases.requested[i], cases.results[i]);
    ++stats.cases;
    stats.results += static_cast<std::int64_t>(cases.results[i].size());
    for (std::size_t n = 0; n < report.figures.size(); ++n) {
      auto& row = stats.largest[static_cast<std::size_t>(cases.results[i][n].evaluator)];
      const auto values = report.figures[n].values();
      for (std::size_t column = 0; column < values.size(); ++column) {
        if (values[column] > row[column].value) row[column] = {values[column], number};
      }
    }
    if (report.violations.empty()) continue;
    ++stats.failed_cases;
    stats.failures.push_back({number, cases.kind, report.violations});
  }
  return stats;
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

std::vector<GivenResult> product_results(const HydrostaticMesh& mesh, const SearchPose& requested) {
  std::vector<GivenResult> results;
  for (const Evaluator evaluator : kEvaluators) {
    const bool dispatched = method_of(evaluator) == Method::kHierarchical;
    results.push_back({evaluator, dispatched ? simd_target() : "", result_of(evaluator, mesh, requested)});
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
  std::vector<SearchStats> stats_per_mesh(meshes.size());
  in_parallel(meshes.size(), threads, [&](std::size_t i) { stats_per_mesh[i] = stats_of(meshes[i]); });
  SearchStats total;
  for (const SearchStats& stats : stats_per_mesh) total += stats;
  return total;
}

SearchStats search(std::uint64_t seed, std::int64_t begin, std::int64_t end, const EvaluateAll& evaluate) {
  SearchStats total;
  for (std::int64_t mesh = begin / kRequestsPerMesh; mesh < end / kRequestsPerMesh; ++mesh) {
    MeshCases cases = make_cases(seed, mesh);
    for (std::size_t i = 0; i < cases.requested.size(); ++i)
      cases.results[i] = evaluate(cases.mesh, cases.requested[i]);
    total += stats_of(cases);
  }
  return total;
}

SearchCase search_case(std::uint64_t seed, std::int64_t number) {
  MeshCases cases = make_cases(seed, number / kRequestsPerMesh);
  return {std::move(cases.kind), std::move(cases.source),
          cases.requested[static_cast<std::size_t>(number % kRequestsPerMesh)]};
}

}  // namespace buoyancy
