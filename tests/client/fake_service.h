// A service that a test plays itself, over UDP multicast in the test's network namespace.
#pragma once

#include <atomic>
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

#include "messages/wire.h"
#include "transport/lcm_connection.h"

namespace buoyancy {

using Replies = std::vector<std::vector<std::uint8_t>>;
using Reply = std::function<Replies(const WrenchRequest& request)>;

template <typename T>
T value_or_die(Expected<T> expected) {
  if (!expected) {
    ADD_FAILURE() << expected.error().message();
    std::abort();
  }
  return std::move(*expected);
}

// Publishes what `reply` makes of every request, from a thread of its own.
class Peer {
 public:
  explicit Peer(Reply reply) : connection_(value_or_die(LcmConnection::open(""))), reply_(std::move(reply)) {
    const Expected<void> subscribed =
        connection_.subscribe(std::string(kStatesChannel), [this](Bytes bytes, std::string_view) {
          WrenchRequest request;
          if (decode(bytes, request)) return;
          ++requests_;
          for (const auto& response : reply_(request)) {
            EXPECT_TRUE(connection_.publish(std::string(kWrenchesChannel), response));
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
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() {
    stop_ = true;
    thread_.join();
  }

  int requests() const { return requests_; }

 private:
  LcmConnection connection_;
  Reply reply_;
  std::atomic<bool> stop_{false};
  std::atomic<int> requests_{0};
  std::thread thread_;
};

inline WrenchResponse response_to(const WrenchRequest& request, double force) {
  WrenchResponse response;
  response.key = request.key;
  for (const BodyState& body : request.bodies) {
    BodyWrench wrench;
    wrench.body_id = body.body_id;
    wrench.force = {0, 0, force};
    response.bodies.push_back(wrench);
  }
  return response;
}

inline std::vector<std::uint8_t> bytes_of(const WrenchResponse& response) {
  std::vector<std::uint8_t> bytes;
  encode(response, bytes);
  return bytes;
}

}  // namespace buoyancy
