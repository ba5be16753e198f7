#include "service/mesh/mesh_options.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/format.h"
#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "cli/mesh_options.h"

namespace buoyancy::service {
namespace {

constexpr std::array<std::pair<const char*, MeshCommand>, 3> kCommands{
    {{"report", MeshCommand::kReport}, {"repair", MeshCommand::kRepair}, {"compare", MeshCommand::kCompare}}};

Expected<void> check_command_options(const CLI::App& app, MeshCommand command) {
  constexpr std::array kOfRepair{"--mirror",     "--close",     "--rims", "--rim",
                                 "--max-change", "--freeboard", "--wrap", "--html"};
  constexpr std::array kOfCompare{"--poses", "--density", "--gravity"};
  const auto check = [&](const auto& options, MeshCommand needed) -> Expected<void> {
    for (const char* option : options) {
      if (app.count(option) == 0 || command == needed) continue;
      return make_error({option, "with another command",
                         std::string("the command ") + kCommands[static_cast<std::size_t>(needed)].first, "",
                         ""});
    }
    return {};
  };
  if (Expected<void> checked = check(kOfRepair, MeshCommand::kRepair); !checked) return checked;
  return check(kOfCompare, MeshCommand::kCompare);
}

Expected<void> plan_repair(const MeshOptions& options, MeshPlan& plan) {
  if (options.files.size() != 2) {
    return make_error({"repair", std::to_string(options.files.size()) + " file(s)",
                       "two files: the mesh, and the one to write", "", ""});
  }
  plan.output = options.files.back();
  plan.inputs.pop_back();
  const std::optional<ExportFormat> format = export_format(plan.output);
  if (!format) {
    return make_error({plan.output.string(), "an unknown format", "a name that ends in .stl, .ply or .obj",
                       "", "PLY keeps double precision"});
  }
  plan.format = *format;
  ClosingOptions& closing = plan.preparation.validation.closing;
  closing.holes = options.close;
  closing.all_rims = options.rims;
  closing.rims = options.rim;
  closing.max_change = options.max_change;
  closing.freeboard = options.freeboard;
  if (!options.mirror.empty()) {
    const auto* const axis = std::find(kAxisNames.begin(), kAxisNames.end(), options.mirror);
    plan.preparation.mirror = static_cast<Axis>(axis - kAxisNames.begin());
  }
  if (!options.html.empty() && options.html.lexically_normal() == plan.output.lexically_normal()) {
    return make_error({"--html", options.html.string(), "another file than that of the mesh", "", ""});
  }
  if (Expected<void> checked = check_output_not_input(options.html, {plan.inputs.front()}); !checked)
    return checked;
  return check_output_not_input(plan.output, {plan.inputs.front()});
}

}  // namespace

void add_options(CLI::App& app, MeshOptions& options) {
  constexpr double kMax = 1e9;
  app.description(
      "Check, repair and compare meshes: what is wrong with a mesh, what can be done about it, and what "
      "that\n"
      "changes. Scenes repair what leaves the surface where it is at every load; this program also does "
      "what\n"
      "adds a surface.\n" +
      exit_status_help({.success = "on success; of report: if all meshes are usable as they are",
                        .failure = "if a mesh is not usable, and on a runtime error",
                        .usage_error = "on invalid arguments"}));
  app.set_version_flag("--version", "buoyancy-mesh " BUOYANCY_VERSION);
  std::vector<std::string> commands;
  commands.reserve(kCommands.size());
  for (const auto& [name, command] : kCommands) commands.emplace_back(name);
  app.add_option(
         "command", options.command,
         "report FILE...: faults, holes and what can be done; repair FILE OUTPUT: write a mesh that can "
         "be used, as .stl, .ply (double precision) or .obj; compare A B: volume between two meshes, "
         "distance and loads")
      ->required()
      ->check(CLI::IsMember(commands))
      ->option_text("report|repair|compare");
  app.add_option("files", options.files, "Mesh files; of repair: the mesh and the file to write")
      ->required()
      ->option_text("FILE...");
  add_scale_option(app, options.scale, nullptr);
  add_up_option(app, options.up, nullptr);
  app.add_option("--mirror", options.mirror,
                 "repair: first add the mirror image in the plane x, y or z = 0 of the file, for half a body")
      ->check(CLI::IsMember(std::vector<std::string>(kAxisNames.begin(), kAxisNames.end())))
      ->option_text("x|y|z");
  app.add_flag("--close", options.close,
               "repair: close all holes, if hemispheres over them hold at most --max-change of the volume");
  app.add_flag("--rims", options.rims, "repair: close all holes, whatever their size");
  app.add_option("--rim", options.rim, "repair: close hole N of the report, whatever its size. Repeatable")
      ->check(CLI::PositiveNumber)
      ->allow_extra_args(false)
      ->option_text("N");
  app.add_option("--max-change", options.max_change,
                 "repair: refuse if what closing adds is uncertain by more than this share of the volume")
      ->check(number_in(0.0, kMax, ""))
      ->option_text("SHARE [" + format_shortest(options.max_change) + "]");
  app.add_option("--freeboard", options.freeboard,
                 "repair: first raise rims that face up by this height, m, and close them there")
      ->check(number_in(0.0, kMax, "m"))
      ->option_text("H");
  app.add_option("--poses", options.poses, "compare: attitudes and depths at which loads are compared")
      ->check(CLI::Range(1, 1'000'000))
      ->option_text("N [" + std::to_string(options.poses) + "]");
  app.add_option("--density", options.density, "compare: density of the water, kg/m^3")
      ->check(number_in(0.0, kMax, "kg/m^3"))
      ->option_text("RHO [" + format_shortest(options.density) + "]");
  app.add_option("--gravity", options.gravity, "compare: gravity, m/s^2")
      ->check(number_in(0.0, kMax, "m/s^2"))
      ->option_text("G [" + format_shortest(options.gravity) + "]");
  app.add_option(
         "--wrap", options.wrap,
         "repair: replace the mesh by a closed surface around it, which closes gaps up to this width, m; "
         "holes first, if they can be closed")
      ->check(number_in(0.0, kMax, "m"))
      ->option_text("GAP");
  app.add_option("--html", options.html,
                 "repair: write a page that shows the mesh before and after, with its open edges")
      ->option_text("FILE");
  app.add_flag("--json", options.json, "Print JSON");
}

Expected<MeshPlan> plan_mesh_command(const CLI::App& app, const MeshOptions& options) {
  MeshPlan plan;
  const auto* const command = std::find_if(kCommands.begin(), kCommands.end(),
                                           [&](const auto& known) { return known.first == options.command; });
  plan.command = command->second;
  plan.inputs = options.files;
  if (Expected<void> checked = check_command_options(app, plan.command); !checked)
    return tl::unexpected(checked.error());
  Expected<MeshPlacement> placement = placement_of(options.scale, options.up);
  if (!placement) return tl::unexpected(placement.error());
  plan.preparation.placement = *placement;
  plan.preparation.validation.count_intersecting_pairs = plan.command != MeshCommand::kCompare;
  if (plan.command == MeshCommand::kRepair) {
    if (const Expected<void> planned = plan_repair(options, plan); !planned)
      return tl::unexpected(planned.error());
  } else if (plan.command == MeshCommand::kCompare && options.files.size() != 2) {
    return make_error({"compare", std::to_string(options.files.size()) + " file(s)", "two meshes", "", ""});
  }
  return plan;
}

}  // namespace buoyancy::service
