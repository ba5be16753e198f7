// The simulator's source of responses: a service over LCM (client/lockstep_client.h), or the request handler
// in this process, which needs no network.
#pragma once

#include <cstdint>
#include <span>
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
  const Warning* scene_warning() const { return nullptr; }  // it uses the scene itself

  // See RequestHandler::receive_condition(). No message is lost in a process, so `repeated` is ignored.
  void set_conditions(std::span<const ConditionChange> announced, std::span<const ConditionChange> repeated);

 private:
  RequestHandler handler_;
  std::vector<std::uint8_t> bytes_;
  WrenchResponse response_;
  ClientStats statistics_;
};

using SimulationClient = std::variant<InProcessClient, LockstepClient, FreeRunningClient>;

// The response holds as many bodies as the request, in the same order, and is valid until the next call.
// Errors: those of the client in use.
Expected<const WrenchResponse*> request(SimulationClient& client, const WrenchRequest& request);
// Sets what is sent with the next request, and with every retry of it: see LcmRequestChannel.
void set_conditions(SimulationClient& client, std::span<const ConditionChange> announced,
                    std::span<const ConditionChange> repeated);
ClientStats statistics(const SimulationClient& client);
// See LcmRequestChannel::scene_warning().
const Warning* scene_warning(const SimulationClient& client);

}  // namespace buoyancy
