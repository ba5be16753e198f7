#include "client/free_running_client.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "client/request_with_retries.h"

namespace buoyancy {

FreeRunningClient::FreeRunningClient(LcmRequestChannel channel, RetryPolicy retry_policy, double interval)
    : channel_(std::move(channel)), retry_policy_(retry_policy), interval_(to_duration(interval)) {}

Expected<const WrenchResponse*> FreeRunningClient::request(const BorrowedRequest& request) {
  if (!channel_.has_response()) {
    Expected<const WrenchResponse*> first =
        request_with_retries(channel_, request, retry_policy_, statistics_);
    next_send_ = Clock::now() + interval_;
    return first;
  }

  const std::int64_t seq = request.id.seq;
  wait_for(std::numeric_limits<std::int64_t>::max(), next_send_);
  if (channel_.cancelled()) return cancelled_error(channel_, seq);
  const Clock::time_point now = Clock::now();
  ++statistics_.requests;
  unanswered_.push_back({seq, now});
  if (!std::exchange(waiting_, true)) waiting_since_ = now;
  if (const Expected<void> sent = channel_.send(request); !sent) return make_error(sent.error());

  next_send_ += interval_;
  if (!wait_for(seq, next_send_)) {
    const double waited = to_seconds(Clock::now() - waiting_since_);
    if (waiting_ && waited > retry_policy_.total_timeout()) return no_response_error(channel_, seq, waited);
    ++statistics_.late;
    statistics_.max_lag = std::max(statistics_.max_lag, seq - channel_.latest_response().id.seq);
  }
  return check_response(channel_, request, channel_.latest_response());
}

bool FreeRunningClient::wait_for(std::int64_t seq, Clock::time_point deadline) {
  const bool arrived = channel_.wait_for(seq, deadline);
  record_arrivals();
  return arrived;
}

Expected<const WaterSamples*> FreeRunningClient::sample_water(const BorrowedWaterPoints& request) {
  Expected<const WaterSamples*> samples =
      sample_water_with_retries(channel_, request, retry_policy_, statistics_);
  record_arrivals();
  return samples;
}

// Recording an arrival twice changes nothing.
void FreeRunningClient::record_arrivals() {
  for (const ResponseArrival& arrival : channel_.arrivals()) {
    waiting_ = false;
    const auto sent = std::lower_bound(unanswered_.begin(), unanswered_.end(), arrival.seq,
                                       [](const Sent& s, std::int64_t value) { return s.seq < value; });
    if (sent == unanswered_.end() || sent->seq != arrival.seq) continue;  // a duplicate
    statistics_.round_trip.add(to_seconds(arrival.at - sent->at));
    unanswered_.erase(sent);
  }
  const Clock::time_point expired = Clock::now() - to_duration(retry_policy_.total_timeout());
  while (!unanswered_.empty() && unanswered_.front().at < expired) {
    ++statistics_.unanswered;
    unanswered_.pop_front();
  }
}

ClientStats FreeRunningClient::statistics() const {
  ClientStats statistics = statistics_;
  statistics.unanswered += static_cast<std::int64_t>(unanswered_.size());
  statistics.malformed = channel_.malformed();
  return statistics;
}

}  // namespace buoyancy
