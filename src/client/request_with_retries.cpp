#include "client/request_with_retries.h"

#include <algorithm>
#include <optional>
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

// Calls send(), and resend() after each timeout until wait(deadline, is_last) is true or the retries are used
// up. Returns when the request was sent first; nullopt: there is no response, or the waiting was cancelled. A
// failed sending counts as a lost request; `sent` is the result of the last one.
template <typename Send, typename Resend, typename Wait>
std::optional<Clock::time_point> exchange(const LcmRequestChannel& channel, const RetryPolicy& retry_policy,
                                          ClientStats& statistics, Expected<void>& sent, const Send& send,
                                          const Resend& resend, const Wait& wait) {
  const Clock::time_point sent_at = Clock::now();
  ++statistics.requests;
  sent = send();
  for (std::int64_t retries = 0;; ++retries) {
    if (wait(Clock::now() + to_duration(retry_policy.timeout), retries == retry_policy.max_retries))
      return sent_at;
    if (channel.cancelled()) return std::nullopt;
    if (retries == retry_policy.max_retries) {
      ++statistics.unanswered;
      return std::nullopt;
    }
    ++statistics.retries;
    sent = resend();
  }
}

}  // namespace

Expected<const WrenchResponse*> request_with_retries(LcmRequestChannel& channel,
                                                     const BorrowedRequest& request,
                                                     const RetryPolicy& retry_policy,
                                                     ClientStats& statistics) {
  if (const Expected<void> checked = channel.check_size(request.bodies.size()); !checked) {
    return make_error(checked.error());
  }
  const std::int64_t seq = request.id.seq;
  const Clock::time_point start = Clock::now();
  Expected<void> sent;
  const auto sent_at = exchange(
      channel, retry_policy, statistics, sent, [&] { return channel.send(request); },
      [&] { return channel.resend(); },
      [&](Clock::time_point deadline, bool is_last) {
        while (channel.wait_for(seq, deadline)) {
          if (is_last || !lacks_sea(channel.latest_response())) return true;
          channel.discard_response();
        }
        return false;
      });
  if (sent_at) {
    statistics.round_trip.add(to_seconds(channel.arrivals().back().at - *sent_at));
    return check_response(channel, request, channel.latest_response());
  }
  if (channel.cancelled()) return cancelled_error(channel, seq);
  if (!sent) return make_error(sent.error());
  return no_response_error(channel, seq, to_seconds(Clock::now() - start));
}

Expected<const WaterSamples*> sample_water_with_retries(LcmRequestChannel& channel,
                                                        const BorrowedWaterPoints& request,
                                                        const RetryPolicy& retry_policy,
                                                        ClientStats& statistics) {
  if (const Expected<void> checked = channel.check_points(request.points.size()); !checked) {
    return make_error(checked.error());
  }
  const std::int64_t seq = request.id.seq;
  const std::string what = "request " + std::to_string(seq) + " for the water at " +
                           std::to_string(request.points.size()) + " points on " +
                           channel.describe_points_endpoint();
  const Clock::time_point start = Clock::now();
  Expected<void> sent;
  const auto sent_at = exchange(
      channel, retry_policy, statistics, sent, [&] { return channel.send(request); },
      [&] { return channel.resend_points(); },
      [&](Clock::time_point deadline, bool is_last) {
        while (channel.wait_for_samples(seq, deadline)) {
          if (is_last || channel.latest_samples().status != BodyStatus::kNoSea) return true;
          channel.discard_samples();
        }
        return false;
      });
  if (!sent_at) {
    if (channel.cancelled()) {
      return make_error({what, "cancelled while waiting", "a response from buoyancyd", "", ""});
    }
    if (!sent) return make_error(sent.error());
    return make_error(
        {what, "no response for " + format_number(to_seconds(Clock::now() - start), 3) + " s",
         "a response from buoyancyd",
         "no buoyancyd is running on this LCM URL and these channels, or it rejects the request",
         "Start buoyancyd with the same URL and channels; if it is running, see its log"});
  }
  statistics.round_trip.add(to_seconds(Clock::now() - *sent_at));
  const WaterSamples& samples = channel.latest_samples();
  if (samples.samples.size() == request.points.size()) return &samples;
  return make_error({what, "a response of " + std::to_string(samples.samples.size()) + " points",
                     "one sample per point", "a program other than buoyancyd publishes on the channel", ""});
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
