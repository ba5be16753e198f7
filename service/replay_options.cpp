#include "service/replay_options.h"

#include <system_error>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "hydrostatics/solver.h"
#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

std::string method_names() {
  std::string names;
  for (const Method method : kAllMethods) {
    if (!names.empty()) names += ' ';
    names += name(method);
  }
  return names;
}

Expected<FileFormat> format_by_extension(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".csv") return FileFormat::kCsv;
  if (extension == ".lcmlog") return FileFormat::kLcmLog;
  return failure({path.string(), "extension '" + extension + "'", ".csv or .lcmlog", "", ""});
}

// A device or a pipe (/dev/stdout, /dev/full) has no extension: what is written there is what was read.
Expected<FileFormat> output_format(const std::filesystem::path& path, FileFormat input_format) {
  std::error_code no_such_file;
  if (std::filesystem::is_other(path, no_such_file) && path.extension().empty()) return input_format;
  return format_by_extension(path);
}

}  // namespace

void declare_options(CLI::App& app, ReplayOptions& options) {
  app.description(
      "Answers recorded body poses with the buoyant force and torque on each body, as buoyancyd would.\n"
      "CSV in: utime,body_id,px,py,pz,qw,qx,qy,qz and, if they are there, vx,vy,vz,wx,wy,wz; a row per row "
      "comes\n"
      "out; rows with the same utime are one question. LCM logs: the questions on one channel; other "
      "channels\n"
      "are not copied.\n"
      "Exit codes: 0 every question of INPUT has its answer in OUTPUT, 1 it ran and some have not, 2 wrong\n"
      "arguments, scene, mesh or INPUT.");
  app.set_version_flag("--version", "buoyancy-replay " BUOYANCY_VERSION);
  auto* from = app.add_option_group("scene", "What floats: one of");
  from->add_option("--scene", options.scene, "The scene file (TOML): water and bodies");
  CLI::Option* mesh =
      from->add_option("--mesh", options.mesh,
                       "One mesh as body 1, in water of level 0, density 1025 kg/m^3, gravity 9.80665 m/s^2");
  from->require_option(1);
  app.add_option("--method", options.method, "With --mesh: " + method_names())
      ->needs(mesh)
      ->option_text("METHOD [" + std::string(name(BodyDescription{}.method)) + "]");
  app.add_option("--tolerance", options.tolerance,
                 "With --mesh: error allowed, relative to the whole displacement's weight; 0: exact")
      ->needs(mesh)
      ->check(CLI::Range(0.0, 1.0))
      ->option_text("0..1 [0]");
  app.add_option("--states-channel", options.states_channel, "Channel of the questions in an LCM log")
      ->capture_default_str();
  app.add_option("--wrenches-channel", options.wrenches_channel, "Channel of the answers in an LCM log")
      ->capture_default_str();
  app.add_option(
         "--hydrostatics-channel", options.hydrostatics_channel,
         "Channel of the hydrostatics in an LCM log, of bodies whose outputs in the scene name them; a CSV "
         "file holds wrenches alone")
      ->capture_default_str();
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

  for (const std::filesystem::path& read : {options.input, options.scene, options.mesh}) {
    std::error_code no_such_file;
    if (std::filesystem::equivalent(read, options.output, no_such_file)) {
      return failure({options.output.string(), "the same file as " + read.string(), "an OUTPUT of its own",
                      "replaying would overwrite what it reads", ""});
    }
  }
  for (const std::string& channel :
       {options.states_channel, options.wrenches_channel, options.hydrostatics_channel}) {
    if (const Expected<void> checked = check_channel(channel); !checked)
      return tl::unexpected(checked.error());
  }
  if (options.wrenches_channel == options.hydrostatics_channel) {
    return failure({"channel " + options.wrenches_channel, "named for wrenches and for hydrostatics",
                    "two different names", "", ""});
  }
  if (!options.mesh.empty()) {
    std::optional<Method> method = BodyDescription{}.method;
    if (!options.method.empty()) method = method_from_name(options.method);
    if (!method) {
      return failure({"--method", "'" + options.method + "'", "one of: " + method_names(), "", ""});
    }
    plan.single_mesh = single_mesh_scene(options.mesh, *method, options.tolerance);
  }
  return plan;
}

}  // namespace buoyancy
