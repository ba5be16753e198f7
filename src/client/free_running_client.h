// A client that sends one request per interval of wall-clock time and uses the newest response that has
// arrived by the end of the interval.
//
// After the first response it never waits longer than the interval, counts how late its responses are, and
// returns an error when no response has arrived for RetryPolicy::total_timeout(). Contract and errors: see
// retry_policy.h.
#pragma once

#include <cstdint>
#include <deque>
#include <span>

#include "client/client_stats.h"
#include "client/lcm_request_channel.h"
#include "client/retry_policy.h"

namespace buoyancy {

class FreeRunningClient {
 public:
  // interval: [s], > 0.
  FreeRunningClient(LcmRequestChannel channel, RetryPolicy retry_policy, double interval);

  // See LcmRequestChannel::set_conditions().
  void set_conditions(std::span<const ConditionChange> announced, std::span<const ConditionChange> repeated) {
    channel_.set_conditions(announced, repeated);
  }

  // See LcmRequestChannel::reserve().
  Expected<std::optional<Warning>> reserve(std::size_t bodies) { return channel_.reserve(bodies); }

  // Waits for the start of the next interval, sends the request, and returns the newest response once it is
  // the request's own or the interval is over. The first request waits as in lock-step mode, since there is
  // no earlier response to use.
  Expected<const WrenchResponse*> request(const BorrowedRequest& request);
  // Requests the water at points and waits for the response to this request, as in lock-step mode.
  Expected<const WaterSamples*> sample_water(const BorrowedWaterPoints& request);
  // The loads of the response that was returned last, see ChannelOptions::wait_for_loads.
  const BodiesLoads& loads() const { return channel_.latest_loads(); }
  // See LcmRequestChannel.
  const ServiceStatus* wait_for_status(Clock::time_point deadline) {
    return channel_.wait_for_status(deadline);
  }
  const Warning* scene_warning() const { return channel_.scene_warning(); }
  ClientStats statistics() const;

 private:
  struct Sent {
    std::int64_t seq = 0;
    Clock::time_point at;
  };

  bool wait_for(std::int64_t seq, Clock::time_point deadline);
  void record_arrivals();

  LcmRequestChannel channel_;
  RetryPolicy retry_policy_;
  Clock::duration interval_;
  Clock::time_point next_send_;
  std::deque<Sent> unanswered_;      // ascending by seq, none older than total_timeout()
  Clock::time_point waiting_since_;  // when the first request after the last arrival was sent
  bool waiting_ = false;             // a request has been sent since the last arrival
  ClientStats statistics_;
};

}  // namespace buoyancy
