// The results of buoyancy-hydrostatics as text, JSON and CSV. Angles are in degrees, masses of the table in
// tonnes, everything else in SI units.
#pragma once

#include <string>
#include <vector>

#include "flotation/equilibrium.h"
#include "flotation/hydrostatic_table.h"
#include "flotation/righting_arms.h"

namespace buoyancy::service {

std::string equilibria_text(const Equilibria& equilibria);
std::string equilibria_json(const Equilibria& equilibria);
std::string equilibria_csv(const Equilibria& equilibria);

using TableRows = std::vector<HydrostaticRow>;

std::string table_text(const HydrostaticTable& table, const TableRows& rows);
std::string table_json(const HydrostaticTable& table, const TableRows& rows);
std::string table_csv(const TableRows& rows);

// One of the general criteria of the 2008 IS Code, part A, 2.2. They are data, not an approval by a class.
struct StabilityCriterion {
  std::string name;
  double value = 0.0;
  double required = 0.0;
  std::string unit;

  bool is_met() const { return value >= required; }
};

struct RightingResults {
  RightingCurve curve;
  std::vector<StabilityCriterion> criteria;  // to starboard; empty: not known
};

std::string righting_text(const RightingResults& results);
std::string righting_json(const RightingResults& results);
std::string righting_csv(const RightingResults& results);

}  // namespace buoyancy::service
