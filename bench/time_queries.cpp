#include "time_queries.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "hydrostatics/wetted_tree_sum.h"
#include "median.h"
#include "memory_read_baseline.h"
#include "unit_water.h"

namespace buoyancy::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kWarmUpNs = 2e7;

double nanoseconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::nano>(to - from).count();
}

// What two readings of the clock with nothing between them are apart.
double clock_cost_ns() {
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < 10'000; ++i) {
    const auto start = Clock::now();
    least = std::min(least, nanoseconds(start, Clock::now()));
  }
  return least;
}

// Where results go, so that no query can be left out.
volatile double kept_result;
volatile std::uint64_t kept_reading;

// One row and what it takes to time it.
struct Contender {
  Measurement row;
  const Solver* solver = nullptr;  // nullptr: reads the mesh
  std::string forced_target;       // "": the best
  std::vector<double> min_ns;      // of each pose
};

void run_query(const Contender& contender, const TriangleMesh& surface, const Pose& pose) {
  if (contender.solver == nullptr) {
    kept_reading = read_vertices_and_indices(surface);
  } else {
    kept_result = buoyancy(*contender.solver, pose, kUnitWater, Vec3::Zero()).volume;
  }
}

// One untimed sweep, or as much of it as kWarmUpNs allow, then a timed one.
void sweep(Contender& contender, const TriangleMesh& surface, const std::vector<Pose>& poses,
           double clock_ns) {
  force_simd_target(contender.forced_target);
  const auto start_of_turn = Clock::now();
  for (const Pose& pose : poses) {
    run_query(contender, surface, pose);
    if (nanoseconds(start_of_turn, Clock::now()) > kWarmUpNs) break;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto start = Clock::now();
    run_query(contender, surface, poses[i]);
    const double time = std::max(0.0, nanoseconds(start, Clock::now()) - clock_ns);
    contender.min_ns[i] = std::min(contender.min_ns[i], time);
  }
}

}  // namespace

Expected<std::vector<Measurement>> time_queries(const BenchmarkMesh& model, const PoseSet& set, int sweeps) {
  std::vector<Solver> solvers;
  solvers.reserve(kAllMethods.size() + kMeasuredTolerances.size());
  for (const Method method : kAllMethods) {
    if (method != Method::kHierarchical) solvers.emplace_back(model.mesh, method);
  }
  for (const double tolerance : kMeasuredTolerances)
    solvers.emplace_back(model.mesh, Method::kHierarchical, tolerance);

  std::vector<Contender> contenders;
  const auto enter = [&](const Solver* solver, const std::string& forced_target) {
    Contender contender;
    contender.row.mesh = model.name;
    contender.row.triangles = model.source.triangles.size();
    contender.row.regime = set.regime;
    contender.row.method = solver == nullptr ? kMemoryReadRow : to_string(solver->method());
    contender.solver = solver;
    contender.forced_target = forced_target;
    contender.min_ns.assign(set.poses.size(), std::numeric_limits<double>::max());
    if (solver != nullptr && solver->method() == Method::kHierarchical) {
      force_simd_target(forced_target);
      contender.row.target = simd_target();
      contender.row.tolerance = solver->tolerance();
    }
    contenders.push_back(std::move(contender));
  };
  enter(nullptr, "");
  for (const Solver& solver : solvers) enter(&solver, "");
  const std::vector<std::string> targets = simd_targets();
  const auto exact_hierarchical = std::find_if(
      solvers.begin(), solvers.end(), [](const Solver& s) { return s.method() == Method::kHierarchical; });
  for (std::size_t i = 1; i < targets.size(); ++i) enter(&*exact_hierarchical, targets[i]);

  for (Contender& contender : contenders) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    contender.row.errors = {kNone, kNone, kNone, kNone, kNone};
    if (contender.solver == nullptr) continue;
    force_simd_target(contender.forced_target);
    const auto errors = measure_errors(model, *contender.solver, set);
    force_simd_target("");
    if (!errors) return tl::unexpected(errors.error());
    contender.row.errors = *errors;
  }

  const double clock_ns = clock_cost_ns();
  for (int i = 0; i < sweeps; ++i) {
    // To and fro: a branch predictor learns from the method before, and each has both neighbours before it.
    for (std::size_t n = 0; n < contenders.size(); ++n) {
      Contender& contender = contenders[i % 2 == 0 ? n : contenders.size() - 1 - n];
      sweep(contender, model.mesh.surface, set.poses, clock_ns);
    }
  }
  force_simd_target("");

  std::vector<Measurement> rows;
  rows.reserve(contenders.size());
  for (Contender& contender : contenders) {
    contender.row.median_ns = median(std::move(contender.min_ns));
    rows.push_back(std::move(contender.row));
  }
  return rows;
}

}  // namespace buoyancy::bench
