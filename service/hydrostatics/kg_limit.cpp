#include "service/hydrostatics/kg_limit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "base/angles.h"
#include "hydrostatics/hydrostatics.h"
#include "service/hydrostatics/table_columns.h"

namespace buoyancy::service {
namespace {

// How far the criterion that governs is met, as a share of what it requires; below 0: it is not met.
struct Margin {
  double value = 0.0;
  std::string criterion;
};

Margin margin_of(const std::optional<RightingResults>& results) {
  if (!results || results->criteria.empty() || (results->asks_weather && !results->weather)) {
    return {-1.0, "no righting arm at a heel that the criteria need"};
  }
  std::vector<Margin> margins;
  for (const StabilityCriterion& criterion : results->criteria) {
    margins.push_back(
        {criterion.reached ? criterion.value / criterion.required - 1.0 : -1.0, criterion.name});
  }
  if (const std::optional<WeatherCriterion>& weather = results->weather) {
    const double heel = weather->steady_heel ? 1.0 - *weather->steady_heel / weather->steady_limit : -1.0;
    const bool has_areas = weather->gust_heel && weather->end_heel > *weather->gust_heel;
    margins.push_back({heel, "weather criterion: heel in the steady wind"});
    margins.push_back(
        {has_areas ? weather->area_b / weather->area_a - 1.0 : -1.0, "weather criterion: area b over a"});
  }
  return *std::ranges::min_element(margins, {}, &Margin::value);
}

}  // namespace

std::optional<KgLimit> kg_limit(const FloatingBody& body, const Water& water, const HydrostaticTable& table,
                                double draft, double trim, const ImmersionPoints& points,
                                const RightingArmOptions& options, const WeatherInputs* weather) {
  const std::optional<HydrostaticRow> row = table.row(draft, trim);
  if (!row || !(row->volume > body.volume_tolerance()) || !(row->waterplane_area > 0.0)) {
    return std::nullopt;
  }
  const ShipAxes& axes = options.axes;
  const auto at = [&](double kg) -> Margin {
    const double lcg = table.midship() + row->lcb + (kg - row->kb) * std::tan(trim);
    const Vec3 center_B = lcg * axes.forward_B + row->tcb * axes.port_B() + (table.keel() + kg) * axes.up_B;
    const Expected<FloatingBody> loaded = with_mass(body, row->mass, center_B, {});
    if (!loaded) return margin_of(std::nullopt);
    return margin_of(righting_results(*loaded, water, std::array{0.0}, points, options, weather));
  };

  constexpr int kSteps = 20;
  KgLimit limit{.draft = draft, .trim = trim, .mass = row->mass, .kg_max = {}, .governing = {}};
  double high = row->km_t;
  Margin above = at(high);
  for (int step = kSteps - 1; step >= 0; --step) {
    double low = row->km_t * step / kSteps;
    Margin below = at(low);
    if (below.value < 0.0) {
      high = low;
      above = std::move(below);
      continue;
    }
    constexpr double kAccuracy = 1e-6;  // [m]
    for (int round = 0; high - low > kAccuracy; ++round) {
      double kg = 0.5 * (low + high);
      if (round % 3 != 2) kg = low + (high - low) * below.value / (below.value - above.value);
      kg = std::clamp(kg, low + 0.4 * kAccuracy, high - 0.4 * kAccuracy);
      Margin margin = at(kg);
      const bool is_met = margin.value >= 0.0;
      (is_met ? low : high) = kg;
      (is_met ? below : above) = std::move(margin);
    }
    limit.kg_max = low;
    break;
  }
  limit.governing = above.criterion;
  return limit;
}

std::string kg_limits_text(const std::vector<KgLimit>& limits) {
  std::string text =
      "Largest KG over the keel at which the criteria of the 2008 IS Code are met (not a class approval).\n" +
      fmt::format("{:>10}{:>10}{:>16}{:>12}  {}\n", "draft, m", "trim, deg", "displacement, t", "KG max, m",
                  "governing criterion");
  for (const KgLimit& limit : limits) {
    text += fmt::format("{:>10.5g}{:>10.4g}{:>16.8g}{:>12}  {}\n", limit.draft,
                        limit.trim * kDegreesPerRadian, limit.mass * kTonnesPerKilogram,
                        limit.kg_max ? fmt::format("{:.6f}", *limit.kg_max) : "none", limit.governing);
  }
  return text;
}

Json kg_limits_json(const std::vector<KgLimit>& limits) {
  Json rows = Json::array();
  for (const KgLimit& limit : limits) {
    rows.push_back({{"draft", limit.draft},
                    {"trim", limit.trim * kDegreesPerRadian},
                    {"displacement", limit.mass * kTonnesPerKilogram},
                    {"kg_max", limit.kg_max},
                    {"governing", limit.governing}});
  }
  return {{"source", "2008 IS Code A 2.2, and A 2.3 if asked for; not a class approval"},
          {"rows", std::move(rows)}};
}

std::string kg_limits_csv(const std::vector<KgLimit>& limits) {
  std::string text = "draft,trim,displacement,kg_max,governing\n";
  for (const KgLimit& limit : limits) {
    text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{}\n", limit.draft, limit.trim * kDegreesPerRadian,
                        limit.mass * kTonnesPerKilogram, limit.kg_max.value_or(kNaN), limit.governing);
  }
  return text;
}

}  // namespace buoyancy::service
