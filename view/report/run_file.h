// A recorded run, read from what is left of it: the CSV of buoyancy-client, poses alone as buoyancy-replay
// takes them, or a log of lcm-logger.
//
// CSV: the columns are found by their names in the first line. utime, body_id, px..pz, qw..qz there must be;
// of vx..wz; status, fx..tz, volume, bx..bz; energy each group is read where all of it is there. What lacks
// is computed.
//
// Log: requests and answers are matched by session and seq, poses and their responses by body and utime; a
// repeated request is one, and a response that never came is computed. Of a response that is force and torque
// alone the rest is computed. At most 4,096 requests wait for their responses. What is damaged is passed over
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

namespace buoyancy {

struct RunFileOptions {
  std::string states_channel{kStatesChannel};
  std::string wrenches_channel{kWrenchesChannel};
  std::string status_channel{kStatusChannel};
  PoseChannels poses;               // of a log
  std::vector<std::size_t> bodies;  // to show (RunBuilder); empty: the first that the run names
  // Called now and then: bytes read, bytes in all, rows. False: stop reading, what was read is the run.
  std::function<bool(std::int64_t, std::int64_t, std::int64_t)> progress;
};

// By the extension: .csv or .lcmlog. Memory does not grow with the file. Errors: another extension, not
// readable, a first line that is no such header, a .csv where options name pose channels, not one row about a
// body of the scene, or about those that options name.
Expected<RecordedRun> read_run(const std::filesystem::path& path, const Scene& scene, std::size_t max_rows,
                               const RunFileOptions& options);

}  // namespace buoyancy
