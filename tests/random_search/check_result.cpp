#include "tests/random_search/check_result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "tests/hydrostatics/ball.h"

namespace buoyancy {
namespace {

// A ball's radius counts as error: as a share of what the error is compared with.
constexpr double kWidest = 0.01;

template <typename T>
struct TrueWrench {
  Vec3T<T> force_W, torque_W;
};

template <typename T>
TrueWrench<T> true_wrench(const TriangleMesh& source, const SearchPose& asked) {
  const auto displaced = exact_displacement<T>(source, asked.pose, asked.water);
  const T weight = T(asked.water.density) * T(asked.water.gravity);
  return {asked.water.up_W.cast<T>() * T(weight * displaced.volume),
          exactly_in_world<T>(asked.pose, displaced.torque(asked.reference_B)) * weight};
}

class Truth {
 public:
  Truth(const TriangleMesh& source, const SearchPose& asked)
      : source_(&source), asked_(&asked), balls_(true_wrench<Ball>(source, asked)) {}

  // Upper bounds on the norms of the errors; from rational arithmetic where balls are too wide beside the
  // limit.
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
    Vec3 most;
    Vec3 radius;
    for (int i = 0; i < 3; ++i) {
      most[i] = static_cast<double>(ball[i].distance(found[i]));
      radius[i] = static_cast<double>(ball[i].rad);
    }
    if (most.norm() <= limit && radius.norm() <= kWidest * limit) return most.norm();
    if (!rationals_) rationals_ = true_wrench<Rational>(*source_, *asked_);
    const Vec3T<Rational> difference = found.cast<Rational>() - (*rationals_).*in_rationals;
    for (int i = 0; i < 3; ++i) most[i] = difference[i].convert_to<double>();
    return most.norm();
  }

  const TriangleMesh* source_;
  const SearchPose* asked_;
  TrueWrench<Ball> balls_;
  std::optional<TrueWrench<Rational>> rationals_;
};

double ratio(double value, double limit) {
  return value == 0.0 ? 0.0 : value / limit;
}

std::string line(const GivenResult& given, const char* what, double found, const char* expected,
                 double limit) {
  std::array<char, 200> text;
  std::snprintf(text.data(), text.size(), "%s%s%s: %s is %.17g, expected %s %.17g", to_string(given.answerer),
                given.target.empty() ? "" : " on ", given.target.c_str(), what, found, expected, limit);
  return text.data();
}

class Judge {
 public:
  Judge(const TriangleMesh& source, const HydrostaticMesh& mesh, const SearchPose& asked)
      : mesh_(mesh),
        asked_(asked),
        truth_(source, asked),
        weight_(asked.water.density * asked.water.gravity) {}

  void judge(const GivenResult& given, CheckReport& judgement) {
    Figures figures;
    const BuoyancyResult& result = given.result;
    auto& violations = judgement.violations;
    if (result.status != BuoyancyStatus::kOk || !result.force_W.allFinite() || !result.torque_W.allFinite() ||
        !std::isfinite(result.volume) || !result.center_of_buoyancy_W.allFinite()) {
      violations.push_back(
          line(given, "the status", static_cast<double>(result.status), "numbers and status", 0.0));
    } else {
      const double force_error = truth_.force_error(result.force_W, result.force_error_bound);
      const double torque_error = truth_.torque_error(result.torque_W, result.torque_error_bound);
      figures.force_over_bound = ratio(force_error, result.force_error_bound);
      figures.torque_over_bound = ratio(torque_error, result.torque_error_bound);
      if (!(force_error <= result.force_error_bound))
        violations.push_back(
            line(given, "the error of force", force_error, "at most its bound,", result.force_error_bound));
      if (!(torque_error <= result.torque_error_bound))
        violations.push_back(line(given, "the error of torque", torque_error, "at most its bound,",
                                  result.torque_error_bound));
      const Method method = method_of(given.answerer);
      const Gates gate = gates(method, mesh_, asked_);
      if (given.answerer == Evaluator::kTolerance) {
        const double least =
            mesh_.meets_volume_tolerance() ? 4.0 * mesh_.volume_tolerance() : mesh_.max_rounding_bound();
        const double most = std::max(asked_.tolerance * mesh_.volume, least) * weight_;
        if (!(result.force_error_bound <= most * (1.0 + 1e-12)))
          violations.push_back(line(given, "the bound of force", result.force_error_bound, "at most", most));
      } else if (is_exact(method) && mesh_.meets_volume_tolerance()) {
        figures.force_over_gate = ratio(force_error, gate.volume * weight_);
        figures.torque_over_gate = ratio(torque_error, gate.torque * weight_);
        if (!(figures.force_over_gate <= 1.0))
          violations.push_back(
              line(given, "the error of force", force_error, "at most rho g G_V,", gate.volume * weight_));
        if (!(figures.torque_over_gate <= 1.0))
          violations.push_back(line(given, "the error of torque", torque_error, "at most rho g G_tau,",
                                    gate.torque * weight_));
      }
    }
    judgement.figures.push_back(figures);
  }

 private:
  const HydrostaticMesh& mesh_;
  const SearchPose& asked_;
  Truth truth_;
  double weight_;  // [N/m^3]
};

}  // namespace

const char* to_string(Evaluator answerer) {
  constexpr std::array kNames{"exact",    "exact_surface", "hierarchical", "hierarchical within a tolerance",
                              "improved", "fast_surface",  "fast"};
  return kNames[static_cast<std::size_t>(answerer)];
}

Method method_of(Evaluator answerer) {
  constexpr std::array kMethods{Method::kExact,        Method::kExactSurface, Method::kHierarchical,
                                Method::kHierarchical, Method::kImproved,     Method::kFastSurface,
                                Method::kFast};
  return kMethods[static_cast<std::size_t>(answerer)];
}

Gates gates(Method method, const HydrostaticMesh& mesh, const SearchPose& asked) {
  double volume = mesh.volume_tolerance();
  if (method != Method::kHierarchical) {
    volume *= 1.0 + std::abs(water_plane_in_body(asked.pose, asked.water, mesh.center_B).h_c) / mesh.diagonal;
  }
  return {volume, volume * mesh.max_lever_arm(asked.reference_B)};
}

CheckReport judge(const TriangleMesh& source, const HydrostaticMesh& mesh, const SearchPose& asked,
                const std::vector<GivenResult>& results) {
  CheckReport judgement;
  judgement.figures.reserve(results.size());
  Judge with_truth(source, mesh, asked);
  for (const GivenResult& given : results) with_truth.judge(given, judgement);
  return judgement;
}

}  // namespace buoyancy
