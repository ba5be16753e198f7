// The replay: every recorded request through the same RequestHandler as in the live service, offline, as fast
// as it goes, on as many threads as there are. The same input gives the same output, byte for byte, whatever
// their number.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/error.h"
#include "cli/termination_signals.h"
#include "engine/pose_request_adapter.h"
#include "messages/status.h"
#include "scene/scene.h"
#include "service/replay/replay_channels.h"
#include "service/replay/replay_comparison.h"
#include "service/replay/replay_input.h"
#include "service/replay/replay_output.h"

namespace buoyancy {

struct ReplaySummary {
  ServiceCounters counters;
  std::int64_t copied = 0;            // events
  std::int64_t corrupt_sections = 0;  // places of the input that could not be read
  const char* stopped_by = "";        // a signal's name; empty: the end of the input
  double seconds = 0.0;

  // Has every request of the input its response in the output?
  bool complete() const { return corrupt_sections == 0 && counters.rejected() == 0 && *stopped_by == '\0'; }
};

struct ReplayListener {
  std::function<void(const std::string&)> on_input_error;  // what was damaged or rejected, one by one
  std::function<void(std::int64_t offset, std::int64_t size, std::int64_t requests)> on_progress;
};

// What a replay works with; all outlive it.
struct ReplayTask {
  const Scene& scene;
  ReplayInput& input;
  ReplayChannels& channels;
  PoseRequestAdapter& poses;
  ReplayOutput& output;
  OutputLayout layout;
  ReplayComparison* comparison = nullptr;  // nullptr: none
  unsigned jobs = 0;                       // threads: 1 or more; 0: as many as the processor runs at once
};

// Ends at the end of the input or, between two requests, after a signal. Memory: jobs times a bounded number
// of requests. Errors: the output cannot be written; it is a pipe that nobody reads, after a signal.
Expected<ReplaySummary> replay(const ReplayTask& task, TerminationSignals& signals,
                               const ReplayListener& listener);

}  // namespace buoyancy
