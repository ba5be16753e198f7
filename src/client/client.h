// Connects a simulator to the buoyancy service: sends body states and receives wrenches, and asks for the
// water at points.
//
//   buoyancy::Expected<buoyancy::Client> client = buoyancy::Client::open();
//   ...
//   const auto response = client->request(utime, states);  // in every step: all bodies in one request
//   if (!response) return fail(response.error().message());
//   for (const buoyancy::BodyWrench& wrench : (*response)->bodies) ...
//
// Every client is a session: it draws a session_id and numbers its requests. Several clients can therefore
// share a service, and a restarted client is served at once. docs/sidecar.md explains this example.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "client/free_running_client.h"
#include "client/lockstep_client.h"

namespace buoyancy {

struct ClientOptions {
  ChannelOptions channel;
  RetryPolicy retry_policy;
  // Wall-clock time between requests [s], > 0; each request returns the newest response (FreeRunningClient).
  // nullopt: lock-step, each request returns its own response (LockstepClient).
  std::optional<double> interval;
  std::optional<std::int64_t> session_id;  // nullopt: make_session_id()
};

class Client {
 public:
  // Errors: those of LcmConnection::open.
  static Expected<Client> open(const ClientOptions& options = {});

  // Prepares for requests about this many bodies, and says before the first one whether they can arrive: see
  // LcmRequestChannel::reserve(). request() does the same, without the warning.
  Expected<std::optional<Warning>> reserve(std::size_t bodies);

  // Requests the wrenches on bodies in these states and returns one per state, in the same order, valid until
  // the next call. utime: simulation time [us], which the response's id repeats. lead_time: [s], evaluates
  // at the poses extrapolated by this much; 0: as given. A body that cannot be evaluated has zeros and a
  // status other than kOk; see find_failed_body(). Errors: see retry_policy.h.
  Expected<const WrenchResponse*> request(std::int64_t utime, std::span<const BodyState> states,
                                          double lead_time = 0.0);

  // Requests the water at these points at a simulation time [us] and waits for the response: one sample per
  // point, in the same order, valid until the next call. Where its status is not kOk, all samples are 0. The
  // wrenches of an earlier request() may be replaced by newer ones. Errors: see retry_policy.h.
  Expected<const WaterSamples*> sample_water(std::int64_t utime, std::span<const WaterPoint> points);

  // The loads that belong to the last response, of its bodies with this output in their order, valid until
  // the next request. Precondition: ClientOptions::channel.wait_for_loads; there are none otherwise.
  const BodiesLoads& loads() const;

  // Warns of a service whose scene is not the caller's, if ChannelOptions::scene_fingerprint is set; nullptr:
  // none has been seen. The service states its scene when a session begins, and once a second.
  const Warning* scene_warning() const;

  // Waits at most this time [s] for the next status of a service, which is due once a second. The status is
  // valid until the next call. Errors: none arrives.
  Expected<const ServiceStatus*> status(double timeout = 2.0);

  ClientStats statistics() const;

 private:
  using ClientVariant = std::variant<LockstepClient, FreeRunningClient>;
  Client(ClientVariant client, std::int64_t session_id, std::string status_channel);

  ClientVariant client_;
  std::string status_channel_;
  RequestId next_;         // of the next request
  RequestId next_points_;  // of the next request for the water at points
};

// Draws a random session_id >= 0. The probability that it equals a given other one is 2^-63.
std::int64_t make_session_id();

// Returns the loads of a body, or nullptr if it has no such output. Complexity: O(bodies).
const BodyLoads* find_loads(const BodiesLoads& loads, std::int32_t body_id);

// The first wrench whose status is not kOk, or nullptr. A simulator must not continue without a body's force.
const BodyWrench* find_failed_body(const WrenchResponse& response);

}  // namespace buoyancy
