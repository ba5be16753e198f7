// Time and error of every method on meshes of 1,760 to 1,003,520 triangles, in three regimes.
//
//   speed_accuracy [--quick | --smoke] [--csv FILE]
//
// Prints tables and the goals with the measured values (report.h); --csv writes a row per measurement
// (measurement.h). Exit codes: 0 measured; 1 the error of a result exceeds its own bound, or the file cannot
// be written; 2 invalid arguments. A missed goal is printed and does not change the exit code: times depend
// on the machine and its load.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "benchmark_meshes.h"
#include "cli/tool_command_line.h"
#include "pose_sweep.h"
#include "report.h"
#include "time_queries.h"
#include "trajectory_poses.h"

namespace buoyancy::bench {
namespace {

enum class Extent { kFull, kQuick, kSmoke };

// A mesh of the plan. Its poses and reference results are shared with the same mesh in shuffled order.
struct PlannedMesh {
  BenchmarkMesh (*make)();
  bool with_shuffled;
  bool full, quick, smoke;  // runs that include the mesh
};

constexpr std::array kPlan{
    PlannedMesh{[] { return torus_knot(); }, false, true, true, true},
    PlannedMesh{[] { return model_or_rock("bunny", "bunny_5002.ply", 16); }, false, true, true, false},
    PlannedMesh{[] { return model_or_rock("armadillo", "armadillo_30000.ply", 39); }, false, true, true,
                false},
    PlannedMesh{[] { return model_or_rock("armadillo", "armadillo_86482.ply", 66); }, false, true, false,
                false},
    PlannedMesh{[] { return rock(4); }, true, false, false, true},
    PlannedMesh{[] { return rock_uv(20, 9); }, false, false, false, true},
    PlannedMesh{[] { return rock(16); }, true, true, true, false},
    PlannedMesh{[] { return rock(39); }, true, true, true, false},
    PlannedMesh{[] { return rock(122); }, true, true, false, false},
    PlannedMesh{[] { return rock(122); }, false, false, true, false},
    PlannedMesh{[] { return rock(224); }, true, true, false, false},
    PlannedMesh{[] { return rock_uv(150, 101); }, false, true, true, false},
    PlannedMesh{[] { return rock_uv(500, 301); }, false, true, false, false},
    PlannedMesh{[] { return rock_uv(1000, 501); }, false, true, false, false},
};

bool is_part_of(const PlannedMesh& planned, Extent extent) {
  switch (extent) {
    case Extent::kFull:
      return planned.full;
    case Extent::kQuick:
      return planned.quick;
    case Extent::kSmoke:
      return planned.smoke;
  }
  return false;
}

int poses_of(Extent extent) {
  return extent == Extent::kSmoke ? 8 : 100;
}

// Number of sweeps: enough for an undisturbed minimum, and at most some seconds for the methods that visit
// every triangle.
int sweeps_of(Extent extent, std::size_t triangles) {
  if (extent == Extent::kSmoke) return 1;
  const auto affordable = static_cast<int>((extent == Extent::kFull ? 1'500'000 : 300'000) / triangles);
  return extent == Extent::kFull ? std::clamp(affordable, 7, 51) : std::clamp(affordable, 3, 15);
}

// Flushing the caches takes longer than most queries.
int cold_sweeps_of(Extent extent) {
  return extent == Extent::kFull ? 3 : 1;
}

// Every fourth pose.
PoseSet cold_set(const PoseSet& independent) {
  PoseSet set{kColdRegime, {}, {}};
  for (std::size_t i = 0; i < independent.poses.size(); i += 4) {
    set.poses.push_back(independent.poses[i]);
    set.truth.push_back(independent.truth[i]);
  }
  return set;
}

TreeCost tree_cost(const BenchmarkMesh& model, Extent extent) {
  using Clock = std::chrono::steady_clock;
  const auto triangles = static_cast<double>(model.source.triangles.size());
  double min_ns = std::numeric_limits<double>::max();
  for (int i = 0; i < (extent == Extent::kFull ? 5 : 2); ++i) {
    const auto start = Clock::now();
    const MomentTree tree = build_moment_tree(model.mesh);
    min_ns = std::min(min_ns, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  return {model.name, model.source.triangles.size(), min_ns / triangles,
          static_cast<double>(model.mesh.tree->bytes()) / triangles};
}

Expected<void> measure(const BenchmarkMesh& model, const std::vector<PoseSet>& sets, Extent extent,
                       CacheFlush& flush, BenchmarkResults& results) {
  for (const PoseSet& set : sets) {
    const bool cold = set.regime == kColdRegime;
    const int sweeps = cold ? cold_sweeps_of(extent) : sweeps_of(extent, model.source.triangles.size());
    std::fprintf(stderr, "%s of %zu triangles, %s: %zu poses, %d sweeps\n", model.name.c_str(),
                 model.source.triangles.size(), set.regime.c_str(), set.poses.size(), sweeps);
    auto rows = cold ? time_cold_queries(model, set, sweeps, flush) : time_queries(model, set, sweeps);
    if (!rows) return tl::unexpected(rows.error());
    std::move(rows->begin(), rows->end(), std::back_inserter(results.measurements));
  }
  results.trees.push_back(tree_cost(model, extent));
  return {};
}

Expected<BenchmarkResults> measure_all(Extent extent) {
  BenchmarkResults results;
  CacheFlush flush;
  for (const PlannedMesh& planned : kPlan) {
    if (!is_part_of(planned, extent)) continue;
    const BenchmarkMesh model = planned.make();
    const int poses = poses_of(extent);
    const Pose floating = floating_pose(Solver(model.mesh, Method::kHierarchical));
    std::vector<PoseSet> sets{
        with_reference_results(kIndependentRegime, sweep_of_poses(model.source, poses), model.source),
        with_reference_results(kCoherentRegime, coherent_poses(model.mesh, floating, poses), model.source)};
    sets.push_back(cold_set(sets.front()));
    if (const auto done = measure(model, sets, extent, flush, results); !done)
      return tl::unexpected(done.error());
    if (!planned.with_shuffled) continue;
    if (const auto done = measure(shuffled(model), sets, extent, flush, results); !done)
      return tl::unexpected(done.error());
  }
  return results;
}

int run(int argc, char** argv) {
  ToolCommandLine command_line("Measure time and error of every method in three regimes");
  bool quick = false;
  bool smoke = false;
  std::string csv_path;
  command_line.add_flag("--quick", quick, "Use fewer meshes and sweeps: a minute or two");
  command_line.add_flag("--smoke", smoke,
                        "Use two small meshes, 8 poses and one sweep: times are meaningless", "--quick");
  command_line.add_option("--csv", csv_path, "Write a row per measurement to this file");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;

  // The file is opened first, so that an error is reported before the measurements.
  std::FILE* csv = nullptr;
  if (!csv_path.empty()) {
    csv = std::fopen(csv_path.c_str(), "w");
    if (csv == nullptr) {
      std::perror(csv_path.c_str());
      return EXIT_FAILURE;
    }
  }
  const auto results = measure_all(smoke ? Extent::kSmoke : quick ? Extent::kQuick : Extent::kFull);
  if (!results) {
    std::fprintf(stderr, "%s\n", results.error().message().c_str());
    return EXIT_FAILURE;
  }
  print_report(stdout, *results);
  if (csv != nullptr) {
    write_csv(csv, results->measurements);
    const bool failed = std::ferror(csv) != 0;
    if (std::fclose(csv) != 0 || failed) {
      std::perror(csv_path.c_str());
      return EXIT_FAILURE;
    }
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  return buoyancy::bench::run(argc, argv);
}
