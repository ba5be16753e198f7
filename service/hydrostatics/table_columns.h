// The columns of a hydrostatic table, as all of its formats have them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "flotation/hydrostatic_table.h"

namespace buoyancy::service {

inline constexpr double kTonnesPerKilogram = 1e-3;

struct TableColumn {
  std::string_view name;   // in CSV and JSON
  std::string_view title;  // in prose
  std::string_view unit;   // empty: a ratio
};

// draft and trim come first.
std::span<const TableColumn> table_columns();

// Returns a row's values in the order and units of table_columns(): angles in degrees, masses in tonnes.
std::vector<double> values_of(const HydrostaticRow& row);

}  // namespace buoyancy::service
