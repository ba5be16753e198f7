// The run of buoyancy-ping: sends requests one after the other, compares every reply, and measures round
// trips.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/termination_signals.h"
#include "client/ping/response_checks.h"
#include "client/ping/service_link.h"
#include "client/retry_policy.h"
#include "scene/scene.h"

namespace buoyancy::ping {

struct PingTask {
  const Scene& scene;
  LinkOptions link;
  RetryPolicy retry_policy;
  std::int64_t count = 100;  // of requests, >= 1
  double rate = 0.0;         // [Hz]; 0: each request is sent when the reply before has arrived
  std::uint64_t seed = 1;    // of the poses
  bool identical = false;    // is a reply that differs in a bit a failure?
  ByteVector sea;            // a sea_state_t to publish, for a scene that receives its sea; else empty
};

// A failure other than a difference of values.
struct RunFailure {
  std::string check;  // one of kRunChecks
  std::string message;
};
inline constexpr const char* kConnectionCheck = "connection";
inline constexpr const char* kResponsesCheck = "a response to every request";
inline constexpr const char* kDecodableCheck = "messages that can be decoded";
inline constexpr const char* kSingleResponseCheck = "one response to a request";
inline constexpr const char* kIdsCheck = "ids and bodies as requested";
inline constexpr const char* kOutputsCheck = "all outputs of the scene";
inline constexpr const char* kIdenticalCheck = "identical replies";
inline constexpr std::array kRunChecks{kConnectionCheck,     kResponsesCheck, kDecodableCheck,
                                       kSingleResponseCheck, kIdsCheck,       kOutputsCheck,
                                       kIdenticalCheck};

struct RoundTrips {  // [s], from the first sending of a request to the arrival of its response
  double min = 0.0, median = 0.0, p90 = 0.0, p99 = 0.0, max = 0.0;
};
// Percentile p: the shortest one that at least the fraction p does not exceed. Zeros if there are none.
RoundTrips summarize_round_trips(std::vector<double> round_trips);

struct PingResult {
  explicit PingResult(const Scene& scene) : checks(scene) {}

  ResponseChecks checks;
  std::string url;
  LinkStats link;
  ServiceInfo service;
  std::int64_t requests = 0;  // sent, without retries
  std::int64_t retries = 0;
  std::int64_t unanswered = 0;       // without a complete reply after all retries
  std::vector<double> round_trips;   // [s], of the replies with wrenches
  double seconds = 0.0;              // of the whole run
  std::string stopped_by;            // "SIGINT"; empty: not stopped
  std::vector<RunFailure> failures;  // beside those of the checks
  std::vector<std::string> likely_causes;
  std::vector<Warning> warnings;

  // Did every request get a complete reply that agrees?
  bool agrees() const { return failures.empty() && checks.replies() > 0 && checks.all_passed(); }
};

PingResult run_ping(const PingTask& task, const TerminationSignals& signals);

}  // namespace buoyancy::ping
