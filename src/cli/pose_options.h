// The options that name bot_core's channels: whoever answers such poses and whoever shows them has them
// alike.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "base/error.h"
#include "engine/pose_request_adapter.h"
#include "scene/scene.h"

namespace buoyancy {

struct PoseOptions {
  std::vector<std::string> poses;               // CHANNEL=BODY
  std::vector<std::string> force_torques;       // CHANNEL=BODY
  std::optional<VelocityFrame> velocity_frame;  // not said: nullopt
  double lead_time = 0.0;                       // s
};

// Declares the options on app; parsing fills options, which must live as long.
void add_options(CLI::App& app, PoseOptions& options);
// Those that name channels alone, for whom velocities do not matter.
void add_pose_channel_options(CLI::App& app, PoseOptions& options);

// What they come to in a scene. taken: channels that carry something else. Errors: not CHANNEL=BODY, a body
// that the scene has not or has twice by that name, a channel that LCM cannot carry or that is named twice or
// taken, a force-torque channel of a body without poses, a lead time without a velocity frame.
Expected<PoseChannels> pose_channels(const PoseOptions& options, const Scene& scene,
                                     const std::vector<std::string>& taken);

}  // namespace buoyancy
