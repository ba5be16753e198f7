#include "time_queries.h"

#include <algorithm>
#include <limits>

#include "clock_cost.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "median.h"
#include "memory_read_baseline.h"
#include "unit_water.h"

namespace buoyancy::bench {
namespace {

constexpr double kWarmUpNs = 2e7;

// Sinks for the results, so that the compiler cannot omit a query.
volatile double result_sink;
volatile std::uint64_t read_sink;

// One row of the results and the data needed to time it.
struct TimedQuery {
  Measurement row;
  const Solver* solver = nullptr;  // nullptr: the plain method or the memory read baseline
  PlainExact* plain = nullptr;     // nullptr: a solver or the memory read baseline
  std::string forced_target;       // "": the best instruction set
  std::vector<double> min_ns;      // per pose
};

void run_query(const TimedQuery& query, const TriangleMesh& surface, const Pose& pose) {
  if (query.solver != nullptr) {
    result_sink = buoyancy(*query.solver, pose, kUnitWater, Vec3::Zero()).volume;
  } else if (query.plain != nullptr) {
    result_sink = (*query.plain)(pose, kUnitWater, Vec3::Zero()).volume;
  } else {
    read_sink = read_vertices_and_indices(surface);
  }
}

// The queries of a mesh, with the errors of their results.
class QueryTimer {
 public:
  QueryTimer(const BenchmarkMesh& model, const PoseSet& set)
      : model_(model), set_(set), plain_(model.source), clock_ns_(clock_cost_ns()) {}

  void add_read() { add(nullptr, nullptr, "", kMemoryReadRow); }
  void add_plain() { add(nullptr, &plain_, "", kPlainRow); }
  // solver must outlive the timer.
  void add(const Solver& solver, const std::string& forced_target = "") {
    add(&solver, nullptr, forced_target, std::string(to_string(solver.method())));
    if (solver.method() != Method::kHierarchical && solver.method() != Method::kExact) return;
    force_simd_target(forced_target);
    queries_.back().row.target = simd_target();
    queries_.back().row.tolerance = solver.tolerance();
    force_simd_target("");
  }

  Expected<void> check() {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    for (TimedQuery& query : queries_) {
      query.row.errors = {kNone, kNone, kNone, kNone, kNone};
      if (query.plain != nullptr) query.row.errors = measure_errors(model_, *query.plain, set_);
      if (query.solver == nullptr) continue;
      force_simd_target(query.forced_target);
      const auto errors = measure_errors(model_, *query.solver, set_);
      force_simd_target("");
      if (!errors) return tl::unexpected(errors.error());
      query.row.errors = *errors;
    }
    return {};
  }

  // Calls turn(query) for every query in every sweep. The order alternates, because a branch predictor learns
  // from the preceding method: each method follows both of its neighbours.
  template <typename Turn>
  void run(int sweeps, const Turn& turn) {
    for (int i = 0; i < sweeps; ++i) {
      for (std::size_t n = 0; n < queries_.size(); ++n) {
        TimedQuery& query = queries_[i % 2 == 0 ? n : queries_.size() - 1 - n];
        force_simd_target(query.forced_target);
        turn(query);
      }
    }
    force_simd_target("");
  }

  // One untimed sweep, limited to kWarmUpNs.
  void warm_up(const TimedQuery& query) const {
    const auto start = Clock::now();
    for (const Pose& pose : set_.poses) {
      run_query(query, model_.mesh.surface, pose);
      if (nanoseconds(start, Clock::now()) > kWarmUpNs) break;
    }
  }

  // One timed sweep, with before_query() before each query.
  template <typename BeforeQuery>
  void time(TimedQuery& query, const BeforeQuery& before_query) const {
    for (std::size_t i = 0; i < set_.poses.size(); ++i) {
      before_query();
      const auto start = Clock::now();
      run_query(query, model_.mesh.surface, set_.poses[i]);
      const double ns = std::max(0.0, nanoseconds(start, Clock::now()) - clock_ns_);
      query.min_ns[i] = std::min(query.min_ns[i], ns);
    }
  }

  std::vector<Measurement> rows() const {
    std::vector<Measurement> rows;
    rows.reserve(queries_.size());
    for (const TimedQuery& query : queries_) {
      rows.push_back(query.row);
      rows.back().median_ns = median(query.min_ns);
    }
    return rows;
  }

 private:
  void add(const Solver* solver, PlainExact* plain, const std::string& forced_target,
           const std::string& method) {
    TimedQuery query;
    query.row.mesh = model_.name;
    query.row.triangles = model_.source.triangles.size();
    query.row.regime = set_.regime;
    query.row.method = method;
    query.solver = solver;
    query.plain = plain;
    query.forced_target = forced_target;
    query.min_ns.assign(set_.poses.size(), std::numeric_limits<double>::max());
    queries_.push_back(std::move(query));
  }

  const BenchmarkMesh& model_;
  const PoseSet& set_;
  PlainExact plain_;
  double clock_ns_;
  std::vector<TimedQuery> queries_;
};

}  // namespace

Expected<std::vector<Measurement>> time_queries(const BenchmarkMesh& model, const PoseSet& set, int sweeps) {
  std::vector<Solver> solvers;
  solvers.reserve(kAllMethods.size() + kMeasuredTolerances.size());
  for (const Method method : kAllMethods) {
    if (method != Method::kHierarchical) solvers.emplace_back(model.mesh, method);
  }
  for (const double tolerance : kMeasuredTolerances)
    solvers.emplace_back(model.mesh, Method::kHierarchical, tolerance);

  QueryTimer timer(model, set);
  timer.add_read();
  timer.add_plain();
  for (const Solver& solver : solvers) timer.add(solver);
  const std::vector<std::string> targets = simd_targets();
  for (const Method method : {Method::kExact, Method::kHierarchical}) {
    const auto solver =
        std::find_if(solvers.begin(), solvers.end(), [&](const Solver& s) { return s.method() == method; });
    for (std::size_t i = 1; i < targets.size(); ++i) timer.add(*solver, targets[i]);
  }
  if (const auto checked = timer.check(); !checked) return tl::unexpected(checked.error());

  timer.run(sweeps, [&](TimedQuery& query) {
    timer.warm_up(query);
    timer.time(query, [] {});
  });
  return timer.rows();
}

Expected<std::vector<Measurement>> time_cold_queries(const BenchmarkMesh& model, const PoseSet& set,
                                                     int sweeps, CacheFlush& flush) {
  const Solver exact(model.mesh, Method::kExact);
  const Solver hierarchical(model.mesh, Method::kHierarchical);
  QueryTimer timer(model, set);
  timer.add_read();
  timer.add_plain();
  timer.add(exact);
  timer.add(hierarchical);
  if (const auto checked = timer.check(); !checked) return tl::unexpected(checked.error());

  timer.run(sweeps, [&](TimedQuery& query) { timer.time(query, [&] { flush(); }); });
  return timer.rows();
}

}  // namespace buoyancy::bench
