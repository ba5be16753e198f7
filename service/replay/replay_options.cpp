#include "service/replay/replay_options.h"

#include <algorithm>
#include <map>
#include <system_error>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "hydrostatics/solver.h"
#include "transport/lcm_connection.h"

namespace buoyancy::service {
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

// A device or a pipe (/dev/stdout, /dev/full) has no extension: its format is that of the input.
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
  if (!options.baseline.empty() && !options.poses.force_torques.empty()) {
    return make_error({"--compare", "together with --force-torque", "responses as body_wrenches_t",
                       "a six_axis_force_torque_t has no error bound to compare by", ""});
  }
  return {};
}

}  // namespace

void add_options(CLI::App& app, ReplayOptions& options) {
  app.description(
      "Compute the buoyant force and torque for recorded body poses, exactly as buoyancyd does.\n"
      "CSV input: utime,body_id,px,py,pz,qw,qx,qy,qz[,vx,vy,vz,wx,wy,wz]; rows with equal utime are one\n"
      "request; writes one row per input row. LCM log input: requests on one channel, poses of single\n"
      "bodies on others (--pose); responses keep the timestamps of their requests; --copy copies other\n"
      "channels.\n" +
      exit_status_help({.success = "if every request of INPUT has its response in OUTPUT",
                        .failure = "on a runtime error, or if some requests have no response or --compare "
                                   "found differences",
                        .usage_error = "on invalid arguments, scene, mesh or INPUT"}));
  app.set_version_flag("--version", "buoyancy-replay " BUOYANCY_VERSION);
  auto* from = app.add_option_group("scene", "Input geometry (exactly one)");
  from->add_option("--scene", options.scene, "Scene file (TOML): water and bodies");
  CLI::Option* mesh =
      from->add_option("--mesh", options.mesh,
                       "One mesh as body 1, in water of level 0, density 1025 kg/m^3, gravity 9.80665 m/s^2");
  from->require_option(1);
  app.add_option("--method", options.method, "With --mesh: one of " + method_names())
      ->needs(mesh)
      ->type_name("METHOD")
      ->default_str(std::string(to_string(BodyDescription{}.method)));
  app.add_option(
         "--tolerance", options.tolerance,
         "With --mesh: allowed error relative to the weight of the full displacement (0 = exact; only "
         "hierarchical uses it)")
      ->needs(mesh)
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("RATIO")
      ->capture_default_str();
  app.add_option(
         "--open", options.open,
         "With --mesh: dry_boundary accepts a mesh with holes and evaluates it while their edges are dry")
      ->needs(mesh)
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, OpenPolicy>(kOpenPolicyNames.begin(), kOpenPolicyNames.end())))
      ->option_text("refuse|dry_boundary [refuse]");
  add_states_channel_option(app, options.states_channel);
  add_wrenches_channel_option(app, options.wrenches_channel);
  add_hydrostatics_channel_option(app, options.hydrostatics_channel);
  add_options(app, options.poses);
  app.add_option(
         "--copy", options.copied,
         "Copy events whose channel name fully matches REGEX from the input log to the output log; '.*' "
         "matches every channel. Repeatable. Response channels are never copied")
      ->allow_extra_args(false)
      ->option_text("REGEX");
  app.add_option(
         "--compare", options.baseline,
         "Compare with an earlier OUTPUT, an LCM log: print the largest differences per body, hydrostatics "
         "included, and fail if one exceeds the sum of both error bounds")
      ->option_text("LCMLOG");
  app.add_option("--jobs", options.jobs,
                 "Worker threads (0 = number of hardware threads). OUTPUT does not depend on this setting")
      ->check(CLI::Range(0, 1024))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--json", options.json, "Print the summary as JSON");
  app.add_option("INPUT", options.input, ".csv or .lcmlog file")->required();
  app.add_option("OUTPUT", options.output, ".csv or .lcmlog file; overwritten")->required();
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
  if (const Expected<void> checked = check_output_not_input(
          options.output, {options.input, options.scene, options.mesh, options.baseline});
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
  Expected<PoseChannels> poses = resolve_pose_channels(
      options.poses, scene, {options.states_channel, options.wrenches_channel, options.hydrostatics_channel});
  if (!poses) return tl::unexpected(poses.error());
  // Session ids follow the order of the channels: sorting makes them independent of the order of the options.
  std::ranges::sort(poses->channels, {}, &PoseChannel::channel);
  for (const PoseChannel& pose : poses->channels) {
    if (!pose.force_torque_channel.empty()) responses.push_back(pose.force_torque_channel);
  }
  Expected<ReplayChannels> channels =
      ReplayChannels::make(options.states_channel, poses->channels, options.copied, std::move(responses));
  if (!channels) return tl::unexpected(channels.error());
  return ReplayRoutes{*std::move(poses), *std::move(channels)};
}

}  // namespace buoyancy::service
