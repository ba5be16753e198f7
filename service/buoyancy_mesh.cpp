// buoyancy-mesh: the program around the checks and repairs of meshes.
#include <algorithm>
#include <optional>
#include <vector>

#include <CLI/App.hpp>

#include "base/text_file.h"
#include "cli/command_line.h"
#include "service/mesh/mesh_commands.h"
#include "service/mesh/mesh_options.h"
#include "service/mesh/mesh_page.h"

namespace buoyancy::service {
namespace {

int report(const CLI::App& app, const MeshPlan& plan, const MeshOptions& options) {
  std::vector<CheckedMesh> meshes;
  for (const std::filesystem::path& input : plan.inputs) {
    CheckedMesh& mesh = meshes.emplace_back(check_mesh(input, plan.preparation));
    if (meshes.size() > 1) mesh.mesh = mesh.mesh ? std::optional(TriangleMesh{}) : std::nullopt;
  }
  const bool all_usable = std::all_of(meshes.begin(), meshes.end(),
                                      [](const CheckedMesh& mesh) { return mesh.mesh.has_value(); });
  if (!print_output(app, options.json ? report_json(meshes) : report_text(meshes))) return kFailure;
  return all_usable ? kSuccess : kFailure;
}

int repair(const CLI::App& app, const MeshPlan& plan, const MeshOptions& options) {
  const auto fail = [&app](const Error& error) {
    print_error(app, error);
    return kFailure;
  };
  CheckedMesh repaired = check_mesh(plan.inputs.front(), plan.preparation);
  if (options.wrap > 0.0) {
    Expected<CheckedMesh> wrap = wrapped(repaired, plan, options.wrap);
    if (!wrap) return fail(wrap.error());
    repaired = *std::move(wrap);
  }
  if (!options.html.empty() && repaired.report) {
    const Expected<std::string> page = mesh_page(plan, repaired);
    if (!page) return fail(page.error());
    if (const Expected<void> written = write_file(options.html, *page); !written)
      return fail(written.error());
  }
  if (!repaired.mesh) {
    if (repaired.report || options.json) {
      print_output(app, options.json ? report_json({repaired}) : to_text(*repaired.report) + "\n");
    }
    return fail(*repaired.error);
  }
  const std::string output = plan.output.string();
  Expected<CheckedMesh> written_mesh = as_written(std::move(repaired), output);
  if (!written_mesh) return fail(written_mesh.error());
  repaired = *std::move(written_mesh);
  if (const Expected<void> written = write_file(plan.output, export_mesh(*repaired.mesh, plan.format));
      !written) {
    return fail(written.error());
  }
  const std::string text = options.json ? repair_json(repaired, output) : repair_text(repaired, output);
  return print_output(app, text) ? kSuccess : kFailure;
}

int compare(const CLI::App& app, const MeshPlan& plan, const MeshOptions& options) {
  const Expected<std::string> text = compare_meshes(plan, options);
  if (!text) {
    print_error(app, text.error());
    return kFailure;
  }
  return print_output(app, *text) ? kSuccess : kFailure;
}

int run(int argc, char** argv) {
  CLI::App app("", "buoyancy-mesh");
  MeshOptions options;
  add_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const Expected<MeshPlan> plan = plan_mesh_command(app, options);
  if (!plan) {
    print_error(app, plan.error());
    return kUsageError;
  }
  switch (plan->command) {
    case MeshCommand::kReport:
      return report(app, *plan, options);
    case MeshCommand::kRepair:
      return repair(app, *plan, options);
    case MeshCommand::kCompare:
      return compare(app, *plan, options);
  }
  return kFailure;
}

}  // namespace
}  // namespace buoyancy::service

int main(int argc, char** argv) {
  return buoyancy::service::run(argc, argv);
}
