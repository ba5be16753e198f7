// A bad network between client and service: carries the requests of one bus to another and the responses
// back, loses some of each, sends some twice, has some overtaken by later ones, and can be slow with the
// responses. Seeded: it loses the same messages of a sequence every time.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

namespace buoyancy {

struct RelayOptions {
  std::string client_url;
  std::string service_url;
  double loss = 0.0;            // probability, of requests and of responses
  double response_delay = 0.0;  // s
  std::uint64_t seed = 1;
  double duplication = 0.0;  // probability, of requests and of responses
  double reordering = 0.0;   // the same: it arrives some milliseconds late, after a repeat or the next one
};

class LossyRelay {
 public:
  explicit LossyRelay(const RelayOptions& options);  // carries as soon as it is constructed
  LossyRelay(const LossyRelay&) = delete;
  LossyRelay& operator=(const LossyRelay&) = delete;
  ~LossyRelay();

  std::int64_t lost_requests() const { return lost_requests_; }
  std::int64_t lost_responses() const { return lost_responses_; }
  std::int64_t duplicated() const { return duplicated_; }
  std::int64_t reordered() const { return reordered_; }

 private:
  struct Carrier;

  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> lost_requests_{0};
  std::atomic<std::int64_t> lost_responses_{0};
  std::atomic<std::int64_t> duplicated_{0};
  std::atomic<std::int64_t> reordered_{0};
  std::thread thread_;
};

}  // namespace buoyancy
