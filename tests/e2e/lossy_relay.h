// Simulates a bad network between client and service: forwards requests and conditions from one LCM network
// to another and the responses and loads back, with loss, duplication, reordering and a delay of the
// responses. The random generator is seeded: the same messages of a sequence are lost every time.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

namespace buoyancy {

struct RelayOptions {
  std::string client_url;
  std::string service_url;
  double loss = 0.0;            // probability, for every message
  double response_delay = 0.0;  // [s]
  std::uint64_t seed = 1;
  double duplication = 0.0;  // probability, likewise
  double reordering =
      0.0;  // probability of an extra delay of some milliseconds, past a retry or the next message
};

class LossyRelay {
 public:
  explicit LossyRelay(const RelayOptions& options);  // starts to forward
  LossyRelay(const LossyRelay&) = delete;
  LossyRelay& operator=(const LossyRelay&) = delete;
  ~LossyRelay();

  std::int64_t lost_requests() const { return lost_requests_; }
  std::int64_t lost_responses() const { return lost_responses_; }
  std::int64_t lost_conditions() const { return lost_conditions_; }
  std::int64_t duplicated() const { return duplicated_; }
  std::int64_t reordered() const { return reordered_; }

 private:
  struct Forwarder;

  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> lost_requests_{0};
  std::atomic<std::int64_t> lost_conditions_{0};
  std::atomic<std::int64_t> lost_responses_{0};
  std::atomic<std::int64_t> duplicated_{0};
  std::atomic<std::int64_t> reordered_{0};
  std::thread thread_;
};

}  // namespace buoyancy
