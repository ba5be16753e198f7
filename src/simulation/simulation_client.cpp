#include "simulation/simulation_client.h"

#include <cassert>
#include <chrono>

namespace buoyancy {

Expected<const WrenchResponse*> InProcessClient::request(const WrenchRequest& request) {
  const Clock::time_point sent_at = Clock::now();
  encode(request, bytes_);
  [[maybe_unused]] const auto error = decode(handler_.handle(bytes_), response_);
  assert(!error);  // a request that we encode is always valid
  ++statistics_.requests;
  statistics_.round_trip.add(std::chrono::duration<double>(Clock::now() - sent_at).count());
  return &response_;
}

void InProcessClient::set_conditions(std::span<const ConditionChange> announced,
                                     std::span<const ConditionChange> /*repeated*/) {
  for (const ConditionChange& change : announced) {
    encode(change, bytes_);
    [[maybe_unused]] const Expected<void> received = handler_.receive_condition(bytes_);
    assert(received);  // the scene has been checked
  }
}

void set_conditions(SimulationClient& client, std::span<const ConditionChange> announced,
                    std::span<const ConditionChange> repeated) {
  std::visit([&](auto& alternative) { alternative.set_conditions(announced, repeated); }, client);
}

Expected<const WrenchResponse*> request(SimulationClient& client, const WrenchRequest& request) {
  return std::visit([&](auto& alternative) { return alternative.request(request); }, client);
}

const Warning* scene_warning(const SimulationClient& client) {
  return std::visit([](const auto& alternative) { return alternative.scene_warning(); }, client);
}

ClientStats statistics(const SimulationClient& client) {
  return std::visit([](const auto& alternative) -> ClientStats { return alternative.statistics(); }, client);
}

}  // namespace buoyancy
