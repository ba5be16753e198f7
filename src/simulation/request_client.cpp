#include "simulation/request_client.h"

#include <cassert>
#include <chrono>

namespace buoyancy {

Expected<const WrenchResponse*> InProcessClient::request(const WrenchRequest& request) {
  const Clock::time_point asked_at = Clock::now();
  encode(request, bytes_);
  [[maybe_unused]] const auto rejection = decode(handler_.handle(bytes_), response_);
  assert(!rejection);  // what we encode, the handler answers
  ++statistics_.requests;
  statistics_.round_trip.add(std::chrono::duration<double>(Clock::now() - asked_at).count());
  return &response_;
}

Expected<const WrenchResponse*> request(RequestClient& client, const WrenchRequest& request) {
  return std::visit([&](auto& a) { return a.request(request); }, client);
}

ClientStats statistics(const RequestClient& client) {
  return std::visit([](const auto& a) -> ClientStats { return a.statistics(); }, client);
}

}  // namespace buoyancy
