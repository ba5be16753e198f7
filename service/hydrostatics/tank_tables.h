// The tank tables of buoyancy-hydrostatics, and their output as text, JSON and CSV. Angles are in degrees,
// masses in tonnes, everything else in SI units.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/json.h"
#include "flotation/tank_table.h"
#include "service/hydrostatics/loaded_body.h"

namespace buoyancy::service {

struct TankTable {
  std::size_t index = 0;  // among the tanks of the body
  std::string name;
  Tank tank;
  SoundingPipe pipe = {};
  std::vector<TankTableRow> rows = {};  // by trim, heel and sounding
};

using TankTables = std::vector<TankTable>;

// Of the tanks of a scene's body, or of a mesh, which is one tank. loaded: outlives the result. Errors: a
// body without tanks, a tank that it lacks, a mesh that is open, and a foot of the pipe over the tank without
// soundings.
Expected<TankTables> tank_tables(const LoadedScene& loaded, const HydrostaticsOptions& options,
                                 const HydrostaticsPlan& plan);

std::string tank_tables_text(const TankTables& tables);
Json tank_tables_json(const TankTables& tables);
std::string tank_tables_csv(const TankTables& tables);

}  // namespace buoyancy::service
