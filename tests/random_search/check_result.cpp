#include "tests/random_search/check_result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/truth/truth.h"

namespace buoyancy {
namespace {

double ratio(double value, double limit) {
  return value == 0.0 ? 0.0 : value / limit;
}

std::string line(const GivenResult& given, const char* what, double found, const char* expected,
                 double limit) {
  std::array<char, 200> text;
  std::snprintf(text.data(), text.size(), "%s%s%s: %s is %.17g, expected %s %.17g",
                to_string(given.evaluator), given.target.empty() ? "" : " on ", given.target.c_str(), what,
                found, expected, limit);
  return text.data();
}

class ResultChecker {
 public:
  ResultChecker(const TriangleMesh& source, const HydrostaticMesh& mesh, const SearchPose& requested)
      : mesh_(mesh),
        requested_(requested),
        truth_({&source}, requested.pose, requested.water, requested.reference_B),
        weight_(requested.water.density * requested.water.gravity) {}

  void check(const GivenResult& given, CheckReport& report) {
    Figures figures;
    const BuoyancyResult& result = given.result;
    auto& violations = report.violations;
    if (result.status != BuoyancyStatus::kOk || !result.force_W.allFinite() || !result.torque_W.allFinite() ||
        !std::isfinite(result.volume) || !result.center_of_buoyancy_W.allFinite()) {
      violations.push_back(
          line(given, "the status", static_cast<double>(result.status), "finite numbers and status", 0.0));
    } else {
      const double force_error = truth_.force_error(result.force_W, result.force_error_bound);
      const double torque_error = truth_.torque_error(result.torque_W, result.torque_error_bound);
      figures.force_over_bound = ratio(force_error, result.force_error_bound);
      figures.torque_over_bound = ratio(torque_error, result.torque_error_bound);
      if (!(force_error <= result.force_error_bound))
        violations.push_back(
            line(given, "the force error", force_error, "at most its bound", result.force_error_bound));
      if (!(torque_error <= result.torque_error_bound))
        violations.push_back(
            line(given, "the torque error", torque_error, "at most its bound", result.torque_error_bound));
      const Method method = method_of(given.evaluator);
      const Gates gate = gates(method, mesh_, requested_);
      if (given.evaluator == Evaluator::kTolerance) {
        const double min_bound =
            mesh_.meets_volume_tolerance() ? 4.0 * mesh_.volume_tolerance() : mesh_.max_rounding_bound();
        const double allowed = std::max(requested_.tolerance * mesh_.volume, min_bound) * weight_;
        if (!(result.force_error_bound <= allowed * (1.0 + 1e-12)))
          violations.push_back(
              line(given, "the force error bound", result.force_error_bound, "at most", allowed));
      } else if (is_exact(method) && mesh_.meets_volume_tolerance()) {
        figures.force_over_gate = ratio(force_error, gate.volume * weight_);
        figures.torque_over_gate = ratio(torque_error, gate.torque * weight_);
        if (!(figures.force_over_gate <= 1.0))
          violations.push_back(
              line(given, "the force error", force_error, "at most rho g G_V =", gate.volume * weight_));
        if (!(figures.torque_over_gate <= 1.0))
          violations.push_back(
              line(given, "the torque error", torque_error, "at most rho g G_tau =", gate.torque * weight_));
      }
    }
    report.figures.push_back(figures);
  }

 private:
  const HydrostaticMesh& mesh_;
  const SearchPose& requested_;
  Truth truth_;
  double weight_;  // [N/m^3]
};

}  // namespace

const char* to_string(Evaluator evaluator) {
  constexpr std::array kNames{"exact",    "exact_surface", "hierarchical", "hierarchical within a tolerance",
                              "improved", "fast_surface",  "fast"};
  return kNames[static_cast<std::size_t>(evaluator)];
}

Method method_of(Evaluator evaluator) {
  constexpr std::array kMethods{Method::kExact,        Method::kExactSurface, Method::kHierarchical,
                                Method::kHierarchical, Method::kImproved,     Method::kFastSurface,
                                Method::kFast};
  return kMethods[static_cast<std::size_t>(evaluator)];
}

Gates gates(Method method, const HydrostaticMesh& mesh, const SearchPose& requested) {
  double volume = mesh.volume_tolerance();
  if (method != Method::kHierarchical) {
    volume *= 1.0 + std::abs(water_plane_in_body(requested.pose, requested.water, mesh.center_B).h_c) /
                        mesh.diagonal;
  }
  return {volume, volume * mesh.max_lever_arm(requested.reference_B)};
}

CheckReport check_results(const TriangleMesh& source, const HydrostaticMesh& mesh,
                          const SearchPose& requested, const std::vector<GivenResult>& results) {
  CheckReport report;
  report.figures.reserve(results.size());
  ResultChecker checker(source, mesh, requested);
  for (const GivenResult& given : results) checker.check(given, report);
  return report;
}

}  // namespace buoyancy
