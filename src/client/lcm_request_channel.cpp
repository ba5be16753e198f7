#include "client/lcm_request_channel.h"

#include <algorithm>
#include <utility>

#include <poll.h>

#include "base/format.h"
#include "base/vec3.h"

namespace buoyancy {
namespace {

// Longest delay until a cancellation that is set just before ppoll() takes effect.
constexpr std::chrono::milliseconds kMaxSleep{100};
// Maximum number of messages processed after the deadline: other senders may publish faster than we can read.
constexpr int kMaxAfterDeadline = 1000;

timespec to_timespec(Clock::duration duration) {
  const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
  return {static_cast<time_t>(nanoseconds / 1'000'000'000), static_cast<long>(nanoseconds % 1'000'000'000)};
}

std::string bodies_text(std::size_t count) {
  return pluralize(static_cast<std::int64_t>(count), "body", "bodies");
}

}  // namespace

void LcmRequestChannel::Inbox::receive(Bytes bytes) {
  if (decode(bytes, incoming)) {
    ++malformed;
    return;
  }
  const RequestId& id = incoming.id;
  if (id.session_id != session_id || id.seq > last_sent) return;
  if (has_response && id.seq == latest.id.seq) compare_with_latest();
  if (!needs_loads || !is_newer(id)) arrivals.push_back({id.seq, Clock::now()});
  if (!is_newer(id)) return;
  if (!needs_loads) {
    std::swap(latest, incoming);
    has_response = true;
  } else if (!response_seq || id.seq >= *response_seq) {
    response_seq = id.seq;
    std::swap(response, incoming);
    complete();
  }
}

void LcmRequestChannel::Inbox::receive_loads(Bytes bytes) {
  if (decode(bytes, incoming_loads)) {
    ++malformed;
    return;
  }
  const RequestId& id = incoming_loads.id;
  if (id.session_id != session_id || id.seq > last_sent || !is_newer(id)) return;
  if (loads_seq && id.seq < *loads_seq) return;
  loads_seq = id.seq;
  std::swap(loads, incoming_loads);
  complete();
}

void LcmRequestChannel::Inbox::receive_samples(Bytes bytes) {
  if (decode(bytes, incoming_samples)) {
    ++malformed;
    return;
  }
  const RequestId& id = incoming_samples.id;
  if (id.session_id != session_id || id.seq > last_points_sent || (samples_seq && id.seq <= *samples_seq)) {
    return;
  }
  samples_seq = id.seq;
  std::swap(samples, incoming_samples);
}

void LcmRequestChannel::Inbox::receive_status(Bytes bytes) {
  if (decode(bytes, status)) return;
  ++statuses;
  if (scene_warning || status.scene_fingerprint == scene_fingerprint.value_or(status.scene_fingerprint))
    return;
  scene_warning = Warning{"the service (instance " + std::to_string(status.instance_id) + ")",
                          "another scene, from its file " + status.scene, "the scene of this program",
                          "another file, or a file or mesh that was changed since the service loaded it",
                          "Give both the same file, and reload the service with SIGHUP after a change"};
}

void LcmRequestChannel::Inbox::compare_with_latest() {
  if (!contradiction.empty() || incoming.bodies.size() != latest.bodies.size()) return;
  for (std::size_t i = 0; i < latest.bodies.size(); ++i) {
    const BodyWrench &a = latest.bodies[i], &b = incoming.bodies[i];
    const Vec3 force_a(a.force.data()), force_b(b.force.data());
    constexpr double kRounding = 1e-9;
    const double bound =
        a.force_error_bound + b.force_error_bound + kRounding * (force_a.norm() + force_b.norm());
    if (a.status == b.status && (force_a - force_b).norm() <= bound) continue;
    // The service has received the sea in between.
    if (a.status == BodyStatus::kNoSea || b.status == BodyStatus::kNoSea) continue;
    contradiction = "two responses to request " + std::to_string(latest.id.seq) + ": body " +
                    std::to_string(a.body_id) + " has " + to_string(a.status) + ", force " +
                    format_vector(force_a, 6) + " N, and " + to_string(b.status) + ", force " +
                    format_vector(force_b, 6) + " N";
    return;
  }
}

void LcmRequestChannel::Inbox::complete() {
  if (!response_seq || response_seq != loads_seq) return;
  arrivals.push_back({*response_seq, Clock::now()});
  std::swap(latest, response);
  std::swap(latest_loads, loads);
  has_response = true;
  response_seq.reset();
  loads_seq.reset();
}

LcmRequestChannel::LcmRequestChannel(ChannelOptions options, LcmConnection connection)
    : options_(std::move(options)), inbox_(std::make_unique<Inbox>()), connection_(std::move(connection)) {}

Expected<LcmRequestChannel> LcmRequestChannel::open(const ChannelOptions& options) {
  Expected<LcmConnection> connection =
      LcmConnection::open(options.lcm_url, {.receive_own = false, .spin = options.spin});
  if (!connection) return make_error(connection.error());
  LcmRequestChannel channel(options, std::move(*connection));
  const Expected<void> subscribed = channel.connection_.subscribe(
      options.wrenches_channel,
      [inbox = channel.inbox_.get()](Bytes bytes, std::string_view /*channel*/) { inbox->receive(bytes); });
  if (!subscribed) return make_error(subscribed.error());
  channel.inbox_->scene_fingerprint = options.scene_fingerprint;
  const Expected<void> with_status = channel.connection_.subscribe(
      options.status_channel, [inbox = channel.inbox_.get()](Bytes bytes, std::string_view /*channel*/) {
        inbox->receive_status(bytes);
      });
  if (!with_status) return make_error(with_status.error());
  if (!options.wait_for_loads) return channel;
  channel.inbox_->needs_loads = true;
  const Expected<void> with_loads = channel.connection_.subscribe(
      options.loads_channel, [inbox = channel.inbox_.get()](Bytes bytes, std::string_view /*channel*/) {
        inbox->receive_loads(bytes);
      });
  if (!with_loads) return make_error(with_loads.error());
  return channel;
}

Expected<void> LcmRequestChannel::check_size(std::size_t bodies) const {
  const std::size_t bytes = request_size(bodies);
  if (!connection_.is_network() || bytes <= kMaxMessageBytes) return {};
  return check_message_size("request for " + bodies_text(bodies), bytes);
}

Expected<std::optional<Warning>> LcmRequestChannel::reserve(std::size_t bodies) {
  if (const Expected<void> checked = check_size(bodies); !checked) return make_error(checked.error());
  reserved_bodies_ = std::max(reserved_bodies_, bodies);
  // The loads follow at once, so that both may have to wait in the buffer.
  const std::size_t bytes = response_size(bodies) + (options_.wait_for_loads ? loads_size(bodies) : 0);
  buffer_warning_.reset();
  if (const std::optional<ReceiveBuffer> buffer = connection_.reserve_receive_buffer(bytes)) {
    const char* const messages = options_.wait_for_loads ? "response with loads for " : "response for ";
    buffer_warning_ =
        receive_buffer_warning(messages + bodies_text(bodies), bytes, options_.wrenches_channel, *buffer);
  }
  return buffer_warning_;
}

LcmRequestChannel::Explanation LcmRequestChannel::explain_no_response() const {
  const std::int64_t dropped = connection_.drop_counts().packets;
  if (buffer_warning_ && dropped > 0) {
    return {"the kernel dropped " + pluralize(dropped, "packet", "packets") +
                " because this program's receive buffer was full; it is too small for the " +
                buffer_warning_->subject,
            buffer_warning_->hint};
  }
  if (lacks_only_loads()) {
    return {
        "the response arrived without loads: no body of the request has them among its outputs, or "
        "buoyancyd publishes them on another channel",
        "Set outputs = [\"wrench\", \"loads\"] for a body in buoyancyd's scene, and use the same loads "
        "channel"};
  }
  Explanation explanation{
      "no buoyancyd is running on this LCM URL and these channels, or it rejects the requests",
      "Start buoyancyd with the same scene, URL and channels; if it is still loading its meshes, allow more "
      "retries"};
  constexpr std::size_t kMaxPacketsInAnyBuffer = 3;  // of the kernel's default size
  const std::size_t packets = packet_count(request_bytes_.size(), options_.states_channel);
  if (packets > kMaxPacketsInAnyBuffer) {
    explanation.cause += ", or its receive buffer is too small for a request of " +
                         std::to_string(request_bytes_.size()) + " bytes in " + std::to_string(packets) +
                         " packets";
    explanation.hint += "; if it is running, see its log, which says what its receive buffer holds";
  }
  return explanation;
}

Expected<void> LcmRequestChannel::send(const BorrowedRequest& request) {
  if (request.bodies.size() > reserved_bodies_) {
    if (const auto reserved = reserve(request.bodies.size()); !reserved) return make_error(reserved.error());
  }
  inbox_->session_id = request.id.session_id;
  inbox_->last_sent = request.id.seq;
  encode(request, request_bytes_);
  return publish(announced_);
}

Expected<void> LcmRequestChannel::resend() {
  return publish(repeated_);
}

Expected<void> LcmRequestChannel::check_points(std::size_t points) const {
  const std::size_t bytes = water_samples_size(points);
  if (!connection_.is_network() || bytes <= kMaxMessageBytes) return {};
  return check_message_size("water at " + std::to_string(points) + " points", bytes);
}

Expected<void> LcmRequestChannel::send(const BorrowedWaterPoints& request) {
  const std::size_t points = request.points.size();
  if (Expected<void> checked = check_points(points); !checked) return checked;
  if (!receives_samples_) {
    Expected<void> subscribed = connection_.subscribe(
        options_.water_samples_channel,
        [inbox = inbox_.get()](Bytes bytes, std::string_view /*channel*/) { inbox->receive_samples(bytes); });
    if (!subscribed) return subscribed;
    receives_samples_ = true;
  }
  if (points > reserved_points_) {
    connection_.reserve_receive_buffer(water_samples_size(points));
    reserved_points_ = points;
  }
  inbox_->session_id = request.id.session_id;
  inbox_->last_points_sent = request.id.seq;
  encode(request, points_bytes_);
  return resend_points();
}

Expected<void> LcmRequestChannel::resend_points() {
  return connection_.publish(options_.water_points_channel, points_bytes_);
}

Expected<void> LcmRequestChannel::publish(const std::vector<std::vector<std::uint8_t>>& conditions) {
  for (const std::vector<std::uint8_t>& bytes : conditions) {
    if (Expected<void> sent = connection_.publish(options_.condition_channel, bytes); !sent) return sent;
  }
  return connection_.publish(options_.states_channel, request_bytes_);
}

void LcmRequestChannel::set_conditions(std::span<const ConditionChange> announced,
                                       std::span<const ConditionChange> repeated) {
  const auto encode_all = [](std::span<const ConditionChange> changes,
                             std::vector<std::vector<std::uint8_t>>& encoded) {
    encoded.resize(changes.size());
    for (std::size_t i = 0; i < changes.size(); ++i) encode(changes[i], encoded[i]);
  };
  encode_all(announced, announced_);
  encode_all(repeated, repeated_);
}

template <typename Arrived>
bool LcmRequestChannel::wait_until(const Arrived& arrived, Clock::time_point deadline) {
  int after_deadline = 0;
  while (!arrived()) {
    const Clock::duration remaining = std::max(deadline - Clock::now(), Clock::duration::zero());
    const bool expired = remaining == Clock::duration::zero();
    if (expired && ++after_deadline > kMaxAfterDeadline) return false;
    if (connection_.handle_one_spinning(remaining)) continue;
    if (expired || cancelled()) return false;
    const timespec sleep = to_timespec(std::min<Clock::duration>(remaining, kMaxSleep));
    pollfd readable{connection_.fileno(), POLLIN, 0};
    ppoll(&readable, 1, &sleep, nullptr);
  }
  return true;
}

bool LcmRequestChannel::wait_for(std::int64_t seq, Clock::time_point deadline) {
  inbox_->arrivals.clear();
  return wait_until([&] { return inbox_->has_response && inbox_->latest.id.seq >= seq; }, deadline);
}

bool LcmRequestChannel::wait_for_samples(std::int64_t seq, Clock::time_point deadline) {
  return wait_until([&] { return inbox_->samples_seq && *inbox_->samples_seq >= seq; }, deadline);
}

const ServiceStatus* LcmRequestChannel::wait_for_status(Clock::time_point deadline) {
  const std::int64_t before = inbox_->statuses;
  return wait_until([&] { return inbox_->statuses > before; }, deadline) ? &inbox_->status : nullptr;
}

std::string LcmRequestChannel::describe_endpoint() const {
  const std::string& wrenches = options_.wrenches_channel;
  return connection_.url() + ", channels " + options_.states_channel +
         (options_.wait_for_loads ? ", " + wrenches + " and " + options_.loads_channel : " and " + wrenches);
}

std::string LcmRequestChannel::describe_points_endpoint() const {
  return connection_.url() + ", channels " + options_.water_points_channel + " and " +
         options_.water_samples_channel;
}

}  // namespace buoyancy
