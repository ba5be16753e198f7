#include "service/replay/replay_options.h"

#include <algorithm>
#include <map>
#include <system_error>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "cli/mesh_options.h"
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

bool begins_with_event(const std::filesystem::path& path) {
  Expected<FileWindow> file = FileWindow::open(path);
  return file && event_layout(file->read_at(0, kEventHeaderSize)).has_value();
}

Expected<void> check_formats(const ReplayOptions& options, const ReplayPlan& plan) {
  const bool from_log = plan.input_format == FileFormat::kLcmLog;
  const bool to_log = plan.output_format == FileFormat::kLcmLog;
  if (!options.poses.poses.empty() && !from_log) {
    return make_error({"--pose", options.input.string(), "an .lcmlog as INPUT", "CSV has no channels",
                       "For a file of poses use --body"});
  }
  if (from_log && !(options.body.empty() && options.time_unit.empty())) {
    return make_error({options.body.empty() ? "--time-unit" : "--body", options.input.string(),
                       "poses as text (TUM, EuRoC, nav_msgs) as INPUT", "the messages of a log state both",
                       "For a channel of poses use --pose CHANNEL=BODY"});
  }
  if (!options.poses.force_torques.empty() && !to_log) {
    return make_error({"--force-torque", options.output.string(), "an .lcmlog as OUTPUT", "", ""});
  }
  if (!options.copied.empty() && !(from_log && to_log)) {
    return make_error({"--copy", options.input.string() + " to " + options.output.string(),
                       "an .lcmlog as INPUT and as OUTPUT", "", ""});
  }
  if (!options.baseline.empty() && plan.part) {
    return make_error({"--compare", "together with --part", "a replay of the whole log",
                       "responses are matched along the whole log",
                       "Compare in a replay of its own, without --part"});
  }
  if (!options.baseline.empty() && !options.poses.force_torques.empty()) {
    return make_error({"--compare", "together with --force-torque", "responses as body_wrenches_t",
                       "a six_axis_force_torque_t has no error bound to compare by", ""});
  }
  return {};
}

// Checks that the loads go to a CSV file of their own, in a replay of the whole.
Expected<void> check_loads_file(const ReplayOptions& options) {
  if (options.loads.empty()) return {};
  const Expected<FileFormat> format = output_format(options.loads, FileFormat::kCsv);
  if (!format || *format != FileFormat::kCsv) {
    return make_error({"--loads", options.loads.string(), "a .csv file",
                       "an .lcmlog as OUTPUT holds the loads without this option", ""});
  }
  if (!options.part.empty()) {
    return make_error({"--loads", "together with --part", "a replay of the whole log",
                       "a part has one file, which the join checks and copies",
                       "Name an .lcmlog as OUTPUT: the parts and the join then hold all loads, as messages"});
  }
  std::error_code not_resolved;
  if (std::filesystem::weakly_canonical(options.loads, not_resolved) ==
      std::filesystem::weakly_canonical(options.output, not_resolved)) {
    return make_error({"--loads " + options.loads.string(), "the same file as OUTPUT", "a file of its own",
                       "each would overwrite the other", ""});
  }
  return check_output_not_input(options.loads,
                                {options.input, options.scene, options.mesh, options.baseline});
}

// A part must be able to begin anywhere in INPUT, and be renamed when it is complete.
Expected<void> check_regular_files(const std::string& option, const std::filesystem::path& input,
                                   const std::filesystem::path& output) {
  std::error_code no_such_file;
  if (std::filesystem::is_other(input, no_such_file)) {
    return make_error({option, "INPUT " + input.string() + " is a pipe or device", "a regular file",
                       "a pipe can be read only once and from its beginning; parts begin anywhere in it",
                       "Save the recording to a file first"});
  }
  if (std::filesystem::exists(output, no_such_file) &&
      !std::filesystem::is_regular_file(output, no_such_file)) {
    return make_error(
        {option, "OUTPUT " + output.string() + " is not a regular file", "the name of a regular file",
         "the output appears under its name when it is complete, which a pipe or device cannot", ""});
  }
  return {};
}

Expected<void> plan_part(const ReplayOptions& options, ReplayPlan& plan) {
  if (options.part.empty()) return {};
  plan.part = parse_part(options.part);
  if (!plan.part) {
    return make_error({"--part", "'" + options.part + "'",
                       "I/N, such as 3/7, with I from 1 to N and N at most " + std::to_string(kMaxParts), "",
                       ""});
  }
  return check_regular_files("--part", options.input, options.output);
}

}  // namespace

void add_options(CLI::App& app, ReplayOptions& options) {
  app.description(
      "Compute the buoyant force and torque for recorded body poses, exactly as buoyancyd does.\n"
      "CSV input: utime,body_id,px,py,pz,qw,qx,qy,qz[,vx,vy,vz,wx,wy,wz]; rows with equal utime are one\n"
      "request; writes one row per input row. Poses of one body as TUM, EuRoC or nav_msgs text are told by\n"
      "their columns (--format, --body). LCM log input: requests on one channel, poses of single\n"
      "bodies on others (--pose); responses keep the timestamps of their requests; --copy copies other\n"
      "channels. Several machines can share a replay (--part, --join).\n" +
      exit_status_help(
          {.success = "if every request of INPUT has its response in OUTPUT, or the part is complete",
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
  add_scale_option(app, options.scale, mesh);
  add_up_option(app, options.up, mesh);
  add_states_channel_option(app, options.states_channel);
  add_wrenches_channel_option(app, options.wrenches_channel);
  add_hydrostatics_channel_option(app, options.hydrostatics_channel);
  add_loads_channel_option(app, options.loads_channel);
  add_sea_channel_option(app, options.sea_channel);
  add_sea_grid_channel_option(app, options.sea_grid_channel);
  add_condition_channel_option(app, options.condition_channel);
  add_water_points_channel_option(app, options.water_points_channel);
  add_water_samples_channel_option(app, options.water_samples_channel);
  add_options(app, options.poses);
  app.add_option(
         "--copy", options.copied,
         "Copy events whose channel name fully matches REGEX from the input log to the output log; '.*' "
         "matches every channel. Repeatable. Response channels are never copied")
      ->allow_extra_args(false)
      ->option_text("REGEX");
  app.add_option(
         "--loads", options.loads,
         "Also write the loads of all bodies whose outputs in the scene include them, as CSV: one row "
         "per body and request, with buoyancy, drag, added mass and their matrices")
      ->option_text("CSV");
  app.add_option(
         "--compare", options.baseline,
         "Compare with an earlier OUTPUT, an LCM log: print the largest differences per body, hydrostatics "
         "and loads included, and fail if one exceeds the sum of both error bounds")
      ->option_text("LCMLOG");
  app.add_option("--jobs", options.jobs,
                 "Worker threads (0 = number of hardware threads). OUTPUT does not depend on this setting")
      ->check(CLI::Range(0, 1024))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--part", options.part,
                 "Compute only part I of N, into a file beside OUTPUT named after it, such as "
                 "wrenches.part-3-of-7.lcmlog. Together the parts are what one replay writes")
      ->option_text("I/N");
  app.add_option_function<int>(
         "--join",
         [&options, from](const int& parts) {
           options.join = parts;
           from->require_option(0);
         },
         "Join the N parts that were computed from INPUT to OUTPUT, if they are complete and belong together")
      ->check(CLI::Range(1, kMaxParts))
      ->option_text("N");
  app.add_option(
         "--format", options.format,
         "Format of INPUT: lcm (a log), csv (ours), tum, euroc (ground truth) or nav (exports of nav_msgs "
         "and geometry_msgs); auto tells it by the extension and the columns")
      ->check(CLI::IsMember({"auto", "lcm", "csv", "tum", "euroc", "nav"}))
      ->option_text("FORMAT [auto]");
  app.add_option(
         "--time-unit", options.time_unit,
         "Unit of the times in TUM, EuRoC or nav_msgs text: s, ms, us or ns (default: that of the header, "
         "else guessed by their size)")
      ->check(CLI::IsMember({"s", "ms", "us", "ns"}))
      ->option_text("UNIT");
  app.add_option("--body", options.body,
                 "Body of the poses in TUM, EuRoC or nav_msgs text: its id or name (default: the only one)")
      ->option_text("BODY");
  app.add_option("INPUT", options.input, ".lcmlog or .csv file, or poses as text (--format)")->required();
  CLI::Option* output =
      app.add_option("OUTPUT", options.output, ".csv or .lcmlog file; overwritten")->required();
  app.add_flag_callback(
      "--list",
      [&options, from, output] {
        options.list = true;
        from->require_option(0);
        output->required(false);
      },
      "Only list what INPUT holds: channels, types, numbers of messages and times");
  app.add_flag("--json", options.json, "Print the summary, or the list, as JSON");
}

FileFormat input_format(const ReplayOptions& options) {
  if (options.format != "auto") return options.format == "lcm" ? FileFormat::kLcmLog : FileFormat::kCsv;
  const Expected<FileFormat> named = format_by_extension(options.input);
  if (named) return *named;
  return begins_with_event(options.input) ? FileFormat::kLcmLog : FileFormat::kCsv;
}

TableOptions table_options(const ReplayOptions& options) {
  TableOptions table{.format = TableFormat::kGuess, .time_unit = {}};
  if (options.format == "csv") table.format = TableFormat::kCsv;
  if (options.format == "tum") table.format = TableFormat::kTum;
  if (options.format == "euroc") table.format = TableFormat::kEuroc;
  if (options.format == "nav") table.format = TableFormat::kNav;
  if (options.time_unit == "s") table.time_unit = TimeUnit::kSeconds;
  if (options.time_unit == "ms") table.time_unit = TimeUnit::kMilliseconds;
  if (options.time_unit == "us") table.time_unit = TimeUnit::kMicroseconds;
  if (options.time_unit == "ns") table.time_unit = TimeUnit::kNanoseconds;
  return table;
}

Expected<ReplayPlan> plan_replay(const ReplayOptions& options) {
  ReplayPlan plan;
  plan.input_format = input_format(options);
  const Expected<FileFormat> written_format = output_format(options.output, plan.input_format);
  if (!written_format) return tl::unexpected(written_format.error());
  plan.output_format = *written_format;
  if (const Expected<void> planned = plan_part(options, plan); !planned)
    return tl::unexpected(planned.error());

  if (const Expected<void> checked = check_formats(options, plan); !checked) {
    return tl::unexpected(checked.error());
  }
  if (const Expected<void> checked =
          check_output_not_input(plan.part ? part_path(options.output, *plan.part) : options.output,
                                 {options.input, options.scene, options.mesh, options.baseline});
      !checked) {
    return tl::unexpected(checked.error());
  }
  if (const Expected<void> checked = check_loads_file(options); !checked) {
    return tl::unexpected(checked.error());
  }
  if (const Expected<void> checked = check_channels_distinct(
          {options.states_channel, options.wrenches_channel, options.hydrostatics_channel,
           options.loads_channel, options.sea_channel, options.sea_grid_channel, options.condition_channel,
           options.water_points_channel, options.water_samples_channel});
      !checked) {
    return tl::unexpected(checked.error());
  }
  if (!options.mesh.empty()) {
    std::optional<Method> method = BodyDescription{}.method;
    if (!options.method.empty()) method = method_from_name(options.method);
    if (!method) {
      return make_error({"--method", "'" + options.method + "'", "one of: " + method_names(), "", ""});
    }
    const Expected<MeshPlacement> placement = placement_of(options.scale, options.up);
    if (!placement) return tl::unexpected(placement.error());
    plan.single_mesh = single_mesh_scene(options.mesh, *method, options.tolerance, options.open, *placement);
  }
  return plan;
}

namespace {

// Checks that no options but these and positionals are given.
Expected<void> check_only(const CLI::App& app, const std::vector<std::string>& allowed,
                          const Error& otherwise) {
  std::vector<const CLI::Option*> given = app.get_options();
  const CLI::App* scene_group = app.get_option_group("scene");
  const std::vector<const CLI::Option*> scene = scene_group->get_options();
  given.insert(given.end(), scene.begin(), scene.end());
  for (const CLI::Option* option : given) {
    const std::string name = option->get_name();
    if (option->count() == 0 || std::ranges::find(allowed, name) != allowed.end() || option->get_positional())
      continue;
    Error error = otherwise;
    error.actual = "together with " + name;
    return make_error(std::move(error));
  }
  return {};
}

}  // namespace

Expected<void> check_list(const CLI::App& app, const ReplayOptions& options) {
  if (!options.output.empty()) {
    return make_error(
        {"--list", "OUTPUT " + options.output.string(), "only INPUT", "nothing is computed", ""});
  }
  return check_only(
      app, {"--list", "--json", "--format", "--time-unit"},
      {"--list", "", "only INPUT, --format, --time-unit and --json", "nothing is computed", ""});
}

Expected<void> check_join(const CLI::App& app, const ReplayOptions& options) {
  if (Expected<void> checked = check_only(
          app, {"--join", "--json"},
          {"--join", "", "only INPUT, OUTPUT and --json", "the parts are joined as they were computed", ""});
      !checked) {
    return checked;
  }
  if (const Expected<FileFormat> format = format_by_extension(options.output); !format) {
    return tl::unexpected(format.error());
  }
  if (Expected<void> checked = check_regular_files("--join", options.input, options.output); !checked) {
    return checked;
  }
  return check_output_not_input(options.output, {options.input});
}

namespace {

// Can the replay receive the sea that the scene does not describe?
Expected<void> check_sea_input(const ReplayOptions& options, const Scene& scene) {
  if (!scene.receives_sea()) return {};
  const std::string subject = scene.name() + ": " + to_string(scene.sea_messages());
  if (input_format(options) == FileFormat::kCsv) {
    return make_error({subject, "with " + options.input.string(),
                       "an LCM log, which holds the sea's messages", "a CSV file has poses only",
                       "Describe the sea in the scene"});
  }
  if (!options.part.empty()) {
    return make_error({subject, "with --part " + options.part, "a replay of the whole",
                       "the sea of a part may have been received in an earlier part",
                       "Leave --part out, or describe the sea in the scene"});
  }
  return {};
}

Expected<void> check_loads_requested(const ReplayOptions& options, const Scene& scene) {
  if (options.loads.empty() || scene.bodies_with_loads() > 0) return {};
  return make_error({"--loads " + options.loads.string(), "no body of " + scene.name() + " has loads",
                     "a body with outputs = [\"wrench\", \"loads\"]",
                     options.mesh.empty() ? "" : "--mesh describes a body without drag and added mass",
                     options.mesh.empty() ? "Add this line to the body in the scene file"
                                          : "Describe the body in a scene file (--scene)"});
}

}  // namespace

Expected<ReplayRoutes> plan_routes(const ReplayOptions& options, const Scene& scene) {
  if (const Expected<void> checked = check_sea_input(options, scene); !checked) {
    return tl::unexpected(checked.error());
  }
  if (const Expected<void> checked = check_loads_requested(options, scene); !checked) {
    return tl::unexpected(checked.error());
  }
  std::vector<std::string> responses{options.wrenches_channel, options.hydrostatics_channel,
                                     options.loads_channel, options.water_samples_channel};
  std::vector<std::string> reserved = responses;
  reserved.insert(reserved.end(), {options.states_channel, options.sea_channel, options.sea_grid_channel,
                                   options.condition_channel, options.water_points_channel});
  Expected<PoseChannels> poses = resolve_pose_channels(options.poses, scene, reserved);
  if (!poses) return tl::unexpected(poses.error());
  if (const Expected<void> checked = check_velocities_usable(*poses, scene); !checked) {
    return tl::unexpected(checked.error());
  }
  // Session ids follow the order of the channels: sorting makes them independent of the order of the options.
  std::ranges::sort(poses->channels, {}, &PoseChannel::channel);
  for (const PoseChannel& pose : poses->channels) {
    if (!pose.force_torque_channel.empty()) responses.push_back(pose.force_torque_channel);
  }
  Expected<ReplayChannels> channels =
      ReplayChannels::make({.states = options.states_channel,
                            .sea = scene.receives_grids() ? options.sea_grid_channel
                                   : scene.receives_sea() ? options.sea_channel
                                                          : "",
                            .condition = scene.bodies_with_subdivision() > 0 ? options.condition_channel : "",
                            .water_points = options.water_points_channel},
                           poses->channels, options.copied, std::move(responses));
  if (!channels) return tl::unexpected(channels.error());
  return ReplayRoutes{*std::move(poses), *std::move(channels)};
}

Expected<void> choose_body(const ReplayOptions& options, const Scene& scene, ReplayInput& input) {
  if (input.table() == nullptr) {
    if (options.body.empty() && options.time_unit.empty()) return {};
    return make_error({options.body.empty() ? "--time-unit" : "--body", options.input.string(),
                       "poses as text (TUM, EuRoC, nav_msgs) as INPUT", "rows of our CSV state both", ""});
  }
  if (options.body.empty() && scene.bodies().size() > 1) {
    return make_error(
        {options.input.string(),
         "poses of one body for a scene with " + std::to_string(scene.bodies().size()) + " bodies",
         "--body with the id or the name of one", "", ""});
  }
  Expected<std::int32_t> body =
      options.body.empty() ? scene.bodies().front().id : resolve_body("--body", options.body, scene);
  if (!body) return tl::unexpected(body.error());
  input.set_body(*body);
  return {};
}

Expected<void> check_velocity_columns(const ReplayInput& input, const ReplayOptions& options,
                                      const Scene& scene) {
  if (input.states_velocities()) return {};
  const bool has_table = input.table() != nullptr;
  const auto needs = std::ranges::find_if(scene.bodies(), [&](const Body& body) {
    return body.hydrodynamics != nullptr && (!has_table || body.id == input.body());
  });
  if (needs == scene.bodies().end()) return {};
  const std::string columns = has_table ? "columns of the linear and the angular velocity"
                                        : "the columns vx,vy,vz,wx,wy,wz after the pose";
  return make_error({options.input.string() + (has_table ? "" : ":1"),
                     has_table ? input.table()->description() : "a header without velocities",
                     columns + ", since body '" + needs->name + "' of " + scene.name() +
                         " has drag or added mass, which depend on its velocities",
                     "",
                     "Record the velocities too, or remove [body.drag] and [body.added_mass] to get buoyancy "
                     "alone"});
}

}  // namespace buoyancy::service
