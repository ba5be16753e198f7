#include "view/run_file.h"

#include "view/run_csv_file.h"
#include "view/run_log_file.h"

namespace buoyancy {

Expected<RecordedRun> read_run(const std::filesystem::path& path, const Scene& scene, std::size_t most_rows,
                               const RunFileOptions& options) {
  const std::string extension = path.extension().string();
  if (extension != ".csv" && extension != ".lcmlog") {
    return failure({path.string(), "extension '" + extension + "'", ".csv or .lcmlog", "", ""});
  }
  if (extension == ".csv" && !options.poses.channels.empty()) {
    return failure({"--pose", path.string(), "an .lcmlog as RUN", "CSV has no channels", ""});
  }
  RunCollector collector(scene, most_rows);
  const Expected<void> read =
      extension == ".csv" ? read_run_csv(path, options, collector) : read_run_log(path, options, collector);
  if (!read) return tl::unexpected(read.error());
  RecordedRun run = collector.take();
  for (const BodyRun& body : run.bodies) {
    if (body.recorded > 0) return run;
  }
  return failure(
      {path.string(), std::to_string(run.unknown_bodies) + " rows, none about a body of " + scene.name(),
       "states of the scene's bodies", "the scene is of another run, or the log's channels have other names",
       "See --states-channel, --pose for poses of bot_core, and buoyancyd --check for the scene's ids"});
}

}  // namespace buoyancy
