// The command line of buoyancy-hydrostatics.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "base/error.h"
#include "flotation/ballast.h"
#include "flotation/hydrostatic_table.h"
#include "flotation/righting_arms.h"
#include "scene/scene_file.h"
#include "service/hydrostatics/righting_results.h"
#include "service/hydrostatics/water_points.h"
#include "view/page/page_assets.h"

namespace buoyancy::service {

struct HydrostaticsOptions {
  std::string command;
  std::filesystem::path scene;
  std::optional<std::int32_t> body;
  std::filesystem::path mesh;
  std::optional<double> mass;         // [kg], of the mesh; of the command ballast: of the ballast
  std::optional<double> body_mass;    // [kg], of the mesh without the ballast
  std::string center_of_mass;         // X,Y,Z
  std::string scale = "1";            // FACTOR or X,Y,Z
  double density = kSeawaterDensity;  // [kg/m^3], of the water
  double gravity = kStandardGravity;  // [m/s^2]
  OpenPolicy open = OpenPolicy::kRefuse;
  std::string forward;  // empty: see plan_axes()
  std::string up;
  std::optional<double> keel;                   // [m]
  std::optional<double> aft_perpendicular;      // [m]
  std::optional<double> forward_perpendicular;  // [m]
  bool unstable = false;
  bool submerged = false;
  std::string drafts;  // FROM:TO:STEP
  std::string trims = "0";
  std::string heels = "-180:180:5";
  bool fixed_trim = false;
  std::vector<std::string> ballast_places;  // X,Y,Z each
  std::string ballast_line;                 // an axis; empty: none
  std::optional<std::size_t> tank;
  std::string soundings;                   // FROM:TO:STEP
  std::string sounding_at;                 // X,Y,Z
  std::vector<std::string> deck_edges;     // X,Y,Z each
  std::vector<std::string> downfloodings;  // X,Y,Z each
  std::vector<std::string> marks;          // NAME=X,Y each
  std::vector<std::string> freeboards;     // X,Y,Z each
  WeatherExposure exposure;                // windage_area 0: none is given
  std::filesystem::path csv;
  std::filesystem::path html;
  std::filesystem::path three = view::kThreeJs;
  bool json = false;
};

void add_options(CLI::App& app, HydrostaticsOptions& options);

enum class HydrostaticsCommand { kEquilibrium, kTable, kRightingArms, kBallast, kTanks, kKgLimit };

// The options, checked.
struct HydrostaticsPlan {
  HydrostaticsCommand command = HydrostaticsCommand::kEquilibrium;
  std::optional<double> mass;            // [kg], of the body, with --mesh
  Vec3 center_of_mass_B = Vec3::Zero();  // [m], with --mesh
  MeshPlacement placement;               // with --mesh
  HydrostaticTableOptions table;
  RightingArmOptions arms;
  ImmersionPoints points;
  WaterPoints water_points;
  BallastTask ballast;
  std::vector<double> drafts;           // [m]
  std::vector<double> trims;            // [rad]
  std::vector<double> heels;            // [rad]
  std::vector<double> soundings;        // [m]; empty: from the empty to the full tank
  std::optional<Vec3> sounding_foot_B;  // [m]
};

// Can the command do without the mass of the body?
bool needs_mass(HydrostaticsCommand command);

// All but the axes. Errors: options that do not belong together, and texts that are no range, scale or point.
Expected<HydrostaticsPlan> plan_hydrostatics(const CLI::App& app, const HydrostaticsOptions& options);

// Sets the axes of the plan. own: those of the body, for what --up and --forward do not say. Errors: texts
// that are no axes, or axes that are not at right angles.
Expected<void> plan_axes(const HydrostaticsOptions& options, const ShipAxes& own, HydrostaticsPlan& plan);

// FROM:TO:STEP or one number: ascending, TO included where a step meets it. Errors: anything else, and more
// than 100,000 values. subject: of the error.
Expected<std::vector<double>> parse_range(const std::string& subject, const std::string& text);

}  // namespace buoyancy::service
