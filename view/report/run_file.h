// Reads a recorded run: a CSV file of buoyancy-client, a CSV file of poses as for buoyancy-replay, or an LCM
// log of lcm-logger.
//
// CSV: the header line names the columns, in any order. Required: utime, body_id, px..pz, qw..qz. Optional,
// each group only if complete: vx..wz; status, fx..tz, volume, bx..bz; energy. Missing values are computed.
//
// Log: requests and responses are matched by session_id and seq, poses and their responses by body and utime.
// A repeated request counts once, and a missing response is computed, as are the missing fields of a response
// that holds only force and torque. At most 4,096 requests wait for their responses. Loads are matched with
// the latest responses in front of them; missing ones are computed. Corrupt sections are skipped
// (recording/event_log.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "engine/pose_request_adapter.h"
#include "messages/wire.h"
#include "view/report/run_builder.h"

namespace buoyancy::view {

struct RunFileOptions {
  std::string states_channel{kStatesChannel};
  std::string wrenches_channel{kWrenchesChannel};
  std::string loads_channel{kLoadsChannel};
  std::string sea_channel{kSeaChannel};              // of a log, for a scene that receives its sea
  std::string sea_grid_channel{kSeaGridChannel};     // likewise, on grids
  std::string condition_channel{kConditionChannel};  // of a log, for a scene with compartments or tanks
  std::string status_channel{kStatusChannel};
  PoseChannels poses;               // of a log
  std::vector<std::size_t> bodies;  // to show, see RunBuilder; empty: the first in the run
  // Called periodically with bytes read, bytes in total, rows. If it returns false, reading stops, and the
  // run consists of what was read.
  std::function<bool(std::int64_t, std::int64_t, std::int64_t)> progress;
};

// The extension selects the format: .csv or .lcmlog. Memory does not grow with the file. Errors: another
// extension, an unreadable file, an invalid CSV header, pose channels for a .csv file, no row about a body of
// the scene or of options.bodies.
Expected<RecordedRun> read_run(const std::filesystem::path& path, const Scene& scene, std::size_t max_rows,
                               const RunFileOptions& options);

}  // namespace buoyancy::view
