#include "reference_results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "base/format.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "median.h"
#include "tests/truth/exact_oracle.h"
#include "unit_water.h"

namespace buoyancy::bench {
namespace {

ReferenceResult reference_result(const TriangleMesh& source, const Pose& pose) {
  const auto oracle = exact_displacement<long double>(source, pose, kUnitWater);
  return {static_cast<double>(oracle.volume) * kUnitWater.up_W,
          pose.q_WB.normalized() * oracle.torque(Vec3::Zero()).cast<double>()};
}

std::string numbers(const Eigen::VectorXd& values) {
  std::string text;
  for (const double value : values) {
    text += ' ';
    text += format_shortest(value);
  }
  return text;
}

std::string subject(const BenchmarkMesh& model, const Solver& solver, const PoseSet& set, std::size_t index) {
  const Pose& pose = set.poses[index];
  std::string text = model.name + " of " + std::to_string(model.source.triangles.size()) + " triangles, " +
                     std::string(to_string(solver.method()));
  if (solver.method() == Method::kHierarchical)
    text += " at tolerance " + format_shortest(solver.tolerance()) + " on " + simd_target();
  const Eigen::Vector4d q_WB(pose.q_WB.w(), pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z());
  text += ", " + set.regime + " pose " + std::to_string(index) + " (p_WB" + numbers(pose.p_WB) + ", q_WB" +
          numbers(q_WB);
  return text + ")";
}

}  // namespace

PoseSet with_reference_results(std::string regime, std::vector<Pose> poses, const TriangleMesh& source) {
  PoseSet set{std::move(regime), std::move(poses), {}};
  set.truth.resize(set.poses.size());
  const std::size_t workers = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::jthread> threads;
  threads.reserve(workers);
  for (std::size_t worker = 0; worker < workers; ++worker) {
    threads.emplace_back([&, worker] {
      for (std::size_t i = worker; i < set.poses.size(); i += workers)
        set.truth[i] = reference_result(source, set.poses[i]);
    });
  }
  threads.clear();  // joins them
  return set;
}

Expected<SolverErrors> measure_errors(const BenchmarkMesh& model, const Solver& solver, const PoseSet& set) {
  const double whole = model.mesh.volume;  // rho g V_T
  const double whole_moment = whole * model.mesh.diagonal;
  constexpr double kMaxPaperBound = 1e-11;
  const double max_bound = solver.method() == Method::kHierarchical
                               ? std::max(solver.tolerance(), 4.0 * model.mesh.volume_tolerance() / whole)
                               : kMaxPaperBound;
  SolverErrors errors;
  std::vector<double> force_errors;
  std::vector<double> bounds;
  for (std::size_t i = 0; i < set.poses.size(); ++i) {
    const BuoyancyResult result = buoyancy(solver, set.poses[i], kUnitWater, Vec3::Zero());
    const double force_error = (result.force_W - set.truth[i].force_W).norm() / whole;
    const double torque_error = (result.torque_W - set.truth[i].torque_W).norm() / whole_moment;
    const double force_bound = result.force_error_bound / whole;
    const double torque_bound = result.torque_error_bound / whole_moment;
    const auto violation = [&](const std::string& actual, const std::string& expected) {
      return make_error({subject(model, solver, set, i), actual, expected + " of the whole", "", ""});
    };
    // The conditions are negated so that NaN is an error.
    if (!(force_error <= force_bound))
      return violation("force is off by " + format_shortest(force_error),
                       "at most " + format_shortest(force_bound));
    if (!(torque_error <= torque_bound))
      return violation("torque is off by " + format_shortest(torque_error),
                       "at most " + format_shortest(torque_bound));
    if (is_exact(solver.method()) && !(force_bound <= max_bound))
      return violation("the force bound is " + format_shortest(force_bound),
                       "at most " + format_shortest(max_bound));
    force_errors.push_back(force_error);
    bounds.push_back(force_bound);
    errors.force = std::max(errors.force, force_error);
    errors.torque = std::max(errors.torque, torque_error);
  }
  errors.force_median = median(force_errors);
  errors.bound = *std::max_element(bounds.begin(), bounds.end());
  errors.bound_median = median(bounds);
  return errors;
}

SolverErrors measure_errors(const BenchmarkMesh& model, PlainExact& plain, const PoseSet& set) {
  const double whole = model.mesh.volume;  // rho g V_T
  SolverErrors errors;
  std::vector<double> force_errors;
  for (std::size_t i = 0; i < set.poses.size(); ++i) {
    const PlainWrench wrench = plain(set.poses[i], kUnitWater, Vec3::Zero());
    const double torque_error = (wrench.torque_W - set.truth[i].torque_W).norm();
    force_errors.push_back((wrench.force_W - set.truth[i].force_W).norm() / whole);
    errors.torque = std::max(errors.torque, torque_error / (whole * model.mesh.diagonal));
  }
  errors.force = *std::max_element(force_errors.begin(), force_errors.end());
  errors.force_median = median(force_errors);
  errors.bound = errors.bound_median = std::numeric_limits<double>::quiet_NaN();
  return errors;
}

}  // namespace buoyancy::bench
