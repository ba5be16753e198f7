#include "client/client.h"

#include <algorithm>
#include <random>
#include <utility>

#include "base/format.h"
#include "client/request_with_retries.h"

namespace buoyancy {

Expected<Client> Client::open(const ClientOptions& options) {
  Expected<LcmRequestChannel> channel = LcmRequestChannel::open(options.channel);
  if (!channel) return make_error(channel.error());
  const std::int64_t session_id = options.session_id ? *options.session_id : make_session_id();
  if (options.interval) {
    return Client(FreeRunningClient(std::move(*channel), options.retry_policy, *options.interval), session_id,
                  options.channel.status_channel);
  }
  return Client(LockstepClient(std::move(*channel), options.retry_policy), session_id,
                options.channel.status_channel);
}

Client::Client(ClientVariant client, std::int64_t session_id, std::string status_channel)
    : client_(std::move(client)), status_channel_(std::move(status_channel)) {
  next_.session_id = session_id;
  next_points_.session_id = session_id;
}

Expected<std::optional<Warning>> Client::reserve(std::size_t bodies) {
  return std::visit([bodies](auto& client) { return client.reserve(bodies); }, client_);
}

Expected<const WrenchResponse*> Client::request(std::int64_t utime, std::span<const BodyState> states,
                                                double lead_time) {
  next_.utime = utime;
  const BorrowedRequest request(next_, lead_time, states);
  Expected<const WrenchResponse*> response =
      std::visit([&](auto& client) { return client.request(request); }, client_);
  ++next_.seq;
  return response;
}

Expected<const WaterSamples*> Client::sample_water(std::int64_t utime, std::span<const WaterPoint> points) {
  next_points_.utime = utime;
  const BorrowedWaterPoints request(next_points_, points);
  Expected<const WaterSamples*> samples =
      std::visit([&](auto& client) { return client.sample_water(request); }, client_);
  ++next_points_.seq;
  return samples;
}

const BodiesLoads& Client::loads() const {
  return std::visit([](const auto& client) -> const BodiesLoads& { return client.loads(); }, client_);
}

const Warning* Client::scene_warning() const {
  return std::visit([](const auto& client) { return client.scene_warning(); }, client_);
}

Expected<const ServiceStatus*> Client::status(double timeout) {
  const Clock::time_point deadline = Clock::now() + to_duration(timeout);
  const ServiceStatus* const status =
      std::visit([deadline](auto& client) { return client.wait_for_status(deadline); }, client_);
  if (status != nullptr) return status;
  return make_error({"channel " + status_channel_, "no status for " + format_number(timeout, 3) + " s",
                     "the status of buoyancyd, once a second",
                     "no buoyancyd is running on this LCM URL, or its status has another channel",
                     "Start buoyancyd with the same URL and channels"});
}

ClientStats Client::statistics() const {
  return std::visit([](const auto& client) -> ClientStats { return client.statistics(); }, client_);
}

std::int64_t make_session_id() {
  std::random_device device;
  const std::uint64_t bits = (std::uint64_t{device()} << 32U) | device();
  return static_cast<std::int64_t>(bits >> 1U);
}

const BodyLoads* find_loads(const BodiesLoads& loads, std::int32_t body_id) {
  const auto found = std::ranges::find(loads.bodies, body_id, &BodyLoads::body_id);
  return found == loads.bodies.end() ? nullptr : &*found;
}

const BodyWrench* find_failed_body(const WrenchResponse& response) {
  const auto found = std::ranges::find_if(
      response.bodies, [](const BodyWrench& wrench) { return wrench.status != BodyStatus::kOk; });
  return found == response.bodies.end() ? nullptr : &*found;
}

}  // namespace buoyancy
