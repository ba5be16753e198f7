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

namespace buoyancy {

struct ReplayOptions {
  std::filesystem::path scene;  // this
  std::filesystem::path mesh;   // or this, then with
  std::string method;           // empty: the default of a scene's body
  double tolerance = 0.0;
  OpenPolicy open = OpenPolicy::kRefuse;
  std::filesystem::path input;
  std::filesystem::path output;
  std::string states_channel{kStatesChannel};
  std::string wrenches_channel{kWrenchesChannel};
  std::string hydrostatics_channel{kHydrostaticsChannel};
  PoseOptions poses;
  std::vector<std::string> copied;  // regular expressions
  std::filesystem::path earlier;    // an earlier OUTPUT to compare with; empty: none
  unsigned jobs = 0;                // 0: as many as the processor runs at once
  bool json = false;
};

// Declares the options on app; parsing fills options, which must live as long.
void add_options(CLI::App& app, ReplayOptions& options);

// What the options come to.
struct ReplayPlan {
  std::optional<SceneDescription> single_mesh;  // nullopt: the scene file
  FileFormat input_format = FileFormat::kCsv;
  FileFormat output_format = FileFormat::kCsv;
};

// Errors: an extension other than .csv and .lcmlog, an output that is the input, a channel that LCM cannot
// carry, one channel for wrenches and hydrostatics, an unknown method, options for logs with a CSV file.
Expected<ReplayPlan> plan_replay(const ReplayOptions& options);

// Where a log's events come from and go to.
struct ReplayRoutes {
  PoseChannels poses;
  ReplayChannels channels;
};

// Errors: as pose_channels() and ReplayChannels::make() say.
Expected<ReplayRoutes> plan_routes(const ReplayOptions& options, const Scene& scene);

}  // namespace buoyancy
