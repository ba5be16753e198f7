// Time beside error: every method of ours on meshes of 1,760 to 1,003,520 triangles, in two regimes.
//
//   speed_accuracy [--quick | --smoke] [--csv FILE]
//
// Prints tables and what was promised beside what came out (report.h); --csv writes a row per measurement
// (measurement.h). Exit codes: 0 measured; 1 a result was farther from the truth than its own bound, or the
// file could not be written; 2 wrong arguments. A goal that is missed is printed and changes no exit code:
// times depend on the machine and on what else it does.
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

// A mesh of the plan; its poses and true results are shared with the same mesh in shuffled order.
struct PlannedMesh {
  BenchmarkMesh (*make)();
  bool with_shuffled;
  bool full, quick, smoke;  // which runs it is part of
};

constexpr std::array kPlan{
    PlannedMesh{[] { return torus_knot(); }, false, true, true, true},
    PlannedMesh{[] { return model_or_rock("bunny", "bunny_5002.ply", 16); }, false, true, true, false},
    PlannedMesh{[] { return model_or_rock("armadillo", "armadillo_30000.ply", 39); }, false, true, true,
                false},
    PlannedMesh{[] { return model_or_rock("armadillo", "armadillo_86482.ply", 66); }, false, true, false,
                false},
    PlannedMesh{[] { return rock(4); }, true, false, false, true},
    PlannedMesh{[] { return rock(16); }, true, true, true, false},
    PlannedMesh{[] { return rock(39); }, true, true, true, false},
    PlannedMesh{[] { return rock(122); }, true, true, false, false},
    PlannedMesh{[] { return rock(122); }, false, false, true, false},
    PlannedMesh{[] { return rock(224); }, true, true, false, false},
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

// Enough for the least of them to be undisturbed, and no more than some seconds for the methods that look at
// every triangle.
int sweeps_of(Extent extent, std::size_t triangles) {
  if (extent == Extent::kSmoke) return 1;
  const auto affordable = static_cast<int>((extent == Extent::kFull ? 1'500'000 : 300'000) / triangles);
  return extent == Extent::kFull ? std::clamp(affordable, 7, 51) : std::clamp(affordable, 3, 15);
}

TreeCost tree_cost(const BenchmarkMesh& model, Extent extent) {
  using Clock = std::chrono::steady_clock;
  const auto triangles = static_cast<double>(model.source.triangles.size());
  double min_ns = std::numeric_limits<double>::max();
  for (int i = 0; i < (extent == Extent::kFull ? 5 : 2); ++i) {
    const auto start = Clock::now();
    const MomentTree tree = build_moment_tree(model.mesh.surface);
    min_ns = std::min(min_ns, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  return {model.name, model.source.triangles.size(), min_ns / triangles,
          static_cast<double>(model.mesh.tree->bytes()) / triangles};
}

Expected<void> measure(const BenchmarkMesh& model, const std::vector<PoseSet>& sets, Extent extent,
                       BenchmarkResults& measured) {
  for (const PoseSet& set : sets) {
    const int sweeps = sweeps_of(extent, model.source.triangles.size());
    std::fprintf(stderr, "%s of %zu triangles, %s: %zu poses, %d sweeps\n", model.name.c_str(),
                 model.source.triangles.size(), set.regime.c_str(), set.poses.size(), sweeps);
    auto rows = time_queries(model, set, sweeps);
    if (!rows) return tl::unexpected(rows.error());
    std::move(rows->begin(), rows->end(), std::back_inserter(measured.rows));
  }
  measured.trees.push_back(tree_cost(model, extent));
  return {};
}

Expected<BenchmarkResults> measure_all(Extent extent) {
  BenchmarkResults measured;
  for (const PlannedMesh& planned : kPlan) {
    if (!is_part_of(planned, extent)) continue;
    const BenchmarkMesh model = planned.make();
    const int poses = poses_of(extent);
    const Pose floating = floating_pose(Solver(model.mesh, Method::kHierarchical));
    const std::vector<PoseSet> sets{
        with_reference_results("independent", sweep_of_poses(model.source, poses), model.source),
        with_reference_results("coherent", coherent_poses(model.mesh, floating, poses), model.source)};
    if (const auto done = measure(model, sets, extent, measured); !done) return tl::unexpected(done.error());
    if (!planned.with_shuffled) continue;
    if (const auto done = measure(shuffled(model), sets, extent, measured); !done)
      return tl::unexpected(done.error());
  }
  return measured;
}

int run(int argc, char** argv) {
  ToolCommandLine command_line("Time beside error of every method, in two regimes");
  bool quick = false;
  bool smoke = false;
  std::string csv_path;
  command_line.add_flag("--quick", quick, "fewer meshes and sweeps: under a minute");
  command_line.add_flag("--smoke", smoke, "two small meshes, 8 poses, one sweep: says nothing about time",
                        "--quick");
  command_line.add_option("--csv", csv_path, "write a row per measurement to this file");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;

  // Opened first: nobody wants to hear after minutes that the file cannot be written.
  std::FILE* csv = nullptr;
  if (!csv_path.empty()) {
    csv = std::fopen(csv_path.c_str(), "w");
    if (csv == nullptr) {
      std::perror(csv_path.c_str());
      return EXIT_FAILURE;
    }
  }
  const auto measured = measure_all(smoke ? Extent::kSmoke : quick ? Extent::kQuick : Extent::kFull);
  if (!measured) {
    std::fprintf(stderr, "%s\n", measured.error().message().c_str());
    return EXIT_FAILURE;
  }
  print_report(stdout, *measured);
  if (csv != nullptr) {
    write_csv(csv, measured->rows);
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
