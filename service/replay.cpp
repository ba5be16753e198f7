#include "service/replay.h"

#include <chrono>
#include <variant>

#include "exchange/exchange.h"

namespace buoyancy {

Expected<ReplaySummary> replay(const Scene& scene, ReplayInput& input, ReplayOutput& output,
                               TerminationSignals& signals, const ReplayListener& listener) {
  const auto start = std::chrono::steady_clock::now();
  Exchange exchange(scene);
  ReplaySummary summary;
  while (true) {
    if (signals.pending()) {
      summary.ended_by = signals.take();
      break;
    }
    const InputItem item = input.next();
    if (std::holds_alternative<EndOfInput>(item)) break;
    if (const auto* damage = std::get_if<Damage>(&item)) {
      ++summary.damages;
      listener.on_trouble(damage->description);
      continue;
    }
    const auto& question = std::get<RecordedQuestion>(item);
    const Bytes answer = exchange.answer(question.bytes);
    if (answer.empty()) {
      const auto key = peek_key(question.bytes);
      listener.on_trouble("event at " + std::to_string(question.timestamp) +
                          " us is no question: " + (key ? "rejected" : describe(key.error())));
    } else if (Expected<void> written = output.write(question.timestamp, answer, exchange.hydrostatics());
               !written) {
      return tl::unexpected(written.error());
    }
    listener.on_progress(input.offset(), input.size(), exchange.counters().questions);
  }
  if (Expected<void> flushed = output.flush(); !flushed) return tl::unexpected(flushed.error());
  summary.counters = exchange.counters();
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

}  // namespace buoyancy
