// buoyancy-ping: the program around run_ping().
#include <csignal>

#include <CLI/App.hpp>

#include "cli/command_line.h"
#include "cli/termination_signals.h"
#include "client/ping/ping.h"
#include "client/ping/ping_options.h"
#include "client/ping/ping_report.h"
#include "scene/mesh_warnings.h"

namespace buoyancy::ping {
namespace {

int run(int argc, char** argv) {
  CLI::App app("", "buoyancy-ping");
  PingOptions options;
  add_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const auto fail = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  if (const Expected<void> checked = check_options(options); !checked) {
    return fail(checked.error(), kUsageError);
  }
  const Expected<Scene> scene = Scene::load(options.scene);
  if (!scene) return fail(scene.error(), kUsageError);
  for (const Warning& warning : mesh_warnings(*scene)) print_warning(app, warning);
  Expected<ByteVector> sea = sea_to_publish(options, *scene);
  if (!sea) return fail(sea.error(), kUsageError);

  const PingTask task{.scene = *scene,
                      .link = options.link,
                      .retry_policy = options.retry_policy,
                      .count = options.count,
                      .rate = options.rate,
                      .seed = options.seed,
                      .identical = options.identical,
                      .sea = std::move(*sea)};
  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe becomes a write error with a message
  PingResult result = run_ping(task, signals);
  if (const char* const signal = signals.consume()) result.stopped_by = signal;
  signals.unblock();  // writing the table may block on its reader

  for (const Warning& warning : result.warnings) print_warning(app, warning);
  for (const std::string& line : failure_lines(result)) print_error(app, line);
  const bool printed = print_output(app, options.json ? to_json(task, result) : to_text(task, result));
  if (!options.junit.empty()) {
    if (const Expected<void> written = write_file(options.junit, to_junit(task, result)); !written) {
      return fail(written.error(), kFailure);
    }
  }
  return printed && result.agrees() ? kSuccess : kFailure;
}

}  // namespace
}  // namespace buoyancy::ping

int main(int argc, char** argv) {
  return buoyancy::ping::run(argc, argv);
}
