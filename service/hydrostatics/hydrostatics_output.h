// The results of buoyancy-hydrostatics as text, JSON and CSV. Angles are in degrees, masses of the table in
// tonnes, everything else in SI units.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "flotation/equilibrium.h"
#include "flotation/hydrostatic_table.h"
#include "service/hydrostatics/righting_results.h"

namespace buoyancy::service {

// The values as a line, with 17 significant digits.
std::string csv_row(const std::vector<double>& values);

std::string outcome_sentence(FlotationOutcome outcome);

std::string equilibria_text(const Equilibria& equilibria);
Json equilibria_json(const Equilibria& equilibria);
std::string equilibria_csv(const Equilibria& equilibria);

using TableRows = std::vector<HydrostaticRow>;

std::string table_text(const HydrostaticTable& table, const TableRows& rows);
Json table_json(const HydrostaticTable& table, const TableRows& rows);
std::string table_csv(const TableRows& rows);

std::string righting_text(const RightingResults& results);
Json righting_json(const RightingResults& results);
std::string righting_csv(const RightingResults& results);

}  // namespace buoyancy::service
