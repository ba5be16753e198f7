// buoyancy-report: writes a recorded run as a self-contained HTML page.
#include <algorithm>
#include <csignal>
#include <filesystem>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/format.h"
#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "cli/pose_options.h"
#include "cli/progress_bar.h"
#include "cli/termination_signals.h"
#include "recording/record_writer.h"
#include "scene/mesh_warnings.h"
#include "scene/scene.h"
#include "view/common/scene_model.h"
#include "view/page/page_assets.h"
#include "view/report/body_list.h"
#include "view/report/report_page.h"
#include "view/report/run_file.h"

namespace buoyancy::view {
namespace {

constexpr std::size_t kMaxRows = 40'000;  // of all bodies; about 10 MB of page

struct ReportArguments {
  std::filesystem::path scene, run, output;
  std::filesystem::path three = kThreeJs;
  RunFileOptions file;
  PoseOptions poses;
  std::string bodies;
};

void add_options(CLI::App& app, ReportArguments& arguments) {
  app.description(
      R"(Write a recorded run as one HTML page that any browser displays without a network: playback of
the bodies in the water, plots, and which evaluations were skipped. RUN is a CSV file of
buoyancy-client, a CSV file of poses (see buoyancy-replay), or a log of lcm-logger. A long run is
decimated; its extremes are kept.
)" + exit_status_help({.success = "on success",
                       .failure = "on a runtime error, an interruption by SIGINT or SIGTERM, or if parts of "
                                  "RUN could not be read",
                       .usage_error = "on invalid arguments, scene, mesh or RUN"}));
  app.set_version_flag("--version", "buoyancy-report " BUOYANCY_VERSION);
  app.add_option("--scene", arguments.scene, "Scene file (TOML): water and bodies")->required();
  add_states_channel_option(app, arguments.file.states_channel);
  add_wrenches_channel_option(app, arguments.file.wrenches_channel);
  add_loads_channel_option(app, arguments.file.loads_channel);
  add_sea_channel_option(app, arguments.file.sea_channel);
  add_sea_grid_channel_option(app, arguments.file.sea_grid_channel);
  add_condition_channel_option(app, arguments.file.condition_channel);
  add_status_channel_option(app, arguments.file.status_channel);
  add_viewer_options(app, arguments.poses);
  app.add_option(
      "--bodies", arguments.bodies,
      "Ids of the bodies to show, at most 1,000, such as 1-50,900 (default: the first 1,000 in RUN). The "
      "page summarizes each of the others in one line: rows, statuses, largest recorded force");
  app.add_option("--three", arguments.three, "three.js library (three.min.js) to embed in the page")
      ->capture_default_str();
  app.add_option("RUN", arguments.run, "Input file, .csv or .lcmlog")->required();
  app.add_option("OUTPUT", arguments.output, "HTML file to write; overwritten if it exists")->required();
}

Expected<void> write_page(const std::filesystem::path& path, const std::string& page) {
  Expected<RecordWriter> file = RecordWriter::create(path);
  if (!file) return tl::unexpected(file.error());
  const Bytes bytes{reinterpret_cast<const std::uint8_t*>(page.data()), page.size()};
  if (Expected<void> written = file->append(bytes); !written) return written;
  return file->flush();
}

std::string summary(const RecordedRun& run, const ReportArguments& arguments, std::size_t bytes) {
  std::int64_t recorded = 0;
  std::int64_t kept = 0;
  std::int64_t others = 0;
  for (const BodyRun& body : run.bodies) {
    if (!body.shown) {
      others += body.recorded > 0 ? 1 : 0;
      continue;
    }
    recorded += body.recorded;
    kept += static_cast<std::int64_t>(body.rows.size());
  }
  const auto shown = std::ranges::count_if(run.bodies, &BodyRun::shown);
  std::string text = arguments.output.string() + ": " + pluralize(shown, "body", "bodies") + ", " +
                     pluralize(recorded, "row", "rows");
  if (kept < recorded) text += ", decimated to " + std::to_string(kept) + " with the extremes kept";
  if (others > 0)
    text += "; " + pluralize(others, "more body", "more bodies") + " only as a summary (see --bodies)";
  return text + "; " + std::to_string((bytes + 500'000) / 1'000'000) + " MB\n";
}

int report_main(int argc, char** argv) {
  CLI::App app("", "buoyancy-report");
  ReportArguments arguments;
  add_options(app, arguments);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const auto fail = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  const Expected<void> separate = check_output_not_input(arguments.output, {arguments.run, arguments.scene});
  if (!separate) return fail(separate.error(), kUsageError);
  const Expected<std::string> three = three_js(arguments.three);
  if (!three) return fail(three.error(), kFailure);
  const Expected<Scene> scene = Scene::load(arguments.scene);
  if (!scene) return fail(scene.error(), kUsageError);
  for (const Warning& warning : mesh_warnings(*scene)) print_warning(app, warning);
  Expected<PoseChannels> poses = resolve_pose_channels(
      arguments.poses, *scene,
      {arguments.file.states_channel, arguments.file.wrenches_channel, arguments.file.loads_channel,
       arguments.file.sea_channel, arguments.file.sea_grid_channel, arguments.file.condition_channel,
       arguments.file.status_channel});
  if (!poses) return fail(poses.error(), kUsageError);
  arguments.file.poses = *std::move(poses);

  if (!arguments.bodies.empty()) {
    Expected<std::vector<std::size_t>> bodies = body_list(arguments.bodies, *scene);
    if (!bodies) return fail(bodies.error(), kUsageError);
    arguments.file.bodies = *std::move(bodies);
  }

  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a closed OUTPUT pipe is then reported as a failed write
  ProgressBar progress("rows");
  arguments.file.progress = [&](std::int64_t done, std::int64_t total, std::int64_t rows) {
    progress.update(done, total, rows);
    return !signals.pending();
  };
  const Expected<RecordedRun> run = read_run(arguments.run, *scene, kMaxRows, arguments.file);
  progress.clear();
  if (!run) return fail(run.error(), kUsageError);
  for (const std::string& warning : run->warnings) print_error(app, arguments.run.string() + ": " + warning);
  if (run->suppressed_warnings > 0) {
    print_error(app,
                pluralize(run->suppressed_warnings, "more input error", "more input errors") + " not shown");
  }
  const char* const stopped_by = signals.consume();
  if (stopped_by != nullptr) {
    print_error(app,
                std::string("terminated by ") + stopped_by + "; the page shows the rows read until then");
  }

  const std::string page = report_page(report_data(*scene, *run,
                                                   {.file = arguments.run.filename().string(),
                                                    .version = BUOYANCY_VERSION,
                                                    .selected = !arguments.file.bodies.empty()}),
                                       *three,
                                       {.loads = std::ranges::any_of(scene->bodies(), has_loads),
                                        .subdivision = scene->bodies_with_subdivision() > 0});
  if (const Expected<void> written = write_page(arguments.output, page); !written) {
    return fail(written.error(), kFailure);
  }
  if (!print_output(app, summary(*run, arguments, page.size()))) return kFailure;
  return run->warnings.empty() && stopped_by == nullptr ? kSuccess : kFailure;
}

}  // namespace
}  // namespace buoyancy::view

int main(int argc, char** argv) {
  return buoyancy::view::report_main(argc, argv);
}
