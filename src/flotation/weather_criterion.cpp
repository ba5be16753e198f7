#include "flotation/weather_criterion.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "base/angles.h"
#include "flotation/displaced_sum.h"

namespace buoyancy {
namespace {

struct TableEntry {
  double at = 0.0;
  double value = 0.0;
};

// 2008 IS Code, part A, tables 2.3.4-1 to 2.3.4-4. The row 3.3 of X1 is that of resolution A.562(14).
constexpr TableEntry kX1[] = {{2.4, 1.0},  {2.5, 0.98}, {2.6, 0.96}, {2.7, 0.95}, {2.8, 0.93}, {2.9, 0.91},
                              {3.0, 0.90}, {3.1, 0.88}, {3.2, 0.86}, {3.3, 0.84}, {3.4, 0.82}, {3.5, 0.80}};
constexpr TableEntry kX2[] = {{0.45, 0.75}, {0.50, 0.82}, {0.55, 0.89},
                              {0.60, 0.95}, {0.65, 0.97}, {0.70, 1.0}};
constexpr TableEntry kK[] = {{0.0, 1.0},  {1.0, 0.98}, {1.5, 0.95}, {2.0, 0.88},
                             {2.5, 0.79}, {3.0, 0.74}, {3.5, 0.72}, {4.0, 0.70}};
constexpr TableEntry kS[] = {{6.0, 0.100},  {7.0, 0.098},  {8.0, 0.093},  {12.0, 0.065},
                             {14.0, 0.053}, {16.0, 0.044}, {18.0, 0.038}, {20.0, 0.035}};

double interpolated(std::span<const TableEntry> table, double at) {
  const auto next = std::ranges::upper_bound(table, at, {}, &TableEntry::at);
  if (next == table.begin()) return table.front().value;
  if (next == table.end()) return table.back().value;
  const TableEntry& before = *(next - 1);
  return before.value + (at - before.at) / (next->at - before.at) * (next->value - before.value);
}

std::optional<RollForm> form_of(const FloatingBody& body, const Water& water, const HydrostaticTable& table,
                                const RightingArmOptions& options) {
  const std::optional<RightingArm> upright = righting_arm(body, water, 0.0, options);
  const std::optional<double> gm = upright_metacentric_height(body, water, options);
  if (!upright || !gm) return std::nullopt;
  const Vec3 up_B = up_at(options.axes, {0.0, upright->trim});
  const Vec3 keel_at_midship_B = table.midship() * options.axes.forward_B + table.keel() * options.axes.up_B;
  const double draft = -(upright->height + up_B.dot(keel_at_midship_B)) / up_B.dot(options.axes.up_B);
  const std::optional<HydrostaticRow> row = table.row(draft, upright->trim);
  if (!row || !(row->lwl > 0.0) || !(row->bwl > 0.0) || !(draft > 0.0)) return std::nullopt;
  const LiquidSum liquids = liquid_sum(body, up_B, FreeSurfaces::kNo);
  return RollForm{.length_wl = row->lwl,
                  .breadth = row->bwl,
                  .draft = draft,
                  .block = row->on_lwl.block,
                  .kg = options.axes.up_B.dot(total_center_of_mass_B(body, liquids)) - table.keel(),
                  .gm = *gm};
}

}  // namespace

RollToWindward roll_to_windward(const RollForm& form, const WeatherExposure& exposure) {
  const double breadth = form.breadth / form.draft;
  const double keels = 100.0 * exposure.bilge_keel_area / (form.length_wl * form.breadth);
  RollToWindward roll;
  roll.x1 = interpolated(kX1, breadth);
  roll.x2 = interpolated(kX2, form.block);
  roll.k = exposure.sharp_bilges ? 0.7 : interpolated(kK, keels);
  roll.r = std::max(0.73 + 0.6 * (form.kg - form.draft) / form.draft, 0.0);
  roll.c = 0.373 + 0.023 * breadth - 0.043 * form.length_wl / 100.0;
  roll.period = form.gm > 0.0 ? 2.0 * roll.c * form.breadth / std::sqrt(form.gm)
                              : std::numeric_limits<double>::infinity();
  roll.s = interpolated(kS, roll.period);
  roll.angle = 109.0 * kRadiansPerDegree * roll.k * roll.x1 * roll.x2 * std::sqrt(roll.r * roll.s);
  const double kg = form.kg / form.draft - 1.0;
  roll.breadth_in_range = breadth < 3.5;
  roll.kg_in_range = kg >= -0.3 && kg <= 0.5;
  roll.period_in_range = roll.period < 20.0;
  return roll;
}

std::optional<WeatherCriterion> weather_criterion(const FloatingBody& body, const Water& water,
                                                  const WeatherExposure& exposure,
                                                  const HydrostaticTable& table, const CriticalHeels& heels,
                                                  const RightingArmOptions& options) {
  constexpr int kLastHeel = 50;  // [degrees], the largest phi2
  constexpr double kEnd = kLastHeel * kRadiansPerDegree;
  const std::optional<RollForm> form = form_of(body, water, table, options);
  if (!form) return std::nullopt;
  WeatherCriterion result{.form = *form, .roll = roll_to_windward(*form, exposure)};
  result.lw1 = exposure.wind_pressure * exposure.windage_area * exposure.windage_lever /
               (water.gravity * body.total_mass());
  result.lw2 = 1.5 * result.lw1;
  result.steady_limit = std::min(16.0 * kRadiansPerDegree, 0.8 * heels.deck_edge);

  std::vector<double> degrees;
  for (int heel = 0; heel <= kLastHeel; ++heel) degrees.push_back(heel * kRadiansPerDegree);
  const std::optional<RightingCurve> curve = righting_curve(body, water, degrees, options);
  if (!curve || curve->unbalanced_starboard) return std::nullopt;
  const auto intercept = [&](double lever, double from, bool rises) -> std::optional<double> {
    for (std::size_t i = 1; i < curve->points.size(); ++i) {
      const RightingArm& low = curve->points[i - 1].arm;
      const RightingArm& high = curve->points[i].arm;
      const bool crosses = rises ? low.gz < lever && high.gz >= lever : low.gz >= lever && high.gz < lever;
      if (!crosses || high.heel <= from) continue;
      if (const auto arm = arm_at_lever(body, water, low, high, lever, options)) return arm->heel;
    }
    return std::nullopt;
  };
  result.steady_heel = intercept(result.lw1, 0.0, true);
  result.gust_heel = intercept(result.lw2, 0.0, true);
  if (!result.steady_heel || !result.gust_heel) return result;
  result.second_intercept = intercept(result.lw2, *result.gust_heel, false);
  result.end_heel = std::min({heels.downflooding, kEnd, result.second_intercept.value_or(kEnd)});

  // The areas are those of a curve through their ends.
  const double from = *result.steady_heel - result.roll.angle;
  std::vector<double> ends{from, *result.gust_heel, result.end_heel};
  for (int heel = static_cast<int>(std::ceil(from * kDegreesPerRadian)); heel <= kLastHeel; ++heel) {
    ends.push_back(heel * kRadiansPerDegree);
  }
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  const std::optional<RightingCurve> areas = righting_curve(body, water, ends, options);
  if (!areas || areas->points.size() != ends.size()) return std::nullopt;
  const auto net_area = [&](double low, double high) {  // of the arm over the lever of the gust
    const auto area_to = [&](double heel) {
      return areas->points[static_cast<std::size_t>(std::ranges::find(ends, heel) - ends.begin())].area;
    };
    return area_to(high) - area_to(low) - result.lw2 * (high - low);
  };
  result.area_a = -net_area(from, *result.gust_heel);
  if (result.end_heel > *result.gust_heel) result.area_b = net_area(*result.gust_heel, result.end_heel);
  return result;
}

}  // namespace buoyancy
