// A client that sends one request at a time and waits for its response.
//
// The same bytes are sent again after each timeout until the response with the request's (session_id, seq)
// arrives. Loss on the network therefore costs time and changes no result. Contract and errors: see
// retry_policy.h.
#pragma once

#include <span>

#include "client/client_stats.h"
#include "client/lcm_request_channel.h"
#include "client/retry_policy.h"

namespace buoyancy {

class LockstepClient {
 public:
  LockstepClient(LcmRequestChannel channel, RetryPolicy retry_policy);

  // See LcmRequestChannel::set_conditions().
  void set_conditions(std::span<const ConditionChange> announced, std::span<const ConditionChange> repeated) {
    channel_.set_conditions(announced, repeated);
  }

  // See LcmRequestChannel::reserve().
  Expected<std::optional<Warning>> reserve(std::size_t bodies) { return channel_.reserve(bodies); }

  Expected<const WrenchResponse*> request(const BorrowedRequest& request);
  // Requests the water at points.
  Expected<const WaterSamples*> sample_water(const BorrowedWaterPoints& request);
  // The loads of the response that was returned last, see ChannelOptions::wait_for_loads.
  const BodiesLoads& loads() const { return channel_.latest_loads(); }
  // See LcmRequestChannel.
  const ServiceStatus* wait_for_status(Clock::time_point deadline) {
    return channel_.wait_for_status(deadline);
  }
  const Warning* scene_warning() const { return channel_.scene_warning(); }
  const ClientStats& statistics() const { return statistics_; }

 private:
  LcmRequestChannel channel_;
  RetryPolicy retry_policy_;
  ClientStats statistics_;
};

}  // namespace buoyancy
