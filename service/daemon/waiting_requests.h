// The requests of mode lockstep that cannot be handled yet, in order of arrival. Memory is bounded.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "messages/wire.h"

namespace buoyancy::service {

class WaitingRequests {
 public:
  enum class PushResult {
    kQueued,
    kRetry,  // not queued: its session has the same bytes waiting
    kFull,   // not queued
  };

  // max_bytes: of all requests [bytes].
  WaitingRequests(std::size_t max_requests, std::size_t max_bytes)
      : max_requests_(max_requests), max_bytes_(max_bytes) {}

  // arrival: [s], of any monotonic clock; pop_next() returns it with the request.
  PushResult push(const SessionKey& session, Bytes request, double arrival) {
    for (const Request& waiting : requests_) {
      if (waiting.session == session && std::ranges::equal(waiting.bytes, request)) {
        return PushResult::kRetry;
      }
    }
    if (requests_.size() == max_requests_ || request.size() > max_bytes_ - bytes_) return PushResult::kFull;
    requests_.push_back({session, arrival, {request.begin(), request.end()}});
    bytes_ += request.size();
    return PushResult::kQueued;
  }

  bool contains(const SessionKey& session) const {
    return std::ranges::find(requests_, session, &Request::session) != requests_.end();
  }

  // Removes the first request with may_handle(const SessionKey&, double arrival), and calls
  // handle(Bytes request, double arrival). False: there is none.
  template <typename Predicate, typename Handler>
  bool pop_next(Predicate&& may_handle, Handler&& handle) {
    const auto next = std::ranges::find_if(
        requests_, [&](const Request& waiting) { return may_handle(waiting.session, waiting.arrival); });
    if (next == requests_.end()) return false;
    const Request request = std::move(*next);
    requests_.erase(next);
    bytes_ -= request.bytes.size();
    handle(Bytes(request.bytes), request.arrival);
    return true;
  }

  bool empty() const { return requests_.empty(); }
  double first_arrival() const { return requests_.front().arrival; }  // [s]. Precondition: not empty

 private:
  struct Request {
    SessionKey session;
    double arrival = 0.0;
    std::vector<std::uint8_t> bytes;
  };

  std::size_t max_requests_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::deque<Request> requests_;
};

}  // namespace buoyancy::service
