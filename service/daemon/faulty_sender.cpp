#include "service/daemon/faulty_sender.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace buoyancy::service {

FaultySender::FaultySender(const FaultOptions& options, double start, Send send)
    : options_(options), start_(start), send_(std::move(send)) {}

void FaultySender::push(Reply reply, double now) {
  const std::uint64_t ordinal = next_ordinal_++;
  const Fate fate = draw_fate(options_, ordinal);
  if (fate.dropped) {
    ++counters_.dropped;
    return;
  }
  if (fate.delay > 0.0) ++counters_.delayed;
  if (fate.duplicated) ++counters_.duplicated;
  if (fate.reordered) ++counters_.reordered;
  if (fate.corruption != Corruption::kNone) ++counters_.corrupted;

  Waiting waiting{std::move(reply), ordinal, 0, fate.duplicated, fate.reordered};
  for (Reply::Message& message : waiting.reply.messages) {
    corrupt(fate, message.bytes);
    waiting.bytes += message.bytes.size();
  }
  waiting_bytes_ += waiting.bytes;
  held_ += waiting.held ? 1 : 0;
  waiting_.emplace(now + fate.delay + (waiting.held ? kMaxHold : 0.0), std::move(waiting));
  send_due(now);
  while (waiting_.size() > kMaxWaiting || waiting_bytes_ > kMaxWaitingBytes) send(waiting_.begin());
}

void FaultySender::send_due(double now) {
  if (is_stalled(now)) return;
  while (!waiting_.empty() && waiting_.begin()->first <= now) send(waiting_.begin());
}

void FaultySender::send_all() {
  while (!waiting_.empty()) send(waiting_.begin());
}

double FaultySender::wait(double now) const {
  if (is_stalled(now)) return end_of_period(options_, now - start_) - (now - start_);
  if (waiting_.empty()) return std::numeric_limits<double>::infinity();
  return std::max(waiting_.begin()->first - now, 0.0);
}

FaultCounters FaultySender::counters(double now) const {
  FaultCounters counters = counters_;
  counters.stalls = stalls_begun(options_, now - start_);
  return counters;
}

void FaultySender::send(Queue::iterator position) {
  const bool releases = !position->second.held && held_ > 0;
  const std::uint64_t ordinal = position->second.ordinal;
  send_one(position);
  if (!releases) return;
  for (auto next = waiting_.begin(); next != waiting_.end();) {
    const auto current = next++;
    if (current->second.held && current->second.ordinal < ordinal) send_one(current);
  }
}

void FaultySender::send_one(Queue::iterator position) {
  const Waiting waiting = std::move(position->second);
  waiting_.erase(position);
  waiting_bytes_ -= waiting.bytes;
  held_ -= waiting.held ? 1 : 0;
  send_(waiting.reply);
  if (waiting.duplicated) send_(waiting.reply);
}

}  // namespace buoyancy::service
