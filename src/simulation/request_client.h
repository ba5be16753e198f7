// How the simulator gets a response to its request: over LCM (client/client.h), or from the handler
// itself in this process, for machines without a network.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "client/free_running_client.h"
#include "client/lockstep_client.h"
#include "engine/request_handler.h"

namespace buoyancy {

class InProcessClient {
 public:
  explicit InProcessClient(const Scene& scene) : handler_(scene) {}  // scene must outlive the client

  Expected<const WrenchResponse*> request(const WrenchRequest& request);
  const ClientStats& statistics() const { return statistics_; }

 private:
  RequestHandler handler_;
  std::vector<std::uint8_t> bytes_;
  WrenchResponse response_;
  ClientStats statistics_;
};

using RequestClient = std::variant<InProcessClient, LockstepClient, FreeRunningClient>;

// The response holds as many bodies as the request, in the same order, and is valid until the next call.
// Errors: the client's.
Expected<const WrenchResponse*> request(RequestClient& client, const WrenchRequest& request);
ClientStats statistics(const RequestClient& client);

}  // namespace buoyancy
