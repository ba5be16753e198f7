// The replay: handles every recorded request with the same RequestHandler as the live service, offline, at
// full speed, on several threads. The same input gives the same output, byte for byte, on any number of
// threads.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/termination_signals.h"
#include "engine/condition_timeline.h"
#include "engine/pose_request_adapter.h"
#include "messages/status.h"
#include "recording/sequence_gaps.h"
#include "scene/scene.h"
#include "service/replay/replay_channels.h"
#include "service/replay/replay_comparison.h"
#include "service/replay/replay_input.h"
#include "service/replay/replay_output.h"

namespace buoyancy::service {

struct ReplaySummary {
  ServiceCounters counters;
  std::int64_t copied = 0;            // events
  std::int64_t corrupt_sections = 0;  // of the input
  // Recorded requests in a session that the replay numbers itself: a part cannot have any (replay_part.h).
  std::int64_t requests_in_pose_sessions = 0;
  std::vector<std::string>
      doubts;  // contradictions between velocities and motion, as MotionMonitor finds them
  std::optional<SequenceGaps> requests;  // what the sessions of the input lack; nullopt: joined parts
  const char* stopped_by = "";           // the name of a signal; empty: the end of the input
  double seconds = 0.0;

  // Does the output hold a response to every request of the input, with every sea and every condition of the
  // input in force?
  bool complete() const {
    return corrupt_sections == 0 && counters.rejected() == 0 && counters.seas_rejected == 0 &&
           counters.conditions_rejected == 0 && *stopped_by == '\0';
  }
};

struct ReplayCallbacks {
  std::function<void(const std::string&)> on_input_error;  // per corrupt section or rejected event
  std::function<void(std::int64_t offset, std::int64_t size, std::int64_t requests)> on_progress;
};

// The arguments of replay(); all of them must outlive it.
struct ReplayTask {
  const Scene& scene;
  ReplayInput& input;
  ReplayChannels& channels;
  PoseRequestAdapter& poses;
  ReplayOutput& output;
  OutputLayout layout;
  ReplayOutput* loads = nullptr;                  // with layout.loads_csv: the file of its rows
  ReplayComparison* comparison = nullptr;         // nullptr: none
  unsigned jobs = 0;                              // threads; 0: number of hardware threads
  const ConditionTimeline* conditions = nullptr;  // received before the input; nullptr: none
};

// Stops at the end of the input or, between two requests, after a signal. Memory: jobs times a bounded number
// of requests. Errors: the input or the baseline cannot be read to its end: the output then holds the
// responses to what was read; the output cannot be written; after a signal, the output is a pipe without a
// reader.
Expected<ReplaySummary> replay(const ReplayTask& task, TerminationSignals& signals,
                               const ReplayCallbacks& callbacks);

}  // namespace buoyancy::service
