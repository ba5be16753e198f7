#include "service/hydrostatics/righting_results.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "base/angles.h"

namespace buoyancy::service {
namespace {

constexpr double kThirty = 30.0 * kRadiansPerDegree;
constexpr double kForty = 40.0 * kRadiansPerDegree;
constexpr int kMaxHeel = 90;  // [degrees], of the criteria

// Returns the heels of the criteria: each degree up to 90, or up to the angle of downflooding and that angle.
std::vector<double> heels_of_criteria(double flooding) {
  std::vector<double> heels;
  for (int heel = 0; heel <= kMaxHeel && heel * kRadiansPerDegree <= flooding; ++heel) {
    heels.push_back(heel * kRadiansPerDegree);
  }
  if (flooding > heels.back() && flooding < kMaxHeel * kRadiansPerDegree) heels.push_back(flooding);
  return heels;
}

// Returns the options with a progress that counts on from `before` to a total with `extra` more heels.
RightingArmOptions with_progress(const RightingArmOptions& options, std::int64_t before, std::int64_t extra) {
  RightingArmOptions counted = options;
  if (!options.progress) return counted;
  counted.progress = [&options, before, extra](std::int64_t done, std::int64_t total) {
    options.progress(before + done, total + extra);
  };
  return counted;
}

// Returns the area [m rad] under the curve up to one of its heels, or up to its end if that comes first.
double area_to(const RightingCurve& curve, double heel) {
  const auto found = std::ranges::find_if(
      curve.points, [heel](const RightingCurvePoint& point) { return point.arm.heel >= heel; });
  return found == curve.points.end() ? curve.points.back().area : found->area;
}

// flooding: [rad], the angle of downflooding to starboard; infinity: none. The curve ends there, since the
// criteria count no stability beyond. Returns none if an arm up to there, or up to 90 degrees, is unknown.
std::vector<StabilityCriterion> general_criteria(const FloatingBody& body, const Water& water,
                                                 double flooding, const RightingArmOptions& options) {
  const auto curve = righting_curve(body, water, heels_of_criteria(flooding), options);
  const std::optional<double> gm = upright_metacentric_height(body, water, options);
  if (!curve || curve->unbalanced_starboard || !gm) return {};

  const bool reaches_thirty = flooding >= kThirty;
  const double to_thirty = area_to(*curve, kThirty);
  const double to_end = area_to(*curve, kForty);
  std::string end_text = "40 degrees";
  std::string thirty_text = "30 degrees";
  if (flooding < kForty) {
    end_text = fmt::format("downflooding at {:.4g} degrees", flooding / kRadiansPerDegree);
    if (!reaches_thirty) thirty_text += ", cut at downflooding";
  }
  double max_beyond_thirty = reaches_thirty ? -std::numeric_limits<double>::infinity() : 0.0;
  for (const auto& [arm, area] : curve->points) {
    if (arm.heel >= kThirty) max_beyond_thirty = std::max(max_beyond_thirty, arm.gz);
  }
  const double heel_of_max = curve->max_starboard ? curve->max_starboard->heel : 0.0;
  if (curve->max_starboard && heel_of_max >= kThirty) {
    max_beyond_thirty = std::max(max_beyond_thirty, curve->max_starboard->gz);
  }
  return {{"area from 0 to " + thirty_text, to_thirty, 0.055, "m rad", reaches_thirty},
          {"area from 0 to " + end_text, to_end, 0.090, "m rad"},
          {"area from 30 to " + end_text, to_end - to_thirty, 0.030, "m rad"},
          {"largest GZ at 30 degrees or more", max_beyond_thirty, 0.20, "m"},
          {"heel of the largest GZ", heel_of_max / kRadiansPerDegree, 25.0, "degrees"},
          {"GM at heel 0", *gm, 0.15, "m"}};
}

std::optional<FirstImmersions> immersions(const FloatingBody& body, const Water& water,
                                          const std::vector<Vec3>& points_B,
                                          const RightingArmOptions& options) {
  if (points_B.empty()) return std::nullopt;
  return first_immersions(body, water, points_B, options);
}

}  // namespace

std::optional<RightingResults> righting_results(const FloatingBody& body, const Water& water,
                                                std::span<const double> heels, const ImmersionPoints& points,
                                                const RightingArmOptions& options,
                                                const WeatherInputs* weather) {
  const auto count = static_cast<std::int64_t>(heels.size());
  constexpr std::int64_t kCriteriaHeels = kMaxHeel + 1;
  std::optional<RightingCurve> curve =
      righting_curve(body, water, heels, with_progress(options, 0, kCriteriaHeels));
  if (!curve) return std::nullopt;
  RightingResults results{.curve = *std::move(curve),
                          .criteria = {},
                          .deck_edge = immersions(body, water, points.deck_edge_B, options),
                          .downflooding = immersions(body, water, points.downflooding_B, options)};
  CriticalHeels critical;
  for (const auto& [found, heel] : {std::pair{&results.deck_edge, &critical.deck_edge},
                                    std::pair{&results.downflooding, &critical.downflooding}}) {
    if (*found && (*found)->starboard) *heel = (*found)->starboard->heel;
  }
  results.criteria =
      general_criteria(body, water, critical.downflooding, with_progress(options, count, count));
  if (weather != nullptr) {
    RightingArmOptions quiet = options;
    quiet.progress = nullptr;
    results.asks_weather = true;
    results.weather = weather_criterion(body, water, weather->exposure, *weather->table, critical, quiet);
  }
  return results;
}

}  // namespace buoyancy::service
