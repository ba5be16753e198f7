#include "view/report/run_file.h"

#include <algorithm>

#include "base/format.h"
#include "view/report/run_csv_reader.h"
#include "view/report/run_log_reader.h"

namespace buoyancy::view {

Expected<RecordedRun> read_run(const std::filesystem::path& path, const Scene& scene, std::size_t max_rows,
                               const RunFileOptions& options) {
  const std::string extension = path.extension().string();
  if (extension != ".csv" && extension != ".lcmlog") {
    return make_error({path.string(), "extension '" + extension + "'", ".csv or .lcmlog", "", ""});
  }
  if (extension == ".csv" && !options.poses.channels.empty()) {
    return make_error({"--pose", path.string(), "an .lcmlog file as RUN", "CSV has no channels", ""});
  }
  RunBuilder builder(scene, max_rows, options.bodies);
  const Expected<void> read =
      extension == ".csv" ? read_run_csv(path, options, builder) : read_run_log(path, options, builder);
  if (!read) return tl::unexpected(read.error());
  RecordedRun run = builder.finish();
  const auto is_recorded = [](const BodyRun& body) { return body.recorded > 0; };
  if (std::ranges::any_of(run.bodies, [&](const BodyRun& body) { return body.shown && is_recorded(body); }))
    return run;
  if (const auto other = std::ranges::find_if(run.bodies, is_recorded); other != run.bodies.end()) {
    const Body& body = scene.bodies()[static_cast<std::size_t>(other - run.bodies.begin())];
    return make_error({path.string(), "no rows about a body of --bodies", "rows about at least one of them",
                       "",
                       "The run has rows about " +
                           pluralize(std::ranges::count_if(run.bodies, is_recorded), "body", "bodies") +
                           " of the scene, the first with id " + std::to_string(body.id)});
  }
  return make_error(
      {path.string(), std::to_string(run.unknown_bodies) + " rows, none about a body of " + scene.name(),
       "states of the scene's bodies", "the scene belongs to another run, or the log uses other channels",
       "See --states-channel, --pose for poses of bot_core, and buoyancyd --check for the scene's ids"});
}

}  // namespace buoyancy::view
