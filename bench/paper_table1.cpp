// Reproduces the paper's table 1: time of the five algorithms on its three models, together with their
// errors, beside the read baseline and the plain method (plain_exact.h).
//
// The iterations cycle through 100 poses from almost dry to almost submerged. The errors are the largest ones
// over these poses against extended precision, relative to the whole: force to rho g V_T, torque to rho g V_T
// L. They are computed, and checked for the exact methods, before anything is timed.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <benchmark/benchmark.h>

#include "benchmark_meshes.h"
#include "hydrostatics/buoyancy.h"
#include "memory_read_baseline.h"
#include "plain_exact.h"
#include "pose_sweep.h"
#include "tests/truth/exact_oracle.h"
#include "unit_water.h"

namespace buoyancy::bench {
namespace {

struct Errors {
  double force = 0.0, torque = 0.0;
};

// evaluate(pose): returns force_W and torque_W.
template <typename Evaluate>
Errors max_errors(const BenchmarkMesh& model, const std::vector<Pose>& poses, const Evaluate& evaluate) {
  Errors errors;
  const double volume = model.mesh.volume;
  for (const Pose& pose : poses) {
    const auto result = evaluate(pose);
    const auto oracle = exact_displacement<long double>(model.source, pose, kUnitWater);
    const Vec3 force_W = static_cast<double>(oracle.volume) * kUnitWater.up_W;
    const Vec3 torque_W = pose.q_WB * oracle.torque(Vec3::Zero()).cast<double>();
    errors.force = std::max(errors.force, (result.force_W - force_W).norm() / volume);
    errors.torque =
        std::max(errors.torque, (result.torque_W - torque_W).norm() / (volume * model.mesh.diagonal));
  }
  return errors;
}

// Sets the same counters for every row, since the library's CSV has one header.
void set_counters(benchmark::State& state, const HydrostaticMesh& mesh, const Errors& errors) {
  state.counters["per_triangle"] =
      benchmark::Counter(static_cast<double>(mesh.surface.triangles.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["force_error"] = errors.force;
  state.counters["torque_error"] = errors.torque;
}

// Lower bound for any method that visits every triangle.
void read_mesh(benchmark::State& state, const HydrostaticMesh& mesh) {
  for (auto _ : state) benchmark::DoNotOptimize(read_vertices_and_indices(mesh.surface));
  set_counters(state, mesh, {});
}

template <typename Evaluate>
void query_sweep(benchmark::State& state, const BenchmarkMesh& model, const std::vector<Pose>& poses,
                 const Errors& errors, const Evaluate& evaluate) {
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(evaluate(poses[i]));
    i = i + 1 == poses.size() ? 0 : i + 1;
  }
  set_counters(state, model.mesh, errors);
}

// Computes the errors and registers the sweep.
template <typename Evaluate>
Errors register_sweep(const std::string& name, const BenchmarkMesh& model, const std::vector<Pose>& poses,
                      const Evaluate& evaluate) {
  const Errors errors = max_errors(model, poses, evaluate);
  benchmark::RegisterBenchmark(name.c_str(), [&model, &poses, errors, evaluate](benchmark::State& state) {
    query_sweep(state, model, poses, errors, evaluate);
  });
  return errors;
}

int run(int argc, char** argv) {
  const std::vector<BenchmarkMesh> models = paper_meshes();
  std::vector<std::vector<Pose>> sweeps;
  std::vector<Solver> solvers;
  std::vector<PlainExact> plain_methods;
  sweeps.reserve(models.size());
  plain_methods.reserve(models.size());
  solvers.reserve(models.size() * kAllMethods.size());
  for (const BenchmarkMesh& model : models) sweeps.push_back(sweep_of_poses(model.source));
  for (const BenchmarkMesh& model : models) {
    for (const Method method : kAllMethods) solvers.emplace_back(model.mesh, method);
    plain_methods.emplace_back(model.source);
  }
  for (std::size_t m = 0; m < models.size(); ++m) {
    const std::string model = models[m].name + "/" + std::to_string(models[m].mesh.surface.triangles.size());
    benchmark::RegisterBenchmark((model + "/read vertices and indices").c_str(),
                                 [&, m](benchmark::State& state) { read_mesh(state, models[m].mesh); });
    PlainExact& plain = plain_methods[m];
    register_sweep(model + "/plain", models[m], sweeps[m],
                   [&plain](const Pose& pose) { return plain(pose, kUnitWater, Vec3::Zero()); });
    for (std::size_t i = 0; i < kAllMethods.size(); ++i) {
      const Solver& solver = solvers[m * kAllMethods.size() + i];
      const Errors errors = register_sweep(
          model + "/" + std::string(to_string(solver.method())), models[m], sweeps[m],
          [&solver](const Pose& pose) { return buoyancy(solver, pose, kUnitWater, Vec3::Zero()); });
      if (is_exact(solver.method()) && !(errors.force < 1e-12 && errors.torque < 1e-12)) {
        std::fprintf(stderr, "%s on %s: error %g of the whole in force, %g in torque; expected below 1e-12\n",
                     std::string(to_string(solver.method())).c_str(), model.c_str(), errors.force,
                     errors.torque);
        return EXIT_FAILURE;
      }
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  return buoyancy::bench::run(argc, argv);
}
