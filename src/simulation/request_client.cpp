#include "simulation/request_client.h"

#include <cassert>
#include <chrono>

namespace buoyancy {

Expected<const Answer*> EmbeddedAsker::ask(const Question& question) {
  const Clock::time_point asked_at = Clock::now();
  encode(question, bytes_);
  [[maybe_unused]] const auto rejection = decode(exchange_.answer(bytes_), answer_);
  assert(!rejection);  // what we encode, the exchange answers
  ++statistics_.questions;
  statistics_.round_trip.add(std::chrono::duration<double>(Clock::now() - asked_at).count());
  return &answer_;
}

Expected<const Answer*> ask(Asker& asker, const Question& question) {
  return std::visit([&](auto& a) { return a.ask(question); }, asker);
}

AskerStatistics statistics(const Asker& asker) {
  return std::visit([](const auto& a) -> AskerStatistics { return a.statistics(); }, asker);
}

}  // namespace buoyancy
