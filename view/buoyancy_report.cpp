// buoyancy-report: a run as one HTML page.
#include <algorithm>
#include <csignal>
#include <filesystem>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/command_line.h"
#include "cli/pose_options.h"
#include "cli/progress_bar.h"
#include "cli/termination_signals.h"
#include "recording/record_writer.h"
#include "scene/scene.h"
#include "view/common/page_assets.h"
#include "view/report/body_list.h"
#include "view/report/report_page.h"
#include "view/report/run_file.h"

namespace {

using namespace buoyancy;

constexpr std::size_t kMaxRows = 40'000;  // of all bodies: some 10 MB of page

struct ReportArguments {
  std::filesystem::path scene, run, output;
  std::filesystem::path three = kThreeJs;
  RunFileOptions file;
  PoseOptions poses;
  std::string bodies;
};

void add_options(CLI::App& app, ReportArguments& arguments) {
  app.description(
      "Writes a recorded run as one HTML page that any browser shows without a network: the bodies in the\n"
      "water to be played back, plots, and what was skipped. RUN is the CSV of buoyancy-client, poses as\n"
      "buoyancy-replay takes them, or a log of lcm-logger; a long one is thinned with its extremes kept.\n"
      "Exit codes: 0 done, 1 it ran and failed, or parts of RUN could not be read, 2 wrong arguments, "
      "scene,\n"
      "mesh or RUN.");
  app.set_version_flag("--version", "buoyancy-report " BUOYANCY_VERSION);
  app.add_option("--scene", arguments.scene, "The scene file (TOML): water and bodies")->required();
  app.add_option("--states-channel", arguments.file.states_channel, "Channel of the requests in an LCM log")
      ->capture_default_str();
  app.add_option("--wrenches-channel", arguments.file.wrenches_channel,
                 "Channel of the responses in an LCM log")
      ->capture_default_str();
  app.add_option("--status-channel", arguments.file.status_channel, "Channel of the status in an LCM log")
      ->capture_default_str();
  add_options(app, arguments.poses);
  app.add_option(
      "--bodies", arguments.bodies,
      "Ids of the bodies to show, such as 1-50,900, at most 1,000. Default: the first 1,000 that RUN\n"
      "names. Of the others the page has one line each: rows, statuses, largest recorded force");
  app.add_option("--three", arguments.three,
                 "Another three.js than Debian's libjs-three, to go into the page");
  app.add_option("RUN", arguments.run, "A .csv or .lcmlog file")->required();
  app.add_option("OUTPUT", arguments.output, "The page; overwritten")->required();
}

Expected<void> write_page(const std::filesystem::path& path, const std::string& page) {
  Expected<RecordWriter> file = RecordWriter::create(path);
  if (!file) return tl::unexpected(file.error());
  const Bytes bytes{reinterpret_cast<const std::uint8_t*>(page.data()), page.size()};
  if (Expected<void> written = file->append(bytes); !written) return written;
  return file->flush();
}

std::string summary_of(const RecordedRun& run, const ReportArguments& arguments, std::size_t bytes) {
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
  std::string text = arguments.output.string() + ": " + std::to_string(shown) + " bodies, " +
                     std::to_string(recorded) + " rows";
  if (kept < recorded) text += ", thinned to " + std::to_string(kept) + " with the extremes kept";
  if (others > 0) text += "; " + std::to_string(others) + " more bodies only as a summary (see --bodies)";
  return text + "; " + std::to_string((bytes + 500'000) / 1'000'000) + " MB\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("", "buoyancy-report");
  ReportArguments arguments;
  add_options(app, arguments);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const auto refuse = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  const Expected<void> own = check_output_is_its_own(arguments.output, {arguments.run, arguments.scene});
  if (!own) return refuse(own.error(), kUsageError);
  const Expected<std::string> three = three_js(arguments.three);
  if (!three) return refuse(three.error(), kFailure);
  const Expected<Scene> scene = Scene::load(arguments.scene);
  if (!scene) return refuse(scene.error(), kUsageError);
  Expected<PoseChannels> poses = pose_channels(
      arguments.poses, *scene,
      {arguments.file.states_channel, arguments.file.wrenches_channel, arguments.file.status_channel});
  if (!poses) return refuse(poses.error(), kUsageError);
  arguments.file.poses = *std::move(poses);

  if (!arguments.bodies.empty()) {
    Expected<std::vector<std::size_t>> bodies = body_list(arguments.bodies, *scene);
    if (!bodies) return refuse(bodies.error(), kUsageError);
    arguments.file.bodies = *std::move(bodies);
  }

  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a reader of OUTPUT that goes away is a failed write, with its message
  ProgressBar progress("rows");
  arguments.file.progress = [&](std::int64_t done, std::int64_t total, std::int64_t rows) {
    progress.update(done, total, rows);
    return !signals.pending();
  };
  const Expected<RecordedRun> run = read_run(arguments.run, *scene, kMaxRows, arguments.file);
  progress.clear();
  if (!run) return refuse(run.error(), kUsageError);
  for (const std::string& warning : run->warnings) print_error(app, arguments.run.string() + ": " + warning);
  if (run->suppressed_warnings > 0)
    print_error(app, std::to_string(run->suppressed_warnings) + " more of that");
  const char* const stopped_by = signals.consume();
  if (stopped_by != nullptr) {
    print_error(app, std::string("ended by ") + stopped_by + "; the page shows what was read until then");
  }

  const std::string page = report_page(report_data(*scene, *run,
                                                   {.file = arguments.run.filename().string(),
                                                    .version = BUOYANCY_VERSION,
                                                    .selected = !arguments.file.bodies.empty()}),
                                       *three);
  if (const Expected<void> written = write_page(arguments.output, page); !written) {
    return refuse(written.error(), kFailure);
  }
  if (!print_output(app, summary_of(*run, arguments, page.size()))) return kFailure;
  return run->warnings.empty() && stopped_by == nullptr ? kSuccess : kFailure;
}
