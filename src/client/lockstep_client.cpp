#include "client/lockstep_client.h"

#include <utility>

#include "client/request_with_retries.h"

namespace buoyancy {

LockstepClient::LockstepClient(LcmRequestChannel channel, RetryPolicy retry_policy)
    : channel_(std::move(channel)), retry_policy_(retry_policy) {}

Expected<const WrenchResponse*> LockstepClient::request(const BorrowedRequest& request) {
  Expected<const WrenchResponse*> response =
      request_with_retries(channel_, request, retry_policy_, statistics_);
  statistics_.malformed = channel_.malformed();
  return response;
}

Expected<const WaterSamples*> LockstepClient::sample_water(const BorrowedWaterPoints& request) {
  Expected<const WaterSamples*> samples =
      sample_water_with_retries(channel_, request, retry_policy_, statistics_);
  statistics_.malformed = channel_.malformed();
  return samples;
}

}  // namespace buoyancy
