// The options that name channels of bot_core's pose messages, shared by the programs that respond to such
// poses and those that display them.
#pragma once

#include <cstdint>
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
  std::optional<VelocityFrame> velocity_frame;  // nullopt: not given
  double lead_time = 0.0;                       // [s]
};

// Declares all of the options on app; parsing fills options, which must live as long.
void add_options(CLI::App& app, PoseOptions& options);
// Declares them for programs that only display the poses and the responses.
void add_viewer_options(CLI::App& app, PoseOptions& options);
// Declares --pose and --force-torque only, for such programs if velocities do not matter to them.
void add_viewer_channel_options(CLI::App& app, PoseOptions& options);

// Returns the id of the body that text names by its id or its name. subject: the option. Errors: a body that
// the scene lacks or has twice by that name.
Expected<std::int32_t> resolve_body(const std::string& subject, const std::string& text, const Scene& scene);

// Resolves the options against a scene. reserved: channels that carry other messages. Errors: not
// CHANNEL=BODY, a body that the scene lacks or has twice by that name, a channel that LCM cannot carry, that
// is used twice or that is reserved, a force-torque channel of a body without poses, a lead time without a
// velocity frame.
Expected<PoseChannels> resolve_pose_channels(const PoseOptions& options, const Scene& scene,
                                             const std::vector<std::string>& reserved);

// Checks the poses for programs that respond to them. Errors: a body with drag or added mass, which needs
// velocities, whose frame is not given.
Expected<void> check_velocities_usable(const PoseChannels& poses, const Scene& scene);

}  // namespace buoyancy
