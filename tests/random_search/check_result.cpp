#include "tests/random_search/check_result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "tests/hydrostatics/ball.h"

namespace buoyancy {
namespace {

// A ball's radius counts as error. The largest radius for which a ball is used, relative to the limit.
constexpr double kMaxRelativeRadius = 0.01;

template <typename T>
struct TrueWrench {
  Vec3T<T> force_W, torque_W;
};

template <typename T>
TrueWrench<T> true_wrench(const TriangleMesh& source, const SearchPose& requested) {
  const auto displaced = exact_displacement<T>(source, requested.pose, requested.water);
  const T weight = T(requested.water.density) * T(requested.water.gravity);
  return {requested.water.up_W.cast<T>() * T(weight * displaced.volume),
          exactly_in_world<T>(requested.pose, displaced.torque(requested.reference_B)) * weight};
}

class Truth {
 public:
  Truth(const TriangleMesh& source, const SearchPose& requested)
      : source_(&source), requested_(&requested), balls_(true_wrench<Ball>(source, requested)) {}

  // Upper bounds on the norms of the errors, from rational arithmetic where balls are too wide for the limit.
  double force_error(const Vec3& force_W, double limit) {
    return error(force_W, limit, &TrueWrench<Ball>::force_W, &TrueWrench<Rational>::force_W);
  }
  double torque_error(const Vec3& torque_W, double limit) {
    return error(torque_W, limit, &TrueWrench<Ball>::torque_W, &TrueWrench<Rational>::torque_W);
  }

 private:
  double error(const Vec3& found, double limit, Vec3T<Ball> TrueWrench<Ball>::*in_balls,
               Vec3T<Rational> TrueWrench<Rational>::*in_rationals) {
    const Vec3T<Ball>& ball = balls_.*in_balls;
    Vec3 max_error;
    Vec3 radius;
    for (int i = 0; i < 3; ++i) {
      max_error[i] = static_cast<double>(ball[i].distance(found[i]));
      radius[i] = static_cast<double>(ball[i].rad);
    }
    if (max_error.norm() <= limit && radius.norm() <= kMaxRelativeRadius * limit) return max_error.norm();
    if (!rationals_) rationals_ = true_wrench<Rational>(*source_, *requested_);
    const Vec3T<Rational> difference = found.cast<Rational>() - (*rationals_).*in_rationals;
    for (int i = 0; i < 3; ++i) max_error[i] = difference[i].convert_to<double>();
    return max_error.norm();
  }

  const TriangleMesh* source_;
  const SearchPose* requested_;
  TrueWrench<Ball> balls_;
  std::optional<TrueWrench<Rational>> rationals_;
};

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
        truth_(source, requested),
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
