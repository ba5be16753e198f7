// buoyancy-ping's end of the LCM connection: sends one request at a time and collects whatever comes back for
// it, also what no client accepts: messages that cannot be decoded, and a second, different response.
//
// LcmRequestChannel, which clients use, ignores those. Not thread-safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/termination_signals.h"
#include "messages/sea_state.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "transport/lcm_connection.h"

namespace buoyancy::ping {

using Clock = std::chrono::steady_clock;
using ByteVector = std::vector<std::uint8_t>;

struct LinkOptions {
  std::string lcm_url;  // "": LCM's default, see resolve_lcm_url()
  std::string states_channel{kStatesChannel};
  std::string wrenches_channel{kWrenchesChannel};
  std::string hydrostatics_channel{kHydrostaticsChannel};
  std::string loads_channel{kLoadsChannel};
  std::string sea_channel{kSeaChannel};
  std::string status_channel{kStatusChannel};
};

// The messages about a request, as bytes; empty: not arrived.
struct Reply {
  ByteVector wrenches, hydrostatics, loads;
  Clock::time_point wrenches_at;
};

// The messages of a reply that are waited for; some scenes request no others than wrenches.
struct AwaitedOutputs {
  bool hydrostatics = false;
  bool loads = false;
};

// Messages on the channels of responses that could not be decoded.
struct UndecodableMessages {
  std::int64_t count = 0;
  std::string first_channel;
  DecodeError first_error = DecodeError::kTruncated;
  std::size_t first_size = 0;  // [bytes]
};

// What is known about the service that responds.
struct ServiceInfo {
  std::optional<ServiceStatus> status;     // the newest
  std::vector<std::int64_t> instance_ids;  // distinct, of all statuses; more than one: several services
  std::optional<SeaState> sea;             // the newest that the service published
};

struct LinkStats {
  UndecodableMessages undecodable;
  std::int64_t duplicates = 0;   // further responses to a request with the same bytes, also after a retry
  std::int64_t conflicting = 0;  // further responses to a request with other bytes
};

class ServiceLink {
 public:
  // scene_outputs: those that the scene has at all. Errors: those of LcmConnection::open and subscribe.
  static Expected<ServiceLink> open(const LinkOptions& options, const AwaitedOutputs& scene_outputs);

  // Enlarges the receive buffer for replies of this size [bytes] in total. Returns a warning if the kernel
  // grants less.
  std::optional<Warning> reserve(std::size_t bodies, std::size_t reply_bytes);

  // Publishes a request, or the same bytes again. Replies to it are collected until the next call with
  // another id. Precondition: session_id is constant, and seq counts from 0. Errors: those of
  // LcmConnection::publish.
  Expected<void> send(const RequestId& id, Bytes request);
  Expected<void> send_sea(Bytes sea);

  // Processes messages until the reply holds what is awaited, a signal is pending, or the deadline has
  // passed. Returns whether the reply is complete.
  bool wait_for_reply(const AwaitedOutputs& awaited, Clock::time_point deadline,
                      const TerminationSignals& signals);
  // Processes messages until the service has described itself: by a status and, right after it, a sea. Where
  // no sea is expected, a moment after the status is enough. Ends at the deadline or a pending signal.
  void wait_for_description(bool sea_expected, Clock::time_point deadline, const TerminationSignals& signals);
  // Processes messages until the deadline or a pending signal.
  void wait_until(Clock::time_point deadline, const TerminationSignals& signals);

  const Reply& reply() const { return inbox_->reply; }
  const LinkStats& stats() const { return inbox_->stats; }
  const ServiceInfo& service() const { return inbox_->service; }
  std::int64_t packets_dropped() const { return connection_.drop_counts().packets; }
  const std::string& url() const { return connection_.url(); }

 private:
  // Has a fixed address, because the connection's handlers write to it.
  struct Inbox {
    RequestId id{.utime = 0, .session_id = 0, .seq = -1};  // of the last request
    Reply reply;
    LinkStats stats;
    ServiceInfo service;
    std::vector<std::size_t> hashes;  // of the first response to each seq; 0: none
    WrenchResponse wrenches;          // reused
    BodiesHydrostatics hydrostatics;  // reused
    BodiesLoads loads;                // reused

    void receive_wrenches(Bytes bytes, std::string_view channel);
    void receive_status(Bytes bytes);
    template <typename Message>
    void receive_output(Bytes bytes, std::string_view channel, Message& decoded, ByteVector& into);
    void count_undecodable(Bytes bytes, std::string_view channel, DecodeError error);
    bool is_complete(const AwaitedOutputs& awaited) const;
  };

  ServiceLink(LinkOptions options, LcmConnection connection)
      : options_(std::move(options)), inbox_(std::make_unique<Inbox>()), connection_(std::move(connection)) {}
  Expected<void> subscribe(const AwaitedOutputs& scene_outputs);
  template <typename Done>
  void process_until(Clock::time_point deadline, const TerminationSignals& signals, const Done& done);

  LinkOptions options_;
  std::unique_ptr<Inbox> inbox_;
  LcmConnection connection_;
};

}  // namespace buoyancy::ping
