#include "service/replay/replay_options.h"

#include <algorithm>
#include <map>
#include <system_error>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/command_line.h"
#include "hydrostatics/solver.h"
#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

std::string method_names() {
  std::string names;
  for (const Method method : kAllMethods) {
    if (!names.empty()) names += ' ';
    names += to_string(method);
  }
  return names;
}

Expected<FileFormat> format_by_extension(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".csv") return FileFormat::kCsv;
  if (extension == ".lcmlog") return FileFormat::kLcmLog;
  return make_error({path.string(), "extension '" + extension + "'", ".csv or .lcmlog", "", ""});
}

// A device or a pipe (/dev/stdout, /dev/full) has no extension: what is written there is what was read.
Expected<FileFormat> output_format(const std::filesystem::path& path, FileFormat input_format) {
  std::error_code no_such_file;
  if (std::filesystem::is_other(path, no_such_file) && path.extension().empty()) return input_format;
  return format_by_extension(path);
}

Expected<void> check_formats(const ReplayOptions& options, const ReplayPlan& plan) {
  const bool from_log = plan.input_format == FileFormat::kLcmLog;
  const bool to_log = plan.output_format == FileFormat::kLcmLog;
  if (!options.poses.poses.empty() && !from_log) {
    return make_error({"--pose", options.input.string(), "an .lcmlog as INPUT", "CSV has no channels", ""});
  }
  if (!options.poses.force_torques.empty() && !to_log) {
    return make_error({"--force-torque", options.output.string(), "an .lcmlog as OUTPUT", "", ""});
  }
  if (!options.copied.empty() && !(from_log && to_log)) {
    return make_error({"--copy", options.input.string() + " to " + options.output.string(),
                       "an .lcmlog as INPUT and as OUTPUT", "", ""});
  }
  if (!options.earlier.empty() && !options.poses.force_torques.empty()) {
    return make_error({"--compare", "together with --force-torque", "answers as body_wrenches_t",
                       "a six_axis_force_torque_t has no error bound to compare by", ""});
  }
  return {};
}

}  // namespace

void add_options(CLI::App& app, ReplayOptions& options) {
  app.description(
      "Answers recorded body poses with the buoyant force and torque on each body, as buoyancyd would.\n"
      "CSV in: utime,body_id,px,py,pz,qw,qx,qy,qz and, if they are there, vx,vy,vz,wx,wy,wz; a row per row "
      "comes\n"
      "out; rows with the same utime are one request. LCM logs: the requests on one channel, and poses of "
      "single\n"
      "bodies on others (--pose); answers keep the timestamps of what they answer; other channels are copied "
      "on\n"
      "request (--copy).\n"
      "Exit codes: 0 every request of INPUT has its response in OUTPUT, 1 it ran and some have not, or they "
      "do "
      "not\n"
      "agree with those compared with, 2 wrong arguments, scene, mesh or INPUT.");
  app.set_version_flag("--version", "buoyancy-replay " BUOYANCY_VERSION);
  auto* from = app.add_option_group("scene", "What floats: one of");
  from->add_option("--scene", options.scene, "The scene file (TOML): water and bodies");
  CLI::Option* mesh =
      from->add_option("--mesh", options.mesh,
                       "One mesh as body 1, in water of level 0, density 1025 kg/m^3, gravity 9.80665 m/s^2");
  from->require_option(1);
  app.add_option("--method", options.method, "With --mesh: " + method_names())
      ->needs(mesh)
      ->option_text("METHOD [" + std::string(to_string(BodyDescription{}.method)) + "]");
  app.add_option("--tolerance", options.tolerance,
                 "With --mesh: error allowed, relative to the whole displacement's weight; 0: exact")
      ->needs(mesh)
      ->check(CLI::Range(0.0, 1.0))
      ->option_text("0..1 [0]");
  app.add_option(
         "--open", options.open,
         "With --mesh: dry_boundary accepts a mesh with holes and answers it while their edges are dry")
      ->needs(mesh)
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, OpenPolicy>(kOpenPolicyNames.begin(), kOpenPolicyNames.end())))
      ->option_text("refuse|dry_boundary [refuse]");
  app.add_option("--states-channel", options.states_channel, "Channel of the requests in an LCM log")
      ->capture_default_str();
  app.add_option("--wrenches-channel", options.wrenches_channel, "Channel of the responses in an LCM log")
      ->capture_default_str();
  app.add_option(
         "--hydrostatics-channel", options.hydrostatics_channel,
         "Channel of the hydrostatics in an LCM log, of bodies whose outputs in the scene name them; a CSV "
         "file holds wrenches alone")
      ->capture_default_str();
  add_options(app, options.poses);
  app.add_option(
         "--copy", options.copied,
         "Copies the events of channels whose whole name matches, of an LCM log to an LCM log; '.*' copies "
         "all but the channels that answers go to. May be given again")
      ->allow_extra_args(false)
      ->option_text("REGEX");
  app.add_option(
         "--compare", options.earlier,
         "An earlier OUTPUT, an LCM log: prints the largest differences by body, hydrostatics included, and "
         "fails where they exceed the error bounds of both answers")
      ->option_text("LCMLOG");
  app.add_option("--jobs", options.jobs,
                 "Threads; 0: as many as the processor runs at once. OUTPUT does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->option_text("N [0]");
  app.add_flag("--json", options.json, "The summary as JSON");
  app.add_option("INPUT", options.input, "A .csv or .lcmlog file")->required();
  app.add_option("OUTPUT", options.output, "A .csv or .lcmlog file; overwritten")->required();
}

Expected<ReplayPlan> plan_replay(const ReplayOptions& options) {
  ReplayPlan plan;
  const Expected<FileFormat> input_format = format_by_extension(options.input);
  if (!input_format) return tl::unexpected(input_format.error());
  plan.input_format = *input_format;
  const Expected<FileFormat> written_format = output_format(options.output, *input_format);
  if (!written_format) return tl::unexpected(written_format.error());
  plan.output_format = *written_format;

  if (const Expected<void> checked = check_formats(options, plan); !checked) {
    return tl::unexpected(checked.error());
  }
  if (const Expected<void> checked = check_output_is_its_own(
          options.output, {options.input, options.scene, options.mesh, options.earlier});
      !checked) {
    return tl::unexpected(checked.error());
  }
  if (const Expected<void> checked = check_channels_distinct(
          {options.states_channel, options.wrenches_channel, options.hydrostatics_channel});
      !checked) {
    return tl::unexpected(checked.error());
  }
  if (!options.mesh.empty()) {
    std::optional<Method> method = BodyDescription{}.method;
    if (!options.method.empty()) method = method_from_name(options.method);
    if (!method) {
      return make_error({"--method", "'" + options.method + "'", "one of: " + method_names(), "", ""});
    }
    plan.single_mesh = single_mesh_scene(options.mesh, *method, options.tolerance, options.open);
  }
  return plan;
}

Expected<ReplayRoutes> plan_routes(const ReplayOptions& options, const Scene& scene) {
  std::vector<std::string> responses{options.wrenches_channel, options.hydrostatics_channel};
  Expected<PoseChannels> poses = pose_channels(
      options.poses, scene, {options.states_channel, options.wrenches_channel, options.hydrostatics_channel});
  if (!poses) return tl::unexpected(poses.error());
  // Their sessions are counted from the first: the same whatever the order of the options.
  std::ranges::sort(poses->channels, {}, &PoseChannel::channel);
  for (const PoseChannel& pose : poses->channels) {
    if (!pose.force_torque_channel.empty()) responses.push_back(pose.force_torque_channel);
  }
  Expected<ReplayChannels> channels =
      ReplayChannels::make(options.states_channel, poses->channels, options.copied, std::move(responses));
  if (!channels) return tl::unexpected(channels.error());
  return ReplayRoutes{*std::move(poses), *std::move(channels)};
}

}  // namespace buoyancy
