// The client's end of the LCM connection: sends the requests of one session and keeps its newest response.
//
// A response belongs to the session if its session_id is the session's and its seq does not exceed that of
// the last request; the one with the highest seq is kept. Other messages on the channel are ignored. Where
// loads are waited for, the same holds for them, and a response counts as arrived once the loads with its seq
// have arrived too: a lost loads message is then requested again like a lost response.
//
// Requests for the water at points have sequence numbers and a newest response of their own.
//
// Two responses to one request that differ by more than their error bounds come from two services with
// different scenes, or from a program that changes them. Not thread-safe.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "messages/condition_change.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "transport/lcm_connection.h"

namespace buoyancy {

using Clock = std::chrono::steady_clock;

struct ResponseArrival {
  std::int64_t seq = 0;
  Clock::time_point at;
};

struct ChannelOptions {
  std::string lcm_url;  // "": LCM's default, see resolve_lcm_url()
  std::string states_channel{kStatesChannel};
  std::string wrenches_channel{kWrenchesChannel};
  std::string loads_channel{kLoadsChannel};
  std::string condition_channel{kConditionChannel};  // for set_conditions()
  std::string water_points_channel{kWaterPointsChannel};
  std::string water_samples_channel{kWaterSamplesChannel};
  std::string status_channel{kStatusChannel};
  // scene_fingerprint() of the caller's scene: compared with that of every service on the status channel, see
  // scene_warning(). nullopt: not compared.
  std::optional<std::int64_t> scene_fingerprint;
  // Receive the loads of every response as well, and wait for them. At least one body of each request must
  // have the output "loads" in the service's scene: else none are published, and no request succeeds.
  bool wait_for_loads = false;
  bool spin = true;  // poll briefly before sleeping: lower latency for more processor time
  const std::atomic<bool>* cancelled = nullptr;  // if not null, waiting ends soon after it becomes true
  // If set, called by the waiting thread at least every 0.1 s; waiting ends once it returns true. For callers
  // that must look for signals meanwhile, such as an interpreter's.
  std::function<bool()> is_interrupted;
};

class LcmRequestChannel {
 public:
  // Errors: those of LcmConnection::open.
  static Expected<LcmRequestChannel> open(const ChannelOptions& options);

  // Errors: a message cannot carry this many bodies; the response to this many points.
  Expected<void> check_size(std::size_t bodies) const;
  Expected<void> check_points(std::size_t points) const;

  // Prepares for requests about this many bodies: enlarges the receive buffer for their responses. Returns a
  // warning if responses may lose packets because the kernel grants a smaller buffer. send() does the same,
  // without the warning. Errors: those of check_size().
  Expected<std::optional<Warning>> reserve(std::size_t bodies);

  // Sets what is published before every request, and what before every one that is sent again, until the next
  // call. Initially nothing is published.
  void set_conditions(std::span<const ConditionChange> announced, std::span<const ConditionChange> repeated);

  // Encodes and publishes the request. Precondition: session_id is constant, seq does not decrease. Errors:
  // those of check_size() and of LcmConnection::publish.
  Expected<void> send(const BorrowedRequest& request);
  // Publishes the bytes of the last request again.
  Expected<void> resend();
  // The same for the water at points: session_id is that of all requests. The first call subscribes to the
  // responses. Errors: those of check_points(), a failed subscription, and those of LcmConnection::publish.
  Expected<void> send(const BorrowedWaterPoints& request);
  Expected<void> resend_points();

  // Waits until a response with at least this seq has arrived, at most until the deadline. Processes messages
  // that have already arrived even if the deadline has passed. Returns false if there is no such response.
  bool wait_for(std::int64_t seq, Clock::time_point deadline);
  // The same for the response to a request for the water at points.
  bool wait_for_samples(std::int64_t seq, Clock::time_point deadline);
  // Waits for the next status of a service. Returns nullptr if none arrives before the deadline.
  const ServiceStatus* wait_for_status(Clock::time_point deadline);
  // The session's responses that arrived since the last wait_for() began, including duplicates and old ones.
  const std::vector<ResponseArrival>& arrivals() const { return inbox_->arrivals; }

  // Makes wait_for() wait for another response to the same request.
  void discard_response() { inbox_->has_response = false; }
  void discard_samples() { inbox_->samples_seq.reset(); }

  bool has_response() const { return inbox_->has_response; }
  const WrenchResponse& latest_response() const { return inbox_->latest; }  // requires has_response()
  // The loads that belong to latest_response(); without bodies unless they are waited for.
  const BodiesLoads& latest_loads() const { return inbox_->latest_loads; }
  const WaterSamples& latest_samples() const { return inbox_->samples; }
  bool waits_for_loads() const { return options_.wait_for_loads; }
  // Messages that were ignored because they are not valid, see ClientStats::malformed.
  std::int64_t malformed() const { return inbox_->malformed; }
  // Warns of the first service that has another scene; nullptr: none has been seen, or none is compared.
  const Warning* scene_warning() const { return inbox_->scene_warning ? &*inbox_->scene_warning : nullptr; }
  // Describes the first two responses to one request that contradict each other; empty: there were none.
  const std::string& contradiction() const { return inbox_->contradiction; }
  bool cancelled() const {
    return (options_.cancelled != nullptr && options_.cancelled->load()) ||
           (options_.is_interrupted && options_.is_interrupted());
  }

  // Explains, as parts of an Error, why the response to the last request, or its loads, may be missing.
  struct Explanation {
    std::string cause, hint;
  };
  Explanation explain_no_response() const;
  // Has the response to the last request arrived, and only its loads are missing?
  bool lacks_only_loads() const { return inbox_->response_seq == inbox_->last_sent; }

  // "udpm://239.255.76.67:7667?ttl=0, channels BUOYANCY_STATES and BUOYANCY_WRENCHES", for errors.
  std::string describe_endpoint() const;
  std::string describe_points_endpoint() const;  // likewise, of the water at points

 private:
  // Has a fixed address, because the connection's handler writes to it.
  struct Inbox {
    bool needs_loads = false;
    std::int64_t session_id = 0;
    std::int64_t last_sent = -1;
    bool has_response = false;
    WrenchResponse latest;
    BodiesLoads latest_loads;
    WrenchResponse incoming;     // reused
    BodiesLoads incoming_loads;  // reused
    // The newest response and loads that wait for each other; nullopt: none is newer than `latest`.
    std::optional<std::int64_t> response_seq, loads_seq;
    WrenchResponse response;
    BodiesLoads loads;
    std::vector<ResponseArrival> arrivals;
    std::int64_t last_points_sent = -1;
    std::optional<std::int64_t> samples_seq;  // of `samples`; nullopt: none has arrived
    WaterSamples samples;
    WaterSamples incoming_samples;  // reused
    std::int64_t malformed = 0;
    std::optional<std::int64_t> scene_fingerprint;
    ServiceStatus status;  // the newest
    std::int64_t statuses = 0;
    std::optional<Warning> scene_warning;
    std::string contradiction;

    void receive(Bytes bytes);
    void receive_loads(Bytes bytes);
    void receive_samples(Bytes bytes);
    void receive_status(Bytes bytes);
    void compare_with_latest();  // incoming, which has the same seq
    bool is_newer(const RequestId& id) const { return !has_response || id.seq > latest.id.seq; }
    void complete();
  };

  LcmRequestChannel(ChannelOptions options, LcmConnection connection);
  // Processes messages until arrived() holds. Returns whether it does.
  template <typename Arrived>
  bool wait_until(const Arrived& arrived, Clock::time_point deadline);
  Expected<void> publish(const std::vector<std::vector<std::uint8_t>>& conditions);  // and the last request

  ChannelOptions options_;
  std::unique_ptr<Inbox> inbox_;
  LcmConnection connection_;
  std::vector<std::uint8_t> request_bytes_;
  std::vector<std::vector<std::uint8_t>> announced_, repeated_;  // encoded
  std::vector<std::uint8_t> points_bytes_;
  bool receives_samples_ = false;  // subscribed to
  std::size_t reserved_bodies_ = 0;
  std::size_t reserved_points_ = 0;
  std::optional<Warning> buffer_warning_;  // of the last reserve()
};

}  // namespace buoyancy
