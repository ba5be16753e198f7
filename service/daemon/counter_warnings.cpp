#include "service/daemon/counter_warnings.h"

#include <array>

#include <spdlog/fmt/fmt.h>

namespace buoyancy {

std::vector<Trouble> troubles_between(const Counters& before, const Counters& now) {
  struct Cause {
    Rejection rejection;
    std::int64_t Counters::*counter;
  };
  constexpr std::array kCauses{Cause{Rejection::kTruncated, &Counters::rejected_truncated},
                               Cause{Rejection::kFingerprint, &Counters::rejected_fingerprint},
                               Cause{Rejection::kCount, &Counters::rejected_count},
                               Cause{Rejection::kLength, &Counters::rejected_length}};
  std::vector<Trouble> troubles;
  for (const Cause& cause : kCauses) {
    const std::int64_t grown = now.*cause.counter - before.*cause.counter;
    if (grown > 0) {
      troubles.push_back({fmt::format("messages rejected, {}", describe(cause.rejection)), grown, {}});
    }
  }
  for (std::size_t i = 0; i < now.bodies.size(); ++i) {
    const auto status = static_cast<BodyStatus>(i);
    const std::int64_t grown = now.bodies[i] - before.bodies[i];
    if (status != BodyStatus::kOk && grown > 0) {
      troubles.push_back({fmt::format("bodies answered with {}", name(status)), grown, {}});
    }
  }
  return troubles;
}

std::vector<Trouble> troubles_between(const ReceiveLosses& before, const ReceiveLosses& now) {
  std::vector<Trouble> troubles;
  if (now.packets > before.packets) {
    troubles.push_back({"packets dropped by the kernel before they were read", now.packets - before.packets,
                        "they came faster than they are read: sysctl -w net.core.rmem_max=4194304 and start "
                        "again, or a port that carries less else"});
  }
  if (now.fragments > before.fragments) {
    troubles.push_back(
        {"fragments of incomplete or contradictory messages dropped", now.fragments - before.fragments, {}});
  }
  return troubles;
}

std::string describe_totals(const Counters& counters, const LatencyPercentiles& latency) {
  std::int64_t bodies = 0;
  for (const std::int64_t count : counters.bodies) bodies += count;
  const std::int64_t ok = counters.bodies[static_cast<std::size_t>(BodyStatus::kOk)];
  constexpr double kMicrosecondsPerSecond = 1e6;
  return fmt::format(
      "{} questions: {} answered, {} repeated, {} stale, {} overtaken, {} rejected; {} bodies, {} of them "
      "OK; "
      "latency p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us",
      counters.questions, counters.answered, counters.repeated, counters.stale, counters.overtaken,
      counters.rejected(), bodies, ok, latency.p50 * kMicrosecondsPerSecond,
      latency.p99 * kMicrosecondsPerSecond, latency.max * kMicrosecondsPerSecond);
}

}  // namespace buoyancy
