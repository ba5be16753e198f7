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

// Minimum difference between two consecutive readings of the clock.
double clock_cost_ns() {
  double min_ns = std::numeric_limits<double>::max();
  for (int i = 0; i < 10'000; ++i) {
    const auto start = Clock::now();
    min_ns = std::min(min_ns, nanoseconds(start, Clock::now()));
  }
  return min_ns;
}

// Sinks for the results, so that the compiler cannot omit a query.
volatile double result_sink;
volatile std::uint64_t read_sink;

// One row of the results and the data needed to time it.
struct TimedQuery {
  Measurement row;
  const Solver* solver = nullptr;  // nullptr: memory read baseline
  std::string forced_target;       // "": the best instruction set
  std::vector<double> min_ns;      // per pose
};

void run_query(const TimedQuery& query, const TriangleMesh& surface, const Pose& pose) {
  if (query.solver == nullptr) {
    read_sink = read_vertices_and_indices(surface);
  } else {
    result_sink = buoyancy(*query.solver, pose, kUnitWater, Vec3::Zero()).volume;
  }
}

// One untimed sweep, limited to kWarmUpNs, then a timed one.
void sweep(TimedQuery& query, const TriangleMesh& surface, const std::vector<Pose>& poses, double clock_ns) {
  force_simd_target(query.forced_target);
  const auto start_of_turn = Clock::now();
  for (const Pose& pose : poses) {
    run_query(query, surface, pose);
    if (nanoseconds(start_of_turn, Clock::now()) > kWarmUpNs) break;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto start = Clock::now();
    run_query(query, surface, poses[i]);
    const double time = std::max(0.0, nanoseconds(start, Clock::now()) - clock_ns);
    query.min_ns[i] = std::min(query.min_ns[i], time);
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

  std::vector<TimedQuery> queries;
  const auto add_query = [&](const Solver* solver, const std::string& forced_target) {
    TimedQuery query;
    query.row.mesh = model.name;
    query.row.triangles = model.source.triangles.size();
    query.row.regime = set.regime;
    query.row.method = solver == nullptr ? kMemoryReadRow : to_string(solver->method());
    query.solver = solver;
    query.forced_target = forced_target;
    query.min_ns.assign(set.poses.size(), std::numeric_limits<double>::max());
    if (solver != nullptr && solver->method() == Method::kHierarchical) {
      force_simd_target(forced_target);
      query.row.target = simd_target();
      query.row.tolerance = solver->tolerance();
    }
    queries.push_back(std::move(query));
  };
  add_query(nullptr, "");
  for (const Solver& solver : solvers) add_query(&solver, "");
  const std::vector<std::string> targets = simd_targets();
  const auto exact_hierarchical = std::find_if(
      solvers.begin(), solvers.end(), [](const Solver& s) { return s.method() == Method::kHierarchical; });
  for (std::size_t i = 1; i < targets.size(); ++i) add_query(&*exact_hierarchical, targets[i]);

  for (TimedQuery& query : queries) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    query.row.errors = {kNone, kNone, kNone, kNone, kNone};
    if (query.solver == nullptr) continue;
    force_simd_target(query.forced_target);
    const auto errors = measure_errors(model, *query.solver, set);
    force_simd_target("");
    if (!errors) return tl::unexpected(errors.error());
    query.row.errors = *errors;
  }

  const double clock_ns = clock_cost_ns();
  for (int i = 0; i < sweeps; ++i) {
    // The order alternates, because a branch predictor learns from the preceding method: each method follows
    // both of its neighbours.
    for (std::size_t n = 0; n < queries.size(); ++n) {
      TimedQuery& query = queries[i % 2 == 0 ? n : queries.size() - 1 - n];
      sweep(query, model.mesh.surface, set.poses, clock_ns);
    }
  }
  force_simd_target("");

  std::vector<Measurement> rows;
  rows.reserve(queries.size());
  for (TimedQuery& query : queries) {
    query.row.median_ns = median(std::move(query.min_ns));
    rows.push_back(std::move(query.row));
  }
  return rows;
}

}  // namespace buoyancy::bench
