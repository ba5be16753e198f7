// The replay: every recorded question through the same Exchange as in the live service, offline, as fast as
// it goes. The same input gives the same output, byte for byte.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "geometry/error.h"
#include "messages/status.h"
#include "scene/scene.h"
#include "service/replay_input.h"
#include "service/replay_output.h"
#include "service/termination_signals.h"

namespace buoyancy {

struct ReplaySummary {
  Counters counters;
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

// Ends at the end of the input or, between two questions, after a signal. Errors: the output cannot be
// written.
Expected<ReplaySummary> replay(const Scene& scene, ReplayInput& input, ReplayOutput& output,
                               TerminationSignals& signals, const ReplayListener& listener);

}  // namespace buoyancy
