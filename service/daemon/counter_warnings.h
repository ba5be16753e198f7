// Turns the growth of counters into warnings for the log.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/motion_check.h"
#include "engine/pose_request_adapter.h"
#include "engine/request_handler.h"
#include "messages/status.h"
#include "scene/scene.h"
#include "service/daemon/rate_limited_log.h"
#include "transport/udpm_receiver.h"

namespace buoyancy::service {

// Returns one event per cause of rejection, per body status other than OK, and per other warning whose
// counter has grown. newest: see RequestHandler::newest_failures(); each is named with its status.
std::vector<LogEvent> warnings_since(const ServiceCounters& before, const ServiceCounters& now,
                                     const BodyFailures& newest);

// Returns one event per kind of loss whose counter has grown.
std::vector<LogEvent> warnings_since(const DropCounts& before, const DropCounts& now,
                                     const BufferLimit& receive_buffer_limit);

// Returns one of three messages, with the finding as its detail.
LogEvent to_log_event(const MotionFinding& finding);

// Returns the event of `count` poses without velocities on a channel; nullopt: the body needs none.
std::optional<LogEvent> missing_velocities(const PoseChannel& pose, const Scene& scene, std::int64_t count);

// One line of totals: "1200 requests: 1198 computed, 2 retries, ...".
std::string describe_totals(const ServiceCounters& counters, const LatencyPercentiles& latency);

// One line of the faults that were injected: "12 responses dropped, 80 delayed, ...".
std::string describe_faults(const FaultCounters& faults);

}  // namespace buoyancy::service
