#include "service/hydrostatics/tank_tables.h"

#include <array>
#include <string_view>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "base/angles.h"
#include "base/format.h"
#include "service/hydrostatics/hydrostatics_output.h"
#include "service/hydrostatics/table_columns.h"

namespace buoyancy::service {
namespace {

constexpr std::array<std::string_view, 11> kColumns{"trim", "heel", "sounding", "volume", "fill", "mass",
                                                    "x",    "y",    "z",        "fsm_t",  "fsm_l"};

std::array<double, kColumns.size()> values_of(const TankTable& table, const TankTableRow& row) {
  return {row.angles.trim * kDegreesPerRadian,
          row.angles.heel * kDegreesPerRadian,
          row.sounding,
          row.volume,
          row.volume / table.tank.mesh->volume,
          row.mass * kTonnesPerKilogram,
          row.centroid_B.x(),
          row.centroid_B.y(),
          row.centroid_B.z(),
          row.free_surface_moment_t * kTonnesPerKilogram,
          row.free_surface_moment_l * kTonnesPerKilogram};
}

// Returns the tanks without liquid and rows.
Expected<TankTables> tanks_of(const LoadedScene& loaded, const HydrostaticsOptions& options) {
  const Body& body = *loaded.body;
  if (!options.mesh.empty()) {
    const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
    if (mesh.is_open()) {
      return make_error(
          {loaded.name, "an open mesh", "a closed mesh", "a tank has an inside", "Close the mesh"});
    }
    return TankTables{{.name = loaded.name, .tank = {.mesh = &mesh, .density = options.density}}};
  }
  if (body.subdivision == nullptr || body.subdivision->tanks.empty()) {
    return make_error({loaded.name, "a body without tanks", "a body with a section [[body.tank]]", "",
                       "Add the section, or give the mesh of a tank with --mesh"});
  }
  TankTables tables;
  for (const BodyTank& tank : body.subdivision->tanks) {
    tables.push_back({.index = tables.size(), .name = tank.name, .tank = with_liquid(tank, 0.0)});
  }
  return tables;
}

void add_rows(const HydrostaticsPlan& plan, TankTable& table) {
  constexpr int kSteps = 10;
  std::vector<double> soundings = plan.soundings;
  for (int i = 0; plan.soundings.empty() && i <= kSteps; ++i) {
    soundings.push_back(table.pipe.depth * i / kSteps);
  }
  for (const double trim : plan.trims) {
    for (const double heel : plan.heels) {
      for (const double sounding : soundings) {
        table.rows.push_back(
            tank_table_row(table.tank, plan.table.axes, {.heel = heel, .trim = trim}, table.pipe, sounding));
      }
    }
  }
}

}  // namespace

Expected<TankTables> tank_tables(const LoadedScene& loaded, const HydrostaticsOptions& options,
                                 const HydrostaticsPlan& plan) {
  Expected<TankTables> tables = tanks_of(loaded, options);
  if (!tables) return tables;
  if (options.tank) {
    if (*options.tank >= tables->size()) {
      return make_error(
          {"--tank", std::to_string(*options.tank),
           "the number of a tank of " + loaded.name + ", 0 to " + std::to_string(tables->size() - 1),
           "tanks are numbered from 0, in the order of the scene file", ""});
    }
    TankTable chosen = std::move((*tables)[*options.tank]);
    tables->clear();
    tables->push_back(std::move(chosen));
  }
  for (TankTable& table : *tables) {
    table.pipe = sounding_pipe(table.tank, plan.table.axes, plan.sounding_foot_B);
    if (plan.soundings.empty() && !(table.pipe.depth > 0.0)) {
      return make_error({"--sounding-at", format_vector(table.pipe.foot_B) + " m, over '" + table.name + "'",
                         "a point lower than the highest one of the tank",
                         "the point has a place for each tank", "Choose one tank with --tank"});
    }
    add_rows(plan, table);
  }
  return tables;
}

std::string tank_tables_text(const TankTables& tables) {
  std::string text =
      "x, y, z: centre of the liquid in the frame of the body, m. Masses in tonnes, free surface moments in "
      "t "
      "m.\n";
  for (const TankTable& table : tables) {
    text += fmt::format("\ntank {} '{}': {:.8g} m^3, {:.6g} kg/m^3; ", table.index, table.name,
                        table.tank.mesh->volume, table.tank.density);
    text += table.tank.piston_axis_B ? "piston, at a sounding of 0 at " : "sounding from ";
    text += format_vector(table.pipe.foot_B) + " m\n";
    for (const std::string_view column : kColumns) text += fmt::format("{:>12}", column);
    text += '\n';
    for (const TankTableRow& row : table.rows) {
      for (const double value : values_of(table, row)) text += fmt::format("{:>12.5g}", value);
      text += '\n';
    }
  }
  return text;
}

Json tank_tables_json(const TankTables& tables) {
  Json list = Json::array();
  for (const TankTable& table : tables) {
    Json rows = Json::array();
    for (const TankTableRow& row : table.rows) {
      const auto values = values_of(table, row);
      Json& entry = rows.emplace_back(Json::object());
      for (std::size_t i = 0; i < kColumns.size(); ++i) entry[std::string(kColumns[i])] = values[i];
    }
    list.push_back({{"tank", table.index},
                    {"name", table.name},
                    {"capacity", table.tank.mesh->volume},
                    {"density", table.tank.density},
                    {"piston", table.tank.piston_axis_B.has_value()},
                    {"sounding_point", table.pipe.foot_B},
                    {"rows", std::move(rows)}});
  }
  return {{"tanks", std::move(list)}};
}

std::string tank_tables_csv(const TankTables& tables) {
  std::string text = "tank";
  for (const std::string_view column : kColumns) text += fmt::format(",{}", column);
  text += '\n';
  for (const TankTable& table : tables) {
    for (const TankTableRow& row : table.rows) {
      std::vector<double> values{static_cast<double>(table.index)};
      for (const double value : values_of(table, row)) values.push_back(value);
      text += csv_row(values);
    }
  }
  return text;
}

}  // namespace buoyancy::service
