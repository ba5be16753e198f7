// The results of buoyancy-hydrostatics as text, JSON and CSV. Angles are in degrees, masses of the table in
// tonnes, everything else in SI units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "flotation/displaced_parts.h"
#include "flotation/equilibrium.h"
#include "flotation/hydrostatic_table.h"
#include "flotation/submerged.h"
#include "service/hydrostatics/righting_results.h"
#include "service/hydrostatics/water_points.h"

namespace buoyancy::service {

// The values as a line, with 17 significant digits.
std::string csv_row(const std::vector<double>& values);

// Says about which axis a body is not stable. height: [m], GM; axis_B: unit.
std::string gm_about_axis(double height, const Vec3& axis_B);

std::string outcome_sentence(FlotationOutcome outcome);

// Drafts at marks and freeboards, one row of readings() per row of a result.
struct PointRows {
  WaterPoints points;
  std::vector<std::vector<double>> rows;
};

// What each part of a body displaces, per attitude; empty: it has neither parts nor open compartments.
struct PartRows {
  std::vector<std::string> names;
  std::vector<std::vector<DisplacedPart>> rows;
};

// How a body rests and moves fully submerged.
struct SubmergedResult {
  std::optional<SubmergedRest> rest;     // nullopt: see submerged_rest()
  std::optional<double> terminal_speed;  // [m/s], through the water; nullopt: no drag holds the body
};

std::string submerged_text(
    const SubmergedResult& submerged);  // three lines, or one that says why there are none

// submerged: nullptr leaves it out.
std::string equilibria_text(const Equilibria& equilibria, const PointRows& points, const PartRows& parts,
                            const SubmergedResult* submerged = nullptr);
Json equilibria_json(const Equilibria& equilibria, const PointRows& points, const PartRows& parts,
                     const SubmergedResult* submerged = nullptr);
std::string equilibria_csv(const Equilibria& equilibria, const PointRows& points);

using TableRows = std::vector<HydrostaticRow>;

std::string table_text(const HydrostaticTable& table, const TableRows& rows, const PointRows& points);
Json table_json(const HydrostaticTable& table, const TableRows& rows, const PointRows& points);
std::string table_csv(const TableRows& rows, const PointRows& points);

std::string righting_text(const RightingResults& results, const PointRows& points);
Json righting_json(const RightingResults& results, const PointRows& points);
std::string righting_csv(const RightingResults& results, const PointRows& points);

}  // namespace buoyancy::service
