#include "cli/pose_options.h"

#include <charconv>
#include <map>
#include <set>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/channel_options.h"
#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

struct ChannelOfBody {
  std::string channel;
  std::int32_t body_id = 0;
};

// Returns the body with this id, else every body with this name.
std::vector<std::int32_t> find_bodies(const std::string& text, const Scene& scene) {
  std::int32_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error == std::errc{} && end == text.data() + text.size() && scene.find(id) != nullptr) return {id};
  std::vector<std::int32_t> found;
  for (const Body& body : scene.bodies()) {
    if (body.name == text) found.push_back(body.id);
  }
  return found;
}

Expected<ChannelOfBody> parse_channel_of_body(const std::string& option, const std::string& text,
                                              const Scene& scene) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) {
    return make_error({option, "'" + text + "'", "CHANNEL=BODY", "", ""});
  }
  ChannelOfBody named{text.substr(0, equals), 0};
  if (const Expected<void> checked = check_channel(named.channel); !checked) {
    return tl::unexpected(checked.error());
  }
  const Expected<std::int32_t> body = resolve_body(option + " " + text, text.substr(equals + 1), scene);
  if (!body) return tl::unexpected(body.error());
  named.body_id = *body;
  return named;
}

void add_channel_options(CLI::App& app, PoseOptions& options, const std::string& pose,
                         const std::string& force_torque) {
  app.add_option("--pose", options.poses, pose)->allow_extra_args(false)->option_text("CHANNEL=BODY");
  app.add_option("--force-torque", options.force_torques, force_torque)
      ->allow_extra_args(false)
      ->option_text("CHANNEL=BODY");
}

void add_velocity_options(CLI::App& app, PoseOptions& options) {
  app.add_option_function<std::string>(
         "--velocity-frame",
         [&options](const std::string& frame) {
           options.velocity_frame = frame == "body" ? VelocityFrame::kBody : VelocityFrame::kWorld;
         },
         "Frame of pose_t.vel and pose_t.rotation_rate (libbot2 documents world; some senders use body); "
         "required with --lead-time, and for bodies with drag or added mass")
      ->check(CLI::IsMember({"world", "body"}));
  add_lead_time_option(app, options.lead_time, "the poses of --pose");
}

}  // namespace

void add_options(CLI::App& app, PoseOptions& options) {
  add_channel_options(
      app, options,
      "Treat each bot_core.pose_t or bot_core.rigid_transform_t on CHANNEL as a request for BODY (id or name "
      "in the scene). Repeatable",
      "Publish the responses to poses of BODY as bot_core.six_axis_force_torque_t on CHANNEL, in the world "
      "frame about the body's reference point, instead of as body_wrenches_t. Repeatable");
  add_velocity_options(app, options);
}

void add_viewer_channel_options(CLI::App& app, PoseOptions& options) {
  add_channel_options(
      app, options,
      "Show each bot_core.pose_t or bot_core.rigid_transform_t on CHANNEL as BODY (id or name in the scene). "
      "Repeatable",
      "Read responses about BODY from CHANNEL (bot_core.six_axis_force_torque_t). Repeatable");
}

void add_viewer_options(CLI::App& app, PoseOptions& options) {
  add_viewer_channel_options(app, options);
  add_velocity_options(app, options);
}

Expected<std::int32_t> resolve_body(const std::string& subject, const std::string& text, const Scene& scene) {
  const std::vector<std::int32_t> ids = find_bodies(text, scene);
  if (ids.empty()) {
    return make_error(
        {subject, "body '" + text + "'", "the id or the name of a body in " + scene.name(), "", ""});
  }
  if (ids.size() > 1) {
    return make_error({subject, std::to_string(ids.size()) + " bodies are named '" + text + "'",
                       "the name of one", "", "Use its id, such as " + std::to_string(ids.front())});
  }
  return ids.front();
}

Expected<PoseChannels> resolve_pose_channels(const PoseOptions& options, const Scene& scene,
                                             const std::vector<std::string>& reserved) {
  PoseChannels poses;
  std::set<std::string> used(reserved.begin(), reserved.end());
  const auto claim_channel = [&used](const std::string& channel) -> Expected<void> {
    if (used.insert(channel).second) return {};
    return make_error({"channel " + channel, "used for two purposes", "a different channel for each", "",
                       "Name another channel in --pose, --force-torque or the option of the message"});
  };
  for (const std::string& text : options.poses) {
    const Expected<ChannelOfBody> named = parse_channel_of_body("--pose", text, scene);
    if (!named) return tl::unexpected(named.error());
    if (const Expected<void> claimed = claim_channel(named->channel); !claimed) {
      return tl::unexpected(claimed.error());
    }
    poses.channels.push_back({named->channel, named->body_id, ""});
  }
  for (const std::string& text : options.force_torques) {
    const Expected<ChannelOfBody> named = parse_channel_of_body("--force-torque", text, scene);
    if (!named) return tl::unexpected(named.error());
    if (const Expected<void> claimed = claim_channel(named->channel); !claimed) {
      return tl::unexpected(claimed.error());
    }
    bool has_pose_channel = false;
    for (PoseChannel& pose : poses.channels) {
      if (pose.body_id != named->body_id) continue;
      if (!pose.force_torque_channel.empty()) {
        return make_error(
            {"--force-torque " + text, "a second channel for this body", "one channel per body", "", ""});
      }
      pose.force_torque_channel = named->channel;
      has_pose_channel = true;
    }
    if (!has_pose_channel) {
      return make_error({"--force-torque " + text, "a body without a --pose",
                         "--pose CHANNEL=BODY for the same body", "", ""});
    }
  }
  if (!std::isfinite(options.lead_time)) {
    return make_error(
        {"--lead-time", std::to_string(options.lead_time), "a finite number of seconds", "", ""});
  }
  if (options.lead_time != 0.0 && !options.velocity_frame) {
    return make_error({"--lead-time", "no --velocity-frame", "--velocity-frame world or body",
                       "senders use pose_t with either frame, and the message does not state which", ""});
  }
  poses.lead_time = options.lead_time;
  poses.velocity_frame = options.velocity_frame;
  return poses;
}

Expected<void> check_velocities_usable(const PoseChannels& poses, const Scene& scene) {
  if (poses.velocity_frame) return {};
  for (const PoseChannel& pose : poses.channels) {
    const Body* const body = scene.find(pose.body_id);
    if (body == nullptr || body->hydrodynamics == nullptr) continue;
    return make_error({"--pose " + pose.channel + "=" + std::to_string(pose.body_id), "no --velocity-frame",
                       "--velocity-frame world or body, since body '" + body->name +
                           "' has drag or added mass, which depend on its velocities",
                       "senders use pose_t with either frame, and the message does not state which",
                       "State the frame of the sender; a rigid_transform_t has no velocities and cannot be "
                       "used for such a body"});
  }
  return {};
}

}  // namespace buoyancy
