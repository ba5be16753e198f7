#include "client/ping/service_link.h"

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>
#include <utility>

#include <poll.h>

#include "base/format.h"
#include "transport/message_limits.h"

namespace buoyancy::ping {
namespace {

// Bounds the number of messages read after a deadline: others may publish faster than this program reads.
constexpr int kMaxAfterDeadline = 1000;
// Waiting time after a status for a sea that may not exist: the service sends its sea right after the status.
constexpr std::chrono::milliseconds kBetweenStatusAndSea{50};

timespec to_timespec(Clock::duration duration) {
  const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
  return {static_cast<time_t>(nanoseconds / 1'000'000'000), static_cast<long>(nanoseconds % 1'000'000'000)};
}

// Returns a hash other than 0, which stands for no response.
std::size_t hash_of(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return std::max<std::size_t>(std::hash<std::string_view>{}(text), 1);
}

}  // namespace

void ServiceLink::Inbox::count_undecodable(Bytes bytes, std::string_view channel, DecodeError error) {
  UndecodableMessages& undecodable = stats.undecodable;
  if (undecodable.count++ > 0) return;
  undecodable.first_channel = channel;
  undecodable.first_error = error;
  undecodable.first_size = bytes.size();
}

void ServiceLink::Inbox::receive_wrenches(Bytes bytes, std::string_view channel) {
  if (const std::optional<DecodeError> error = decode(bytes, wrenches)) {
    return count_undecodable(bytes, channel, *error);
  }
  const RequestId& of = wrenches.id;
  if (of.session_id != id.session_id || of.seq < 0 || of.seq > id.seq) return;  // another client's
  std::size_t& first = hashes[static_cast<std::size_t>(of.seq)];
  const std::size_t now = hash_of(bytes);
  if (first != 0) {
    ++(first == now ? stats.duplicates : stats.conflicting);
    return;
  }
  first = now;
  if (of.seq != id.seq) return;  // too late: its request was given up
  reply.wrenches.assign(bytes.begin(), bytes.end());
  reply.wrenches_at = Clock::now();
}

template <typename Message>
void ServiceLink::Inbox::receive_output(Bytes bytes, std::string_view channel, Message& decoded,
                                        ByteVector& into) {
  if (const std::optional<DecodeError> error = decode(bytes, decoded)) {
    return count_undecodable(bytes, channel, *error);
  }
  if (decoded.id.session_id != id.session_id || decoded.id.seq != id.seq || !into.empty()) return;
  into.assign(bytes.begin(), bytes.end());
}

void ServiceLink::Inbox::receive_status(Bytes bytes) {
  ServiceStatus status;
  if (decode(bytes, status)) return;
  std::vector<std::int64_t>& known = service.instance_ids;
  if (std::ranges::find(known, status.instance_id) == known.end()) known.push_back(status.instance_id);
  service.status = std::move(status);
}

bool ServiceLink::Inbox::is_complete(const AwaitedOutputs& awaited) const {
  return !reply.wrenches.empty() && (!awaited.hydrostatics || !reply.hydrostatics.empty()) &&
         (!awaited.loads || !reply.loads.empty());
}

Expected<ServiceLink> ServiceLink::open(const LinkOptions& options, const AwaitedOutputs& scene_outputs) {
  Expected<LcmConnection> connection = LcmConnection::open(options.lcm_url, {.receive_own = false});
  if (!connection) return make_error(connection.error());
  ServiceLink link(options, std::move(*connection));
  if (const Expected<void> subscribed = link.subscribe(scene_outputs); !subscribed) {
    return make_error(subscribed.error());
  }
  return link;
}

Expected<void> ServiceLink::subscribe(const AwaitedOutputs& scene_outputs) {
  Inbox* const inbox = inbox_.get();
  Expected<void> subscribed = connection_.subscribe(
      options_.wrenches_channel,
      [inbox](Bytes bytes, std::string_view channel) { inbox->receive_wrenches(bytes, channel); });
  if (subscribed && scene_outputs.hydrostatics) {
    subscribed =
        connection_.subscribe(options_.hydrostatics_channel, [inbox](Bytes bytes, std::string_view channel) {
          inbox->receive_output(bytes, channel, inbox->hydrostatics, inbox->reply.hydrostatics);
        });
  }
  if (subscribed && scene_outputs.loads) {
    subscribed =
        connection_.subscribe(options_.loads_channel, [inbox](Bytes bytes, std::string_view channel) {
          inbox->receive_output(bytes, channel, inbox->loads, inbox->reply.loads);
        });
  }
  if (subscribed) {
    subscribed = connection_.subscribe(
        options_.status_channel, [inbox](Bytes bytes, std::string_view) { inbox->receive_status(bytes); });
  }
  if (subscribed) {
    subscribed = connection_.subscribe(options_.sea_channel, [inbox](Bytes bytes, std::string_view) {
      SeaState sea;
      if (!decode(bytes, sea)) inbox->service.sea = std::move(sea);
    });
  }
  return subscribed;
}

std::optional<Warning> ServiceLink::reserve(std::size_t bodies, std::size_t reply_bytes) {
  const std::optional<ReceiveBuffer> buffer = connection_.reserve_receive_buffer(reply_bytes);
  if (!buffer) return std::nullopt;
  return receive_buffer_warning("reply for " + pluralize(static_cast<std::int64_t>(bodies), "body", "bodies"),
                                reply_bytes, options_.wrenches_channel, *buffer);
}

Expected<void> ServiceLink::send(const RequestId& id, Bytes request) {
  if (id.seq != inbox_->id.seq) {
    inbox_->id = id;
    inbox_->reply = {};
    inbox_->hashes.resize(static_cast<std::size_t>(id.seq) + 1);
  }
  return connection_.publish(options_.states_channel, request);
}

Expected<void> ServiceLink::send_sea(Bytes sea) {
  return connection_.publish(options_.sea_channel, sea);
}

template <typename Done>
void ServiceLink::process_until(Clock::time_point deadline, const TerminationSignals& signals,
                                const Done& done) {
  int after_deadline = 0;
  while (!done()) {
    const Clock::duration remaining = std::max(deadline - Clock::now(), Clock::duration::zero());
    const bool expired = remaining == Clock::duration::zero();
    if (expired && ++after_deadline > kMaxAfterDeadline) return;
    if (connection_.handle_one_spinning(remaining)) continue;
    if (expired || signals.pending()) return;
    const timespec sleep = to_timespec(remaining);
    std::array<pollfd, 2> readable{pollfd{connection_.fileno(), POLLIN, 0},
                                   pollfd{signals.fileno(), POLLIN, 0}};
    ppoll(readable.data(), readable.size(), &sleep, nullptr);
  }
}

bool ServiceLink::wait_for_reply(const AwaitedOutputs& awaited, Clock::time_point deadline,
                                 const TerminationSignals& signals) {
  process_until(deadline, signals, [this, &awaited] { return inbox_->is_complete(awaited); });
  return inbox_->is_complete(awaited);
}

void ServiceLink::wait_for_description(bool sea_expected, Clock::time_point deadline,
                                       const TerminationSignals& signals) {
  const ServiceInfo& service = inbox_->service;
  process_until(deadline, signals, [&service] { return service.status.has_value(); });
  if (!sea_expected) deadline = std::min(deadline, Clock::now() + kBetweenStatusAndSea);
  process_until(deadline, signals, [&service] { return service.sea.has_value(); });
}

void ServiceLink::wait_until(Clock::time_point deadline, const TerminationSignals& signals) {
  process_until(deadline, signals, [] { return false; });
}

}  // namespace buoyancy::ping
