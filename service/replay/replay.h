// The replay: every recorded question through the same Exchange as in the live service, offline, as fast as
// it goes, on as many threads as there are. The same input gives the same output, byte for byte, whatever
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
  Counters counters;
  std::int64_t copied = 0;    // events
  std::int64_t damages = 0;   // places of the input that could not be read
  const char* ended_by = "";  // a signal's name; empty: the end of the input
  double seconds = 0.0;

  // Has every question of the input its answer in the output?
  bool complete() const { return damages == 0 && counters.rejected() == 0 && *ended_by == '\0'; }
};

struct ReplayListener {
  std::function<void(const std::string&)> on_trouble;  // what was damaged or rejected, one by one
  std::function<void(std::int64_t offset, std::int64_t size, std::int64_t questions)> on_progress;
};

// What a replay works with; all outlive it.
struct ReplayTask {
  const Scene& scene;
  ReplayInput& input;
  ReplayChannels& channels;
  PoseQuestions& poses;
  ReplayOutput& output;
  OutputLayout layout;
  Comparison* comparison = nullptr;  // nullptr: none
  unsigned jobs = 0;                 // threads: 1 or more; 0: as many as the processor runs at once
};

// Ends at the end of the input or, between two questions, after a signal. Memory: jobs times a bounded number
// of questions. Errors: the output cannot be written; it is a pipe that nobody reads, after a signal.
Expected<ReplaySummary> replay(const ReplayTask& task, TerminationSignals& signals,
                               const ReplayListener& listener);

}  // namespace buoyancy
