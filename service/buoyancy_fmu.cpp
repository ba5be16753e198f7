// buoyancy-fmu: the program that packs a scene into an FMU.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/command_line.h"
#include "service/fmu/fmu_package.h"

namespace buoyancy::service {
namespace {

struct FmuOptions {
  std::string scene;
  std::string output;
  std::optional<int> version;
  std::vector<std::string> bodies;
};

void add_options(CLI::App& app, FmuOptions& options) {
  app.description(
      "Pack a scene into an FMU for co-simulation, which computes the force and torque of the water on its "
      "bodies and needs nothing installed.\n" +
      exit_status_help({.success = "on success", .failure = "if an FMU cannot be written"}));
  app.set_version_flag("--version", "buoyancy-fmu " BUOYANCY_VERSION);
  app.add_option("--scene", options.scene, "Scene file (TOML): water and bodies")->required();
  app.add_option("--output", options.output,
                 "FMU to write, NAME.fmu; overwritten. NAME, made an identifier, names the model")
      ->required();
  app.add_option("--fmi", options.version,
                 "Version of the standard. By default both: 3.0 in NAME.fmu and 2.0 in NAME_fmi2.fmu")
      ->check(CLI::IsMember({2, 3}))
      ->option_text("2|3");
  app.add_option("--body", options.bodies,
                 "Id or name of a body that the FMU has; repeatable. By default all")
      ->allow_extra_args(false)
      ->option_text("BODY");
}

int run(int argc, char** argv) {
  CLI::App app("", "buoyancy-fmu");
  FmuOptions options;
  add_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const auto fail = [&app](const Error& error, ExitCode code) {
    print_error(app, error);
    return code;
  };
  const std::filesystem::path output(options.output);
  if (output.extension() != ".fmu") {
    return fail({"--output", "'" + options.output + "'", "a name that ends in .fmu",
                 "hosts know an FMU by this extension", ""},
                kUsageError);
  }
  const Expected<FmuContent> content =
      fmu_content(options.scene, fmu::to_identifier(output.stem().string()), options.bodies);
  if (!content) return fail(content.error(), kUsageError);
  std::vector<std::pair<fmu::FmiVersion, std::filesystem::path>> outputs;
  if (options.version.value_or(3) == 3) outputs.emplace_back(fmu::FmiVersion::k3, output);
  if (options.version.value_or(2) == 2) {
    const auto beside = output.parent_path() / (output.stem().string() + "_fmi2.fmu");
    outputs.emplace_back(fmu::FmiVersion::k2, options.version ? output : beside);
  }
  std::string text;
  for (const auto& [version, path] : outputs) {
    if (const Expected<void> written = write_archive(path, fmu_files(*content, version)); !written) {
      return fail(written.error(), kFailure);
    }
    text += path.string() + (version == fmu::FmiVersion::k2 ? ": FMI 2.0\n" : ": FMI 3.0\n");
  }
  return print_output(app, text) ? kSuccess : kFailure;
}

}  // namespace
}  // namespace buoyancy::service

int main(int argc, char** argv) {
  return buoyancy::service::run(argc, argv);
}
