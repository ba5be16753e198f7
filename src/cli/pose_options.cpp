#include "cli/pose_options.h"

#include <charconv>
#include <map>
#include <set>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

struct ChannelOfBody {
  std::string channel;
  std::int32_t body_id = 0;
};

// By id or, where that is none, by name: several, where several have it.
std::vector<std::int32_t> bodies_named(const std::string& text, const Scene& scene) {
  std::int32_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error == std::errc{} && end == text.data() + text.size() && scene.find(id) != nullptr) return {id};
  std::vector<std::int32_t> found;
  for (const Body& body : scene.bodies()) {
    if (body.name == text) found.push_back(body.id);
  }
  return found;
}

Expected<ChannelOfBody> channel_of_body(const std::string& option, const std::string& text,
                                        const Scene& scene) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) {
    return make_error({option, "'" + text + "'", "CHANNEL=BODY", "", ""});
  }
  ChannelOfBody named{text.substr(0, equals), 0};
  if (const Expected<void> checked = check_channel(named.channel); !checked) {
    return tl::unexpected(checked.error());
  }
  const std::string body = text.substr(equals + 1);
  const std::vector<std::int32_t> ids = bodies_named(body, scene);
  if (ids.empty()) {
    return make_error({option + " " + text, "body '" + body + "'",
                       "the id or the name of a body in " + scene.name(), "", ""});
  }
  if (ids.size() > 1) {
    return make_error({option + " " + text, std::to_string(ids.size()) + " bodies are named '" + body + "'",
                       "the name of one", "", "Say its id, such as " + std::to_string(ids.front())});
  }
  named.body_id = ids.front();
  return named;
}

}  // namespace

void add_pose_channel_options(CLI::App& app, PoseOptions& options) {
  app.add_option(
         "--pose", options.poses,
         "Each bot_core.pose_t or bot_core.rigid_transform_t on CHANNEL is a request about BODY, an id "
         "or a name of the scene; may be given again for other channels")
      ->allow_extra_args(false)
      ->option_text("CHANNEL=BODY");
  app.add_option(
         "--force-torque", options.force_torques,
         "Poses of BODY are answered as bot_core.six_axis_force_torque_t on CHANNEL, in the world frame "
         "about the body's reference point; without it as body_wrenches_t")
      ->allow_extra_args(false)
      ->option_text("CHANNEL=BODY");
}

void add_options(CLI::App& app, PoseOptions& options) {
  add_pose_channel_options(app, options);
  app.add_option_function<std::string>(
         "--velocity-frame",
         [&options](const std::string& frame) {
           options.velocity_frame = frame == "body" ? VelocityFrame::kBody : VelocityFrame::kWorld;
         },
         "What a pose_t's vel and rotation_rate are given in; libbot2 says world, others mean the body")
      ->check(CLI::IsMember({"world", "body"}))
      ->option_text("world|body");
  app.add_option("--lead-time", options.lead_time,
                 "Answers poses for where the body will be so much later, by its velocities; needs "
                 "--velocity-frame")
      ->option_text("SECONDS [0]");
}

Expected<PoseChannels> pose_channels(const PoseOptions& options, const Scene& scene,
                                     const std::vector<std::string>& taken) {
  PoseChannels poses;
  std::set<std::string> used(taken.begin(), taken.end());
  const auto used_before = [&used](const std::string& channel) -> Expected<void> {
    if (used.insert(channel).second) return {};
    return make_error({"channel " + channel, "named for two things", "a name for each", "", ""});
  };
  for (const std::string& text : options.poses) {
    const Expected<ChannelOfBody> named = channel_of_body("--pose", text, scene);
    if (!named) return tl::unexpected(named.error());
    if (const Expected<void> once = used_before(named->channel); !once) return tl::unexpected(once.error());
    poses.channels.push_back({named->channel, named->body_id, ""});
  }
  for (const std::string& text : options.force_torques) {
    const Expected<ChannelOfBody> named = channel_of_body("--force-torque", text, scene);
    if (!named) return tl::unexpected(named.error());
    if (const Expected<void> once = used_before(named->channel); !once) return tl::unexpected(once.error());
    bool asked = false;
    for (PoseChannel& pose : poses.channels) {
      if (pose.body_id != named->body_id) continue;
      if (!pose.force_torque_channel.empty()) {
        return make_error({"--force-torque " + text, "a second channel for this body", "one", "", ""});
      }
      pose.force_torque_channel = named->channel;
      asked = true;
    }
    if (!asked) {
      return make_error({"--force-torque " + text, "a body of which no --pose is given",
                         "--pose CHANNEL=BODY of it", "", ""});
    }
  }
  if (!std::isfinite(options.lead_time)) {
    return make_error(
        {"--lead-time", std::to_string(options.lead_time), "a finite number of seconds", "", ""});
  }
  if (options.lead_time != 0.0 && !options.velocity_frame) {
    return make_error({"--lead-time", "no --velocity-frame", "--velocity-frame world or body",
                       "the same type is used for both, and the log does not say which", ""});
  }
  poses.lead_time = options.lead_time;
  poses.velocity_frame = options.velocity_frame;
  return poses;
}

}  // namespace buoyancy
