#include "client/request_with_retries.h"

#include <algorithm>
#include <string>

#include "base/format.h"

namespace buoyancy {
namespace {

std::string subject(const LcmRequestChannel& channel, std::int64_t seq) {
  return "request " + std::to_string(seq) + " on " + channel.describe_endpoint();
}

// Returns the first body of the loads that breaks the request's order, or is not in the request.
const BodyLoads* find_other_body(const BorrowedRequest& request, const BodiesLoads& loads) {
  auto next = request.bodies.begin();
  for (const BodyLoads& body : loads.bodies) {
    next = std::find_if(next, request.bodies.end(),
                        [&](const BodyState& state) { return state.body_id == body.body_id; });
    if (next == request.bodies.end()) return &body;
    ++next;
  }
  return nullptr;
}

bool lacks_sea(const WrenchResponse& response) {
  return std::ranges::find(response.bodies, BodyStatus::kNoSea, &BodyWrench::status) != response.bodies.end();
}

}  // namespace

Expected<const WrenchResponse*> request_with_retries(LcmRequestChannel& channel,
                                                     const BorrowedRequest& request,
                                                     const RetryPolicy& retry_policy,
                                                     ClientStats& statistics) {
  if (const Expected<void> checked = channel.check_size(request.bodies.size()); !checked) {
    return make_error(checked.error());
  }
  const Clock::time_point sent_at = Clock::now();
  ++statistics.requests;
  Expected<void> sent = channel.send(request);
  for (std::int64_t retries = 0;; ++retries) {
    const Clock::time_point deadline = Clock::now() + to_duration(retry_policy.timeout);
    while (channel.wait_for(request.id.seq, deadline)) {
      if (retries < retry_policy.max_retries && lacks_sea(channel.latest_response())) {
        channel.discard_response();
        continue;
      }
      statistics.round_trip.add(to_seconds(channel.arrivals().back().at - sent_at));
      return check_response(channel, request, channel.latest_response());
    }
    if (channel.cancelled()) return cancelled_error(channel, request.id.seq);
    if (retries == retry_policy.max_retries) {
      ++statistics.unanswered;
      if (!sent) return make_error(sent.error());
      return no_response_error(channel, request.id.seq, to_seconds(Clock::now() - sent_at));
    }
    ++statistics.retries;
    sent = channel.resend();
  }
}

Expected<const WrenchResponse*> check_response(const LcmRequestChannel& channel,
                                               const BorrowedRequest& request,
                                               const WrenchResponse& response) {
  if (!channel.contradiction().empty()) {
    return make_error({channel.describe_endpoint(), channel.contradiction(), "one response, or equal ones",
                       "two services with different scenes respond on these channels",
                       "Stop one of them, or give each its own channels"});
  }
  const bool same_bodies = std::equal(
      request.bodies.begin(), request.bodies.end(), response.bodies.begin(), response.bodies.end(),
      [](const BodyState& state, const BodyWrench& wrench) { return state.body_id == wrench.body_id; });
  if (!same_bodies) {
    return make_error({subject(channel, request.id.seq), "a response with other bodies than requested",
                       "one wrench per requested body, in the order of the request",
                       "a program other than buoyancyd publishes on the wrenches channel", ""});
  }
  if (const auto* stranger = find_other_body(request, channel.latest_loads())) {
    return make_error({subject(channel, request.id.seq),
                       "loads of body " + std::to_string(stranger->body_id) + ", which was not requested",
                       "loads of requested bodies, in the order of the request",
                       "a program other than buoyancyd publishes on the loads channel", ""});
  }
  return &response;
}

tl::unexpected<Error> no_response_error(const LcmRequestChannel& channel, std::int64_t seq, double waited) {
  const std::string missing = channel.lacks_only_loads() ? "loads" : "response";
  const auto [cause, hint] = channel.explain_no_response();
  return make_error(
      {subject(channel, seq), "no " + missing + " for " + format_number(waited, 3) + " s",
       channel.waits_for_loads() ? "a response and its loads from buoyancyd" : "a response from buoyancyd",
       cause, hint});
}

tl::unexpected<Error> cancelled_error(const LcmRequestChannel& channel, std::int64_t seq) {
  return make_error({subject(channel, seq), "cancelled while waiting", "a response from buoyancyd", "", ""});
}

double to_seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

Clock::duration to_duration(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace buoyancy
