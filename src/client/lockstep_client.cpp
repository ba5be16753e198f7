#include "client/lockstep_client.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

namespace buoyancy {
namespace {

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

Clock::duration to_duration(double time) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time));
}

std::string subject(const LcmRequestChannel& channel, std::int64_t seq) {
  return "request " + std::to_string(seq) + " on " + channel.describe_endpoint();
}

tl::unexpected<Error> no_response(const LcmRequestChannel& channel, std::int64_t seq, double waited) {
  std::array<char, 64> found{};
  std::snprintf(found.data(), found.size(), "no response for %.3g s", waited);
  return make_error({subject(channel, seq), found.data(), "a response of buoyancyd",
                     "no buoyancyd is running on this LCM URL and these channels, or it rejects the requests",
                     "Start buoyancyd with the same scene, URL and channels, or use --embedded"});
}

tl::unexpected<Error> stopped_error(const LcmRequestChannel& channel, std::int64_t seq) {
  return make_error({subject(channel, seq), "stopped while waiting", "a response of buoyancyd", "", ""});
}

Expected<const WrenchResponse*> checked(const LcmRequestChannel& channel, const WrenchRequest& request,
                                        const WrenchResponse& response) {
  const bool same_bodies =
      std::equal(request.bodies.begin(), request.bodies.end(), response.bodies.begin(), response.bodies.end(),
                 [](const BodyState& asked, const BodyWrench& got) { return asked.body_id == got.body_id; });
  if (!same_bodies) {
    return make_error({subject(channel, request.key.seq), "a response about other bodies than asked",
                       "one wrench per body, in the asked order",
                       "a program that is no buoyancyd publishes on the wrenches channel", ""});
  }
  return &response;
}

// Sends until answered or out of retry_policy. A sending that the network refuses is a lost request as well:
// interfaces go and come back.
Expected<const WrenchResponse*> ask_in_lockstep(LcmRequestChannel& channel, const WrenchRequest& request,
                                                const RetryPolicy& retry_policy, ClientStats& statistics) {
  const Clock::time_point sent_at = Clock::now();
  ++statistics.requests;
  Expected<void> sent = channel.send(request);
  for (std::int64_t repeats = 0;; ++repeats) {
    if (channel.wait_for(request.key.seq, Clock::now() + to_duration(retry_policy.timeout))) {
      statistics.round_trip.add(seconds(channel.arrivals().back().at - sent_at));
      return checked(channel, request, channel.latest_response());
    }
    if (channel.cancelled()) return stopped_error(channel, request.key.seq);
    if (repeats == retry_policy.max_retries) {
      ++statistics.unanswered;
      if (!sent) return make_error(sent.error());
      return no_response(channel, request.key.seq, seconds(Clock::now() - sent_at));
    }
    ++statistics.retries;
    sent = channel.resend();
  }
}

}  // namespace

LockstepClient::LockstepClient(LcmRequestChannel channel, RetryPolicy retry_policy)
    : channel_(std::move(channel)), retry_policy_(retry_policy) {}

Expected<const WrenchResponse*> LockstepClient::request(const WrenchRequest& request) {
  return ask_in_lockstep(channel_, request, retry_policy_, statistics_);
}

FreeRunningClient::FreeRunningClient(LcmRequestChannel channel, RetryPolicy retry_policy, double interval)
    : channel_(std::move(channel)), retry_policy_(retry_policy), interval_(to_duration(interval)) {}

Expected<const WrenchResponse*> FreeRunningClient::request(const WrenchRequest& request) {
  if (!channel_.has_response()) {
    Expected<const WrenchResponse*> first = ask_in_lockstep(channel_, request, retry_policy_, statistics_);
    next_turn_ = Clock::now() + interval_;
    return first;
  }

  const std::int64_t seq = request.key.seq;
  wait_for(std::numeric_limits<std::int64_t>::max(), next_turn_);
  if (channel_.cancelled()) return stopped_error(channel_, seq);
  const Clock::time_point now = Clock::now();
  ++statistics_.requests;
  unanswered_.push_back({seq, now});
  if (!std::exchange(quiet_, true)) quiet_since_ = now;
  if (const Expected<void> sent = channel_.send(request); !sent) return make_error(sent.error());

  next_turn_ += interval_;
  if (!wait_for(seq, next_turn_)) {
    const double waited = seconds(Clock::now() - quiet_since_);
    if (quiet_ && waited > retry_policy_.total_timeout()) return no_response(channel_, seq, waited);
    ++statistics_.late;
    statistics_.max_lag = std::max(statistics_.max_lag, seq - channel_.latest_response().key.seq);
  }
  return checked(channel_, request, channel_.latest_response());
}

bool FreeRunningClient::wait_for(std::int64_t seq, Clock::time_point deadline) {
  const bool answered = channel_.wait_for(seq, deadline);
  for (const ResponseArrival& arrival : channel_.arrivals()) {
    quiet_ = false;
    const auto sent = std::lower_bound(unanswered_.begin(), unanswered_.end(), arrival.seq,
                                       [](const Sent& s, std::int64_t value) { return s.seq < value; });
    if (sent == unanswered_.end() || sent->seq != arrival.seq) continue;  // a duplicate
    statistics_.round_trip.add(seconds(arrival.at - sent->at));
    unanswered_.erase(sent);
  }
  const Clock::time_point forgotten = Clock::now() - to_duration(retry_policy_.total_timeout());
  while (!unanswered_.empty() && unanswered_.front().at < forgotten) {
    ++statistics_.unanswered;
    unanswered_.pop_front();
  }
  return answered;
}

ClientStats FreeRunningClient::statistics() const {
  ClientStats statistics = statistics_;
  statistics.unanswered += static_cast<std::int64_t>(unanswered_.size());
  return statistics;
}

}  // namespace buoyancy
