// A simulator's end of the service, for simulators that are not ours: states in, wrenches out.
//
//   buoyancy::Expected<buoyancy::Client> client = buoyancy::Client::open();
//   ...
//   const auto answer = client->request(utime, states);  // in every step: all bodies in one request
//   if (!answer) return fail(answer.error().message());
//   for (const buoyancy::BodyWrench& wrench : (*answer)->bodies) ...
//
// A client is a session of its own: it draws its number and counts its requests, so several clients share a
// service, and one that is started again is answered at once. docs/sidecar.md goes through it line by line.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "client/lockstep_client.h"

namespace buoyancy {

struct ClientOptions {
  ChannelOptions channel;
  RetryPolicy retry_policy;
  // s, > 0, of wall-clock time: requests are this far apart, each answered with the newest response there is
  // (FreeRunningClient). nullopt: lock-step, every request with its own response.
  std::optional<double> interval;
  std::optional<std::int64_t> session_id;  // nullopt: drawn by make_session_id()
};

class Client {
 public:
  // Errors: those of LcmConnection::open.
  static Expected<Client> open(const ClientOptions& options = {});

  // The wrenches on bodies in these states: one per state, in the same order, valid until the next call.
  // utime: us, of the simulation; it comes back in the response's key. lead_time: s, the wrenches are those
  // at the poses extrapolated by this much; 0 as they are. A body that cannot be answered has a status other
  // than kOk and zeros; find_failed_body() finds it. Errors: the client's.
  Expected<const WrenchResponse*> request(std::int64_t utime, std::span<const BodyState> states,
                                          double lead_time = 0.0);

  ClientStats statistics() const;

 private:
  using ClientVariant = std::variant<LockstepClient, FreeRunningClient>;
  Client(ClientVariant client, std::int64_t session_id);

  ClientVariant client_;
  WrenchRequest request_;  // reused; its key is that of the next request
};

// A number that no other session has, but for a chance of 1 to 2^63; not negative.
std::int64_t make_session_id();

// The first wrench that is not one; nullptr: all are OK. A simulator must not go on without a body's force.
const BodyWrench* find_failed_body(const WrenchResponse& response);

}  // namespace buoyancy
