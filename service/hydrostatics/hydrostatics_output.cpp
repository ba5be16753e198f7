#include "service/hydrostatics/hydrostatics_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "base/angles.h"
#include "service/hydrostatics/table_columns.h"

namespace buoyancy::service {
namespace {

double degrees(double radians) {
  return radians * kDegreesPerRadian;
}

}  // namespace

std::string csv_row(const std::vector<double>& values) {
  std::string row;
  for (const double value : values) row += fmt::format("{}{:.17g}", row.empty() ? "" : ",", value);
  row += '\n';
  return row;
}

std::string gm_about_axis(double height, const Vec3& axis_B) {
  return fmt::format("GM {:.4g} m about the axis ({:.3f}, {:.3f}, {:.3f}) of the body", height, axis_B.x(),
                     axis_B.y(), axis_B.z());
}

std::string outcome_sentence(FlotationOutcome outcome) {
  switch (outcome) {
    case FlotationOutcome::kFloats:
      return "The body floats.";
    case FlotationOutcome::kSinks:
      return "The body sinks: it is heavier than the water that it can displace.";
    case FlotationOutcome::kNeutral:
      return "The body is neutrally buoyant: it rests at any depth, its centre of mass under that of "
             "buoyancy.";
    case FlotationOutcome::kTakesInWater:
      return "The mesh is open, and its edge is under water before the body floats at rest.";
    case FlotationOutcome::kOutOfRange:
      break;
  }
  return "No attitude was found: the numbers of the body are out of range.";
}

namespace {

// Returns why an attitude is not stable; empty if it is.
std::string reason(const Equilibrium& at) {
  std::string text;
  for (std::size_t i = 0; i < 2; ++i) {
    const double height = at.state.hydrostatics.metacentric_heights[i];
    if (at.is_stable() || !(height < 0.0)) continue;
    const Vec3 axis = at.pose.q_WB.conjugate() * at.state.hydrostatics.waterplane_axes_W[i];
    if (!text.empty()) text += "; ";
    text += gm_about_axis(height, axis);
  }
  return text;
}

// The further columns of a CSV header.
std::string csv_columns(const PointRows& points) {
  std::string text;
  for (const std::string& name : column_names(points.points)) text += "," + name;
  return text;
}

std::vector<double> joined(std::vector<double> values, const PointRows& points, std::size_t row) {
  if (!points.rows.empty()) {
    values.insert(values.end(), points.rows[row].begin(), points.rows[row].end());
  }
  return values;
}

// A table of the readings alone, after one column that names the rows.
std::string points_text(const PointRows& points, const std::string& head, const std::vector<double>& rows) {
  const std::vector<std::string> names = column_names(points.points);
  if (names.empty()) return "";
  std::string text = fmt::format("\n{:>10}", head);
  for (const std::string& name : names) text += fmt::format(" {:>15}", name);
  text += " (m)\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += fmt::format("{:>10.5g}", rows[i]);
    for (const double value : points.rows[i]) text += fmt::format(" {:>15.6f}", value);
    text += '\n';
  }
  return text;
}

std::string parts_text(const PartRows& parts, std::size_t row) {
  std::string text;
  for (std::size_t i = 0; i < parts.names.size(); ++i) {
    const DisplacedPart& part = parts.rows[row][i];
    if (part.volume == 0.0) {
      text += fmt::format("           {} displaces nothing\n", parts.names[i]);
      continue;
    }
    // + 0.0: no negative zeros
    text += fmt::format("           {} displaces {:.6g} m^3, {:.6g} kg, centre ({:.6g}, {:.6g}, {:.6g}) m\n",
                        parts.names[i], part.volume, part.mass, part.center_B.x() + 0.0,
                        part.center_B.y() + 0.0, part.center_B.z() + 0.0);
  }
  return text;
}

Json parts_json(const PartRows& parts, std::size_t row) {
  Json entries = Json::array();
  for (std::size_t i = 0; i < parts.names.size(); ++i) {
    const DisplacedPart& part = parts.rows[row][i];
    entries.push_back(
        {{"name", parts.names[i]},
         {"volume", part.volume},
         {"mass", part.mass},
         {"center_of_buoyancy", part.volume != 0.0 ? std::optional(part.center_B) : std::nullopt}});
  }
  return entries;
}

// In the order of the code, with its symbols.
struct WeatherValue {
  const char* name;
  const char* symbol;
  const char* unit;
  std::optional<double> value;
};

std::vector<WeatherValue> values_of(const WeatherCriterion& weather) {
  const auto heel = [](const std::optional<double>& radians) {
    return radians ? std::optional(*radians * kDegreesPerRadian) : std::nullopt;
  };
  const RollForm& form = weather.form;
  const RollToWindward& roll = weather.roll;
  return {{"length_wl", "Lwl", "m", form.length_wl},
          {"breadth", "B", "m", form.breadth},
          {"draft", "d", "m", form.draft},
          {"block", "Cb", "", form.block},
          {"kg", "KG", "m", form.kg},
          {"og", "OG", "m", form.kg - form.draft},
          {"gm", "GM", "m", form.gm},
          {"lw1", "lw1", "m", weather.lw1},
          {"lw2", "lw2", "m", weather.lw2},
          {"k", "k", "", roll.k},
          {"x1", "X1", "", roll.x1},
          {"x2", "X2", "", roll.x2},
          {"r", "r", "", roll.r},
          {"c", "C", "", roll.c},
          {"period", "T", "s", roll.period},
          {"s", "s", "", roll.s},
          {"phi0", "φ0", "degrees", heel(weather.steady_heel)},
          {"phi0_limit", "φ0 at most", "degrees", weather.steady_limit * kDegreesPerRadian},
          {"phi1", "φ1", "degrees", roll.angle * kDegreesPerRadian},
          {"gust_heel", "GZ = lw2", "degrees", heel(weather.gust_heel)},
          {"phi_c", "φc", "degrees", heel(weather.second_intercept)},
          {"phi2", "φ2", "degrees", weather.gust_heel ? heel(weather.end_heel) : std::nullopt},
          {"area_a", "a", "m rad", weather.gust_heel ? std::optional(weather.area_a) : std::nullopt},
          {"area_b", "b", "m rad", weather.gust_heel ? std::optional(weather.area_b) : std::nullopt}};
}

std::vector<std::string> limits_of_validity(const RollToWindward& roll) {
  std::vector<std::string> outside;
  if (!roll.breadth_in_range) outside.emplace_back("B/d is not below 3.5");
  if (!roll.kg_in_range) outside.emplace_back("KG/d - 1 is not between -0.3 and 0.5");
  if (!roll.period_in_range) outside.emplace_back("T is not below 20 s");
  return outside;
}

std::string weather_text(const RightingResults& results) {
  if (!results.asks_weather) return "";
  std::string text = "\n2008 IS Code A 2.3, wind and roll, to starboard (not a class approval):\n";
  if (!results.weather) return text + "not known: a righting arm that it needs has no result\n";
  for (const WeatherValue& value : values_of(*results.weather)) {
    text += fmt::format("{:>48}{:>12} {}\n", value.symbol,
                        value.value ? fmt::format("{:.6g}", *value.value) : "none", value.unit);
  }
  const auto verdict = [](bool met) { return met ? "met" : "NOT met"; };
  text += fmt::format("{:>48}  {}\n{:>48}  {}\n", "φ0 not above its limit",
                      verdict(results.weather->is_steady_heel_met()), "area b not below area a",
                      verdict(results.weather->is_area_met()));
  for (const std::string& limit : limits_of_validity(results.weather->roll)) {
    text += "outside the ships of the formulae (2.3.5): " + limit + "\n";
  }
  return text;
}

Json weather_json(const std::optional<WeatherCriterion>& weather) {
  if (!weather) return nullptr;
  Json json{{"source", "2008 IS Code A 2.3, to starboard; not a class approval"}};
  for (const WeatherValue& value : values_of(*weather)) json[value.name] = value.value;
  json["phi0_met"] = weather->is_steady_heel_met();
  json["areas_met"] = weather->is_area_met();
  json["outside"] = limits_of_validity(weather->roll);
  return json;
}

Json arm_json(const RightingArm& arm) {
  return {{"heel", degrees(arm.heel)},
          {"trim", degrees(arm.trim)},
          {"draft", arm.draft},
          {"gz", arm.gz},
          {"kn", arm.kn}};
}

Json immersion_json(const std::optional<PointImmersion>& immersion) {
  if (!immersion) return nullptr;
  return {{"heel", degrees(immersion->heel)}, {"point", immersion->point}};
}

Json immersions_json(const std::optional<FirstImmersions>& immersions) {
  if (!immersions) return nullptr;
  return {{"starboard", immersion_json(immersions->starboard)}, {"port", immersion_json(immersions->port)}};
}

std::string immersions_text(const char* name, const std::optional<FirstImmersions>& immersions) {
  std::string text;
  if (!immersions) return text;
  for (const auto& [side, immersion] :
       {std::pair{"starboard", &immersions->starboard}, std::pair{"port", &immersions->port}}) {
    if (*immersion) {
      text += fmt::format("{} to {}: {:.6f} degrees, point {}\n", name, side, degrees((*immersion)->heel),
                          (*immersion)->point + 1);
    } else {
      text += fmt::format("{} to {}: at no heel\n", name, side);
    }
  }
  return text;
}

Json submerged_json(const SubmergedResult& submerged) {
  if (!submerged.rest) return nullptr;
  const SubmergedRest& rest = *submerged.rest;
  return {{"quaternion_wxyz", rest.q_WB},
          {"heel", degrees(rest.angles.heel)},
          {"trim", degrees(rest.angles.trim)},
          {"family", to_string(rest.family)},
          {"bg", rest.bg},
          {"righting_moment_per_degree", rest.moments_per_degree},
          {"net_weight", rest.net_weight},
          {"motion", to_string(rest.motion)},
          {"terminal_speed", submerged.terminal_speed}};
}

std::optional<double> in_degrees(std::optional<double> radians) {
  if (radians) *radians = degrees(*radians);
  return radians;
}

}  // namespace

std::string submerged_text(const SubmergedResult& submerged) {
  if (!submerged.rest) {
    return "Fully submerged: no result, since the mesh is open, displaces nothing, or its numbers are out of "
           "range.\n";
  }
  const SubmergedRest& rest = *submerged.rest;
  std::string text = "Fully submerged it rests ";
  if (rest.family == AttitudeFamily::kSphere) {
    text += "in any attitude: its centre of mass is at that of buoyancy.\n";
  } else {
    const auto shown = [](double radians) { return std::round(1e4 * degrees(radians)) / 1e4 + 0.0; };
    const auto& [smaller, larger] = rest.moments_per_degree;
    text += fmt::format("at a heel of {:.4f} and a trim of {:.4f} degrees, BG {:.5g} m.\n",
                        shown(rest.angles.heel), shown(rest.angles.trim), rest.bg);
    text += fmt::format("Righting moment per degree: {:.5g} N m", smaller);
    if (larger - smaller > 1e-9 * larger) text += fmt::format(" and {:.5g} N m, about two axes", larger);
    text += ".\n";
  }
  text += fmt::format("Net weight {:.6g} N: it {}", rest.net_weight, to_string(rest.motion));
  if (rest.motion == VerticalMotion::kHovers) return text + ".\n";
  if (!submerged.terminal_speed) return text + ", ever faster, since no drag is given.\n";
  return text + fmt::format(" at {:.4g} m/s.\n", *submerged.terminal_speed);
}

std::string equilibria_text(const Equilibria& equilibria, const PointRows& points, const PartRows& parts,
                            const SubmergedResult* submerged) {
  const std::string under_water = submerged ? submerged_text(*submerged) : "";
  std::string text = outcome_sentence(equilibria.outcome) + "\n";
  if (equilibria.attitudes.empty()) return text + under_water;
  text += fmt::format("{:>10}{:>12}{:>12}{:>12}{:>12}{:>12}{:>16}{:>14}{:>14}\n", "", "heel, deg",
                      "trim, deg", "draft, m", "GM, m", "GM, m", "energy, J", "force/bound", "torque/bound");
  for (std::size_t row = 0; row < equilibria.attitudes.size(); ++row) {
    const Equilibrium& at = equilibria.attitudes[row];
    const std::array<double, 2>& heights = at.state.hydrostatics.metacentric_heights;
    text += fmt::format("{:>10}{:>12.4f}{:>12.4f}{:>12.6g}{:>12.5g}{:>12.5g}{:>16.8g}{:>14.2g}{:>14.2g}\n",
                        at.is_stable() ? "stable" : "unstable", degrees(at.angles.heel),
                        degrees(at.angles.trim), at.draft, heights[0], heights[1], at.state.energy,
                        at.residual_force / at.force_bound, at.residual_torque / at.torque_bound);
    if (at.family == AttitudeFamily::kCurve)
      text += "           one of a curve of attitudes of equal energy\n";
    if (at.family == AttitudeFamily::kSphere) text += "           any attitude has the same energy\n";
    if (!at.is_stable()) text += fmt::format("           unstable: {}\n", reason(at));
    if (!parts.rows.empty()) text += parts_text(parts, row);
  }
  if (equilibria.is_truncated) text += "There are more attitudes, of higher energy.\n";
  std::vector<double> heels;
  for (const Equilibrium& at : equilibria.attitudes) heels.push_back(degrees(at.angles.heel));
  text += points_text(points, "heel, deg", heels);
  return text + under_water;
}

Json equilibria_json(const Equilibria& equilibria, const PointRows& points, const PartRows& parts,
                     const SubmergedResult* submerged) {
  Json attitudes = Json::array();
  for (std::size_t row = 0; row < equilibria.attitudes.size(); ++row) {
    const Equilibrium& at = equilibria.attitudes[row];
    Json entry{{"stable", at.is_stable()},
               {"position", at.pose.p_WB},
               {"quaternion_wxyz", at.pose.q_WB},
               {"draft", at.draft},
               {"heel", degrees(at.angles.heel)},
               {"trim", degrees(at.angles.trim)},
               {"energy", at.state.energy},
               {"residual_force", at.residual_force},
               {"residual_torque", at.residual_torque},
               {"force_bound", at.force_bound},
               {"torque_bound", at.torque_bound},
               {"metacentric_heights", at.state.hydrostatics.metacentric_heights},
               {"stiffness", at.stiffness},
               {"family", to_string(at.family)},
               {"displacement_volume", at.state.hydrostatics.volume}};
    if (!at.is_stable()) entry["reason"] = reason(at);
    if (!points.rows.empty()) add_readings(entry, points.points, points.rows[row]);
    if (!parts.rows.empty()) entry["parts"] = parts_json(parts, row);
    attitudes.push_back(std::move(entry));
  }
  Json json{{"outcome", to_string(equilibria.outcome)},
            {"attitudes", std::move(attitudes)},
            {"truncated", equilibria.is_truncated}};
  if (submerged != nullptr) json["submerged"] = submerged_json(*submerged);
  return json;
}

std::string equilibria_csv(const Equilibria& equilibria, const PointRows& points) {
  std::string text =
      "stable,heel,trim,draft,px,py,pz,qw,qx,qy,qz,gm_min,gm_max,energy,residual_force,residual_torque,"
      "force_bound,torque_bound" +
      csv_columns(points) + "\n";
  for (std::size_t row = 0; row < equilibria.attitudes.size(); ++row) {
    const Equilibrium& at = equilibria.attitudes[row];
    const Eigen::Quaterniond& q = at.pose.q_WB;
    const std::array<double, 2>& heights = at.state.hydrostatics.metacentric_heights;
    text += csv_row(joined(
        {at.is_stable() ? 1.0 : 0.0, degrees(at.angles.heel), degrees(at.angles.trim), at.draft,
         at.pose.p_WB.x(), at.pose.p_WB.y(), at.pose.p_WB.z(), q.w(), q.x(), q.y(), q.z(), heights[0],
         heights[1], at.state.energy, at.residual_force, at.residual_torque, at.force_bound, at.torque_bound},
        points, row));
  }
  return text;
}

std::string table_text(const HydrostaticTable& table, const TableRows& rows, const PointRows& points) {
  std::string text = fmt::format(
      "K at {:.6g} m along up, midship at {:.6g} m along forward, from the origin of the mesh; Lpp {:.6g} "
      "m.\n"
      "lcb and lcf from midship, positive forward; tcb to port; kb, km over K. Masses in tonnes.\n",
      table.keel(), table.midship(), table.length_between_perpendiculars());
  if (!table.knows_mass()) {
    text += "Without a mass and a centre of mass there is no MCT1cm and no RM1deg.\n";
  }
  constexpr std::size_t kPerLine = 7;
  const std::span<const TableColumn> columns = table_columns();
  std::vector<std::vector<double>> values;
  values.reserve(rows.size());
  for (const HydrostaticRow& row : rows) values.push_back(values_of(row));
  for (std::size_t first = 2; first < columns.size(); first += kPerLine) {
    const std::size_t end = std::min(first + kPerLine, columns.size());
    text += fmt::format("\n{:>10}{:>8}", columns[0].name, columns[1].name);
    for (std::size_t i = first; i < end; ++i) text += fmt::format("{:>20}", columns[i].name);
    text += '\n';
    for (const std::vector<double>& line : values) {
      text += fmt::format("{:>10.5g}{:>8.3g}", line[0], line[1]);
      for (std::size_t i = first; i < end; ++i) text += fmt::format("{:>20.8g}", line[i]);
      text += '\n';
    }
  }
  std::vector<double> drafts;
  for (const HydrostaticRow& row : rows) drafts.push_back(row.draft);
  return text + points_text(points, columns[0].name.data(), drafts);
}

Json table_json(const HydrostaticTable& table, const TableRows& rows, const PointRows& points) {
  const std::span<const TableColumn> columns = table_columns();
  Json entries = Json::array();
  for (const HydrostaticRow& row : rows) {
    const std::vector<double> values = values_of(row);
    Json& entry = entries.emplace_back(Json::object());
    for (std::size_t i = 0; i < columns.size(); ++i) entry[columns[i].name] = values[i];
    if (!points.rows.empty()) add_readings(entry, points.points, points.rows[entries.size() - 1]);
  }
  return {{"keel", table.keel()},
          {"midship", table.midship()},
          {"length_between_perpendiculars", table.length_between_perpendiculars()},
          {"rows", std::move(entries)}};
}

std::string table_csv(const TableRows& rows, const PointRows& points) {
  std::string text;
  for (const TableColumn& column : table_columns()) {
    text += fmt::format("{}{}", text.empty() ? "" : ",", column.name);
  }
  text += csv_columns(points) + '\n';
  for (std::size_t i = 0; i < rows.size(); ++i) text += csv_row(joined(values_of(rows[i]), points, i));
  return text;
}

std::string righting_text(const RightingResults& results, const PointRows& points) {
  std::string text = fmt::format("{:>10}{:>10}{:>12}{:>14}{:>14}{:>14}\n", "heel, deg", "trim, deg",
                                 "draft, m", "GZ, m", "KN, m", "area, m rad");
  for (const auto& [arm, area] : results.curve.points) {
    text += fmt::format("{:>10.4g}{:>10.4f}{:>12.6g}{:>14.8f}{:>14.8f}{:>14.8f}\n", degrees(arm.heel),
                        degrees(arm.trim), arm.draft, arm.gz, arm.kn, area);
  }
  std::vector<double> heels;
  for (const RightingCurvePoint& point : results.curve.points) heels.push_back(degrees(point.arm.heel));
  text += points_text(points, "heel, deg", heels) + '\n';
  for (const ArmCrossing& crossing : results.curve.crossings) {
    text += fmt::format("GZ vanishes at {:.6f} degrees, {}\n", degrees(crossing.heel),
                        crossing.returns ? "to which the body returns" : "from which the body turns away");
  }
  for (const auto& [side, arm] :
       {std::pair{"starboard", &results.curve.max_starboard}, std::pair{"port", &results.curve.max_port}}) {
    if (!*arm) continue;
    text += fmt::format("largest arm to {}: {:.6g} m at {:.4f} degrees\n", side, std::abs((*arm)->gz),
                        degrees((*arm)->heel));
  }
  text += immersions_text("deck edge under water", results.deck_edge);
  text += immersions_text("downflooding", results.downflooding);
  if (results.criteria.empty()) return text + weather_text(results);
  text += "\n2008 IS Code A 2.2, to starboard (not a class approval):\n";
  for (const StabilityCriterion& criterion : results.criteria) {
    text += fmt::format("{:>48}{:>12.5g} {:<8}{:>12.4g}  {}\n", criterion.name, criterion.value,
                        criterion.unit, criterion.required, criterion.is_met() ? "met" : "NOT met");
  }
  return text + weather_text(results);
}

Json righting_json(const RightingResults& results, const PointRows& rows) {
  Json points = Json::array();
  for (const auto& [arm, area] : results.curve.points) {
    Json point = arm_json(arm);
    point["area"] = area;
    if (!rows.rows.empty()) add_readings(point, rows.points, rows.rows[points.size()]);
    points.push_back(std::move(point));
  }
  Json crossings = Json::array();
  for (const ArmCrossing& crossing : results.curve.crossings) {
    crossings.push_back({{"heel", degrees(crossing.heel)}, {"returns", crossing.returns}});
  }
  Json criteria = Json::array();
  for (const StabilityCriterion& criterion : results.criteria) {
    criteria.push_back({{"name", criterion.name},
                        {"value", criterion.value},
                        {"required", criterion.required},
                        {"unit", criterion.unit},
                        {"met", criterion.is_met()}});
  }
  const auto maximum = [](const std::optional<RightingArm>& arm) {
    return arm ? arm_json(*arm) : Json(nullptr);
  };
  Json json{{"points", std::move(points)},
            {"crossings", std::move(crossings)},
            {"vanishing_starboard", in_degrees(results.curve.vanishing_starboard())},
            {"vanishing_port", in_degrees(results.curve.vanishing_port())},
            {"unbalanced_starboard", in_degrees(results.curve.unbalanced_starboard)},
            {"unbalanced_port", in_degrees(results.curve.unbalanced_port)},
            {"max_starboard", maximum(results.curve.max_starboard)},
            {"max_port", maximum(results.curve.max_port)},
            {"deck_edge", immersions_json(results.deck_edge)},
            {"downflooding", immersions_json(results.downflooding)},
            {"criteria",
             {{"source", "2008 IS Code A 2.2, to starboard; not a class approval"},
              {"values", std::move(criteria)}}}};
  if (results.asks_weather) json["weather_criterion"] = weather_json(results.weather);
  return json;
}

std::string righting_csv(const RightingResults& results, const PointRows& points) {
  std::string text = "heel,trim,draft,gz,kn,area" + csv_columns(points) + "\n";
  for (std::size_t i = 0; i < results.curve.points.size(); ++i) {
    const auto& [arm, area] = results.curve.points[i];
    text +=
        csv_row(joined({degrees(arm.heel), degrees(arm.trim), arm.draft, arm.gz, arm.kn, area}, points, i));
  }
  return text;
}

}  // namespace buoyancy::service
