#include "tests/random_search/search.h"

#include <array>
#include <random>

#include "hydrostatics/wetted_tree_sum.h"
#include "tests/random_search/random_mesh.h"
#include "tests/random_search/shrink.h"

namespace buoyancy {
namespace {

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
  RandomPoses of_mesh(own_seed);
  RandomMesh drawn = random_mesh(of_mesh);
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

std::string row_of(Evaluator evaluator) {
  return std::string("`") + to_string(evaluator) + "`";
}

SearchStats stats_of(const MeshCases& cases) {
  SearchStats stats;
  for (std::size_t i = 0; i < cases.requested.size(); ++i) {
    const std::int64_t number = cases.first + static_cast<std::int64_t>(i);
    const CheckReport report = check_results(cases.source, cases.mesh, cases.requested[i], cases.results[i]);
    ++stats.cases;
    for (std::size_t n = 0; n < report.figures.size(); ++n) {
      SearchFigures& row = stats.rows[row_of(cases.results[i][n].evaluator)];
      ++row.counts["results"];
      const auto values = report.figures[n].values();
      for (std::size_t column = 0; column < values.size(); ++column) {
        row.largest[Figures::kNames[column]].add(values[column], number);
      }
    }
    stats.add_violations(number, "  " + cases.kind + "\n", report.violations);
  }
  return stats;
}

SearchFailure replay(std::uint64_t seed, std::int64_t number) {
  const SearchCase original = search_case(seed, number);
  const StillFails still_fails = [](const TriangleMesh& mesh, const SearchPose& requested) {
    return fails(mesh, requested, product_results);
  };
  const HydrostaticMesh mesh = make_hydrostatic_mesh({original.mesh, {}});
  SearchFailure found{number, "  " + original.kind + "\n", {}};
  found.violations =
      check_results(original.mesh, mesh, original.requested, product_results(mesh, original.requested))
          .violations;
  const SearchCase shown = found.violations.empty() ? original : shrunk(original, still_fails);
  found.text += as_test(shown, seed, number);
  return found;
}

}  // namespace

BuoyancyResult result_of(Evaluator evaluator, const HydrostaticMesh& mesh, const SearchPose& requested) {
  const double tolerance = evaluator == Evaluator::kTolerance ? requested.tolerance : 0.0;
  return buoyancy(Solver(mesh, method_of(evaluator), tolerance), requested.pose, requested.water,
                  requested.reference_B);
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
  return sum_in_parallel(meshes.size(), threads, [&](std::size_t i) { return stats_of(meshes[i]); });
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

RandomSearch still_water_search() {
  RandomSearch one;
  one.description = "Search for a request whose result violates an accuracy rule";
  one.unit = kRequestsPerMesh;
  one.run = search;
  one.replay = replay;
  for (const Evaluator evaluator : kEvaluators) one.rows.push_back(row_of(evaluator));
  for (const char* const name : Figures::kNames) one.columns.push_back(largest_column(name, name));
  return one;
}

}  // namespace buoyancy
