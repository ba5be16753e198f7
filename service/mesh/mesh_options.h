// The command line of buoyancy-mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "base/error.h"
#include "base/water.h"
#include "geometry/mesh_export.h"
#include "scene/prepared_mesh.h"

namespace buoyancy::service {

struct MeshOptions {
  std::string command;
  std::vector<std::filesystem::path> files;
  std::string scale = "1";        // FACTOR or X,Y,Z
  std::optional<std::string> up;  // AXIS
  std::string mirror;
  bool close = false;
  bool rims = false;
  std::vector<std::int32_t> rim;
  double max_change = kDefaultMaxChange;  // of the volume
  double freeboard = 0.0;                 // [m]
  std::int32_t poses = 1'000;
  double density = kSeawaterDensity;  // [kg/m^3], of the water
  double gravity = kStandardGravity;  // [m/s^2]
  double wrap = 0.0;                  // [m]
  std::filesystem::path html;
  bool json = false;
};

void add_options(CLI::App& app, MeshOptions& options);

enum class MeshCommand { kReport, kRepair, kCompare };

// The options, checked.
struct MeshPlan {
  MeshCommand command = MeshCommand::kReport;
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;  // of repair
  ExportFormat format = ExportFormat::kPly;
  MeshPreparation preparation;
};

// Errors: options that do not belong together, a wrong number of files, an output of an unknown format or
// that is the input, and texts that are no factor or axis.
Expected<MeshPlan> plan_mesh_command(const CLI::App& app, const MeshOptions& options);

}  // namespace buoyancy::service
