// buoyancy-replay's command line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "base/error.h"
#include "cli/pose_options.h"
#include "messages/wire.h"
#include "scene/scene.h"
#include "scene/scene_file.h"
#include "service/replay/replay_channels.h"
#include "service/replay/replay_input.h"
#include "service/replay/replay_part.h"

namespace buoyancy::service {

struct ReplayOptions {
  std::filesystem::path scene;  // either scene
  std::filesystem::path mesh;   // or mesh with the next five options
  std::string method;           // empty: the default of a scene's body
  double tolerance = 0.0;
  OpenPolicy open = OpenPolicy::kRefuse;
  std::string scale = "1";        // FACTOR or X,Y,Z
  std::optional<std::string> up;  // AXIS
  std::string format = "auto";    // of INPUT
  std::string time_unit;          // s, ms, us or ns; empty: guessed
  std::string body;               // of the poses of another program; empty: the scene's only one
  bool list = false;              // list the channels of INPUT, compute nothing
  std::filesystem::path input;
  std::filesystem::path output;
  std::string states_channel{kStatesChannel};
  std::string wrenches_channel{kWrenchesChannel};
  std::string hydrostatics_channel{kHydrostaticsChannel};
  std::string loads_channel{kLoadsChannel};
  std::string sea_channel{kSeaChannel};
  std::string sea_grid_channel{kSeaGridChannel};
  std::string condition_channel{kConditionChannel};
  std::string water_points_channel{kWaterPointsChannel};
  std::string water_samples_channel{kWaterSamplesChannel};
  PoseOptions poses;
  std::vector<std::string> copied;  // regular expressions
  std::filesystem::path loads;      // CSV file for the loads; empty: none
  std::filesystem::path baseline;   // an earlier OUTPUT to compare with; empty: none
  unsigned jobs = 0;                // 0: number of hardware threads
  std::string part;                 // "I/N"; empty: the whole
  int join = 0;                     // number of parts to join; 0: replay
  bool json = false;
};

// Declares the options on app; parsing fills options, which must outlive app.
void add_options(CLI::App& app, ReplayOptions& options);

// The checked options.
struct ReplayPlan {
  std::optional<SceneDescription> single_mesh;  // nullopt: use the scene file
  FileFormat input_format = FileFormat::kCsv;
  FileFormat output_format = FileFormat::kCsv;
  std::optional<Part> part;
};

// Errors: an extension other than .csv and .lcmlog, an output that is the input, a channel that LCM cannot
// carry, one channel for two types, an unknown method, a scale or an axis that is none, options for logs with
// a table and for tables with a log, a part of what is no regular file, a file of loads that is another file
// of the replay or beside a part.
Expected<ReplayPlan> plan_replay(const ReplayOptions& options);

// The format of INPUT: by --format, else by its extension .lcmlog or .csv, else a log if it begins with an
// event.
FileFormat input_format(const ReplayOptions& options);
TableOptions table_options(const ReplayOptions& options);

// Checks the options of --list, which app has parsed. Errors: an OUTPUT, an option that belongs to a replay.
Expected<void> check_list(const CLI::App& app, const ReplayOptions& options);

// Checks the options of --join, which app has parsed. Errors: an option that belongs to a replay, an
// extension other than .csv and .lcmlog, an output that is the input.
Expected<void> check_join(const CLI::App& app, const ReplayOptions& options);

// The channels of a log's events.
struct ReplayRoutes {
  PoseChannels poses;
  ReplayChannels channels;
};

// Errors: see resolve_pose_channels(), check_velocities_usable() and ReplayChannels::make(); for a scene that
// receives its sea: a CSV file as input, and a part, whose sea another part may have received; a file of
// loads for a scene in which no body has this output.
Expected<ReplayRoutes> plan_routes(const ReplayOptions& options, const Scene& scene);

// Sets the body of another program's poses. Errors: --body or --time-unit for an input that states both; no
// such body, or none named of several.
Expected<void> choose_body(const ReplayOptions& options, const Scene& scene, ReplayInput& input);

// Errors: a table without velocities for a body of the scene that has drag or added mass.
Expected<void> check_velocity_columns(const ReplayInput& input, const ReplayOptions& options,
                                      const Scene& scene);

}  // namespace buoyancy::service
