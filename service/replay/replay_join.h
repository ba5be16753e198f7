// Joins the parts of a replay (replay_part.h) to the output that a replay of the whole would have written.
//
// Proof that it is the same: part 1 begins at 0, and each other part where the one before ended, which the
// join checks. By induction each part therefore reads the same items as a replay of the whole does in its
// blocks (event_log.h, state_csv.h), and evaluates the same batches (replay_part.h). Part n then differs from
// its stretch of the whole in two counts only, to which the join adds the totals of the parts 1 to n - 1: the
// number of each event, and the seq of messages in sessions that the replay numbers itself.
//
// The join refuses parts that do not belong together: missing or damaged ones, copies under another number,
// parts with unequal facts, and parts computed from other bytes than INPUT now holds in their range.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "recording/file_window.h"
#include "service/replay/replay.h"

namespace buoyancy::service {

struct JoinResult {
  ReplaySummary summary;                     // the sum over the parts, of the seconds too
  std::vector<std::string> input_errors;     // of the parts' manifests, in the recording's order
  std::vector<std::string> unseen_channels;  // without events in any part
};

using JoinProgress = std::function<void(std::int64_t done, std::int64_t total)>;  // [bytes]

// Joins the `count` parts of `output` that lie beside it. The output appears under its name when it is
// complete; the parts stay. Cost: reads the input and the parts once each. Errors: see above; a file is not
// readable or writable.
Expected<JoinResult> join_parts(int count, FileWindow input, const std::filesystem::path& output,
                                const JoinProgress& on_progress);

}  // namespace buoyancy::service
