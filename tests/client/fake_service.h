// A fake buoyancy service for tests, and requests to it, over UDP multicast in the test's network namespace.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>

#include "client/lcm_request_channel.h"
#include "client/retry_policy.h"
#include "tests/support/byte_vector.h"
#include "tests/support/timeouts.h"
#include "transport/lcm_connection.h"

namespace buoyancy {

// Retries for longer than any test waits.
inline const RetryPolicy kTestRetryPolicy{0.5, std::llround(2.0 * kWaitTimeout)};

using Responses = std::vector<std::vector<std::uint8_t>>;
using Responder = std::function<Responses(const WrenchRequest& request)>;

template <typename T>
T value_or_die(Expected<T> expected) {
  if (!expected) {
    ADD_FAILURE() << expected.error().message();
    std::abort();
  }
  return std::move(*expected);
}

// Publishes the responder's responses to every request, from its own thread: loads on their channel,
// everything else on that of the wrenches.
class FakeService {
 public:
  explicit FakeService(Responder responder)
      : connection_(value_or_die(LcmConnection::open(""))), responder_(std::move(responder)) {
    const Expected<void> subscribed =
        connection_.subscribe(std::string(kStatesChannel), [this](Bytes bytes, std::string_view) {
          WrenchRequest request;
          if (decode(bytes, request)) return;
          ++requests_;
          for (const auto& response : responder_(request)) {
            BodiesLoads loads;
            const std::string_view channel = decode(response, loads) ? kWrenchesChannel : kLoadsChannel;
            EXPECT_TRUE(connection_.publish(std::string(channel), response));
          }
        });
    EXPECT_TRUE(subscribed);
    thread_ = std::thread([this] {
      while (!stop_) {
        pollfd waiting{connection_.fileno(), POLLIN, 0};
        if (poll(&waiting, 1, 20) > 0) connection_.handle_one();
      }
    });
  }
  FakeService(const FakeService&) = delete;
  FakeService& operator=(const FakeService&) = delete;
  ~FakeService() {
    stop_ = true;
    thread_.join();
  }

  int requests() const { return requests_; }

 private:
  LcmConnection connection_;
  Responder responder_;
  std::atomic<bool> stop_{false};
  std::atomic<int> requests_{0};
  std::thread thread_;
};

inline LcmRequestChannel open_channel(const ChannelOptions& options = {}) {
  return value_or_die(LcmRequestChannel::open(options));
}

// A request about bodies 5 and 6 in session 77.
inline WrenchRequest make_request(std::int64_t seq) {
  WrenchRequest request;
  request.id = {1000 * seq, 77, seq};
  request.bodies.resize(2);
  request.bodies[0].body_id = 5;
  request.bodies[1].body_id = 6;
  return request;
}

inline WrenchResponse response_to(const WrenchRequest& request, double force) {
  WrenchResponse response;
  response.id = request.id;
  for (const BodyState& body : request.bodies) {
    BodyWrench wrench;
    wrench.body_id = body.body_id;
    wrench.force = {0, 0, force};
    response.bodies.push_back(wrench);
  }
  return response;
}

// The loads of the request's last body alone.
inline BodiesLoads loads_for(const WrenchRequest& request, double drag) {
  BodiesLoads loads;
  loads.id = request.id;
  BodyLoads& body = loads.bodies.emplace_back();
  body.body_id = request.bodies.back().body_id;
  body.drag_force = {0, 0, drag};
  return loads;
}

}  // namespace buoyancy
