#include "service/daemon/counter_warnings.h"

#include <array>
#include <string_view>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "base/format.h"
#include "service/daemon/budgets.h"

namespace buoyancy::service {

namespace {

// What to do about bodies of this status; empty where the name says it.
const char* remedy_for(BodyStatus status) {
  if (status == BodyStatus::kNoSea) {
    return "no sea has been received that holds at the time of the requests: start what publishes it before "
           "the clients";
  }
  if (status == BodyStatus::kBadCondition) {
    return "a received condition of a compartment or tank cannot be used: see the warning about its message";
  }
  if (status == BodyStatus::kNotCertified) {
    return "the bound on the force's error is above the weight of the water that the body displaces. Likely "
           "cause: a trough uncovers the sea bed there, or waves far shorter than the body. Use lower waves, "
           "deeper water or a lower cutoff";
  }
  if (status == BodyStatus::kNonFiniteTwist) {
    return "a velocity is NaN or infinite where it is needed: with a lead_time, and for bodies with drag or "
           "added mass";
  }
  return "";
}

}  // namespace

std::vector<LogEvent> warnings_since(const ServiceCounters& before, const ServiceCounters& now,
                                     const BodyFailures& newest) {
  struct Cause {
    DecodeError error;
    std::int64_t ServiceCounters::*counter;
  };
  constexpr std::array kCauses{Cause{DecodeError::kTruncated, &ServiceCounters::rejected_truncated},
                               Cause{DecodeError::kFingerprint, &ServiceCounters::rejected_fingerprint},
                               Cause{DecodeError::kCount, &ServiceCounters::rejected_count},
                               Cause{DecodeError::kLength, &ServiceCounters::rejected_length}};
  std::vector<LogEvent> warnings;
  for (const Cause& cause : kCauses) {
    const std::int64_t increase = now.*cause.counter - before.*cause.counter;
    if (increase > 0) {
      warnings.push_back({fmt::format("messages rejected, {}", to_string(cause.error)), increase, {}});
    }
  }
  for (std::size_t i = 0; i < now.bodies.size(); ++i) {
    const auto status = static_cast<BodyStatus>(i);
    const std::int64_t increase = now.bodies[i] - before.bodies[i];
    if (status != BodyStatus::kOk && increase > 0) {
      std::string detail =
          newest[i] ? fmt::format("body {} in session {}", newest[i]->body_id, newest[i]->session_id) : "";
      const std::string_view remedy = remedy_for(status);
      if (!detail.empty() && !remedy.empty()) detail += "; ";
      detail += remedy;
      warnings.push_back(
          {fmt::format("bodies with status {}", to_string(status)), increase, std::move(detail)});
    }
  }
  struct Growth {
    std::int64_t ServiceCounters::*counter;
    std::string message;
    std::string remedy;
  };
  const std::array growths{
      Growth{&ServiceCounters::seas_rejected, "seas rejected",
             "likely cause: their sender is of another version, or does not agree with the scene about up, "
             "gravity or the current"},
      Growth{&ServiceCounters::bodies_work_capped,
             "bodies in waves with an error bound above their tolerance",
             "likely cause: a tolerance below what bodies this large allow in waves this short; the bound in "
             "the response holds. Raise the tolerance, or lower the waves' cutoff"},
      Growth{&ServiceCounters::bodies_sea_too_steep, "bodies in a sea too steep for linear theory",
             "likely cause: high waves with too many short ones on top. Lower the height or the cutoff, or "
             "lengthen the period; buoyancyd --check reports the steepness"},
      Growth{&ServiceCounters::bodies_below_bed, "bodies that reach below the sea bed",
             "the bed does not hold them, and the waves below it are those at the bed. Likely cause: a body "
             "that sinks, or a depth or level that is not in metres"},
      Growth{&ServiceCounters::rejected_bodies,
             fmt::format("requests rejected, more than {} bodies more than the scene has", kMaxExtraBodies),
             "a request repeats bodies, or names unknown ones: distribute them over several requests"},
      Growth{
          &ServiceCounters::rejected_points,
          fmt::format("requests rejected, more points than a response of {} bytes holds", kMaxMessageBytes),
          "distribute the points over several requests"},
      Growth{&ServiceCounters::water_points_failed, "points at which the water is not known",
             "a coordinate is NaN or infinite, or no sea has been received that holds at the time of the "
             "request, or a point is beyond the edge of the sea's grid: see the status of the responses"},
      Growth{&ServiceCounters::rejected_work,
             fmt::format("requests rejected, computed for more than {} s", kMaxComputing.count()),
             "distribute the bodies over several requests, or raise their tolerance"},
      Growth{
          &ServiceCounters::rejected_busy,
          fmt::format("requests rejected, {} others take more than {} ms and {} or {} MB of them wait",
                      RequestHandler::kMaxInProgress, kSlice.count(), kMaxWaiting, kMaxWaitingBytes >> 20U),
          "too many clients send requests this large: their retries are answered when there is time"},
      Growth{&ServiceCounters::rejected_memory, "messages rejected, out of memory",
             "give the service more memory (MemoryMax of the unit, ulimit -v), or a smaller scene"},
      Growth{&ServiceCounters::outputs_too_large,
             fmt::format("hydrostatics or loads of more than {} bytes not sent", kMaxMessageBytes),
             "the response was sent; distribute the bodies over several requests"},
      Growth{&ServiceCounters::replies_evicted,
             fmt::format("stored replies discarded to stay within {} MB", kMaxRetainedBytes >> 20U),
             "a retry of such a request is computed again; too many sessions send requests this large"}};
  for (const Growth& growth : growths) {
    const std::int64_t increase = now.*growth.counter - before.*growth.counter;
    if (increase > 0) warnings.push_back({growth.message, increase, growth.remedy});
  }
  return warnings;
}

std::vector<LogEvent> warnings_since(const DropCounts& before, const DropCounts& now,
                                     const BufferLimit& receive_buffer_limit) {
  std::vector<LogEvent> warnings;
  if (now.packets > before.packets) {
    warnings.push_back({"packets dropped by the kernel (receive buffer full)", now.packets - before.packets,
                        fmt::format("{}, or use a port with less traffic", receive_buffer_limit.remedy)});
  }
  if (now.oversized_messages > before.oversized_messages) {
    warnings.push_back({fmt::format("messages of more than {} bytes dropped", kMaxMessageBytes),
                        now.oversized_messages - before.oversized_messages,
                        "let their sender distribute the bodies over several requests"});
  }
  if (now.partial_messages_evicted > before.partial_messages_evicted) {
    warnings.push_back(
        {fmt::format("incomplete messages discarded, more than {} or {} MB of them at a time",
                     LcmReassembler::kMaxPartialMessages, LcmReassembler::kMaxPartialBytes >> 20U),
         now.partial_messages_evicted - before.partial_messages_evicted,
         "a program sends fragments of messages that it does not complete"});
  }
  if (now.fragments > before.fragments) {
    warnings.push_back(
        {"fragments of incomplete or contradictory messages dropped", now.fragments - before.fragments, {}});
  }
  return warnings;
}

LogEvent to_log_event(const MotionFinding& finding) {
  const char* const message = finding.contradictions == 0 ? "sessions whose quaternions look like x, y, z, w"
                              : finding.is_angular        ? "angular velocities that contradict the motion"
                                                          : "linear velocities that contradict the motion";
  return {message, 1, finding.warning().message()};
}

std::optional<LogEvent> missing_velocities(const PoseChannel& pose, const Scene& scene, std::int64_t count) {
  const Body* const body = scene.find(pose.body_id);
  if (body == nullptr || body->hydrodynamics == nullptr) return std::nullopt;
  return LogEvent{fmt::format("poses without velocities on {}, whose body '{}' has drag or added mass",
                              pose.channel, body->name),
                  count, kMissingVelocitiesRemedy};
}

std::string describe_totals(const ServiceCounters& counters, const LatencyPercentiles& latency) {
  std::int64_t bodies = 0;
  for (const std::int64_t count : counters.bodies) bodies += count;
  const std::int64_t ok = counters.bodies[static_cast<std::size_t>(BodyStatus::kOk)];
  constexpr double kMicrosecondsPerSecond = 1e6;
  return fmt::format(
      "{} requests: {} computed, {} retries, {} stale, {} superseded, {} rejected; {} bodies, {} of them "
      "OK; latency p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us",
      counters.requests, counters.computed, counters.retries, counters.stale, counters.superseded,
      counters.rejected(), bodies, ok, latency.p50 * kMicrosecondsPerSecond,
      latency.p99 * kMicrosecondsPerSecond, latency.max * kMicrosecondsPerSecond);
}

std::string describe_faults(const FaultCounters& faults) {
  return fmt::format("{}, {} delayed, {} duplicated, {} reordered, {} corrupted; {}",
                     pluralize(faults.dropped, "response dropped", "responses dropped"), faults.delayed,
                     faults.duplicated, faults.reordered, faults.corrupted,
                     pluralize(faults.stalls, "stall", "stalls"));
}

}  // namespace buoyancy::service
