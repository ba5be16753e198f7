#include "view/live/live_view.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include <poll.h>
#include <sched.h>
#include <time.h>

#include "base/format.h"
#include "transport/message_limits.h"
#include "view/common/sea_json.h"
#include "view/live/snapshot_json.h"

namespace buoyancy::view {
namespace {

// The kernel's receive buffer is drained this often. Its default limit is 400 kB: 20 messages about 100
// bodies, which arrive within 10 ms of a run at 1 kHz.
constexpr double kReceivePeriod = 0.002;    // [s]
constexpr int kMaxPacketsPerDrain = 2'000;  // limits the delay of snapshots under a flood

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

timespec to_timespec(double seconds) {
  const auto whole = static_cast<time_t>(seconds);
  return {whole, static_cast<long>(1e9 * (seconds - static_cast<double>(whole)))};
}

// Returns the total size [bytes] of the request, response, hydrostatics and loads of all bodies. They may all
// arrive before the first is read.
std::size_t largest_step(const Scene& scene) {
  const std::size_t bodies = scene.bodies().size();
  const std::size_t with_hydrostatics = scene.bodies_with_hydrostatics();
  const std::size_t with_loads = scene.bodies_with_loads();
  return request_size(bodies) + response_size(bodies) +
         (with_hydrostatics > 0 ? hydrostatics_size(with_hydrostatics) : 0) +
         (with_loads > 0 ? loads_size(with_loads) : 0);
}

std::optional<Warning> step_warning(const Scene& scene, std::size_t bytes, const ReceiveBuffer& buffer) {
  if (bytes <= buffer.max_message) return std::nullopt;
  const BufferLimit limit = buffer_limit(buffer, bytes);
  return Warning{"the messages of a step of all " +
                     pluralize(static_cast<std::int64_t>(scene.bodies().size()), "body", "bodies"),
                 std::to_string(bytes) + " bytes, some of which may not reach this view",
                 "at most " + std::to_string(buffer.max_message) +
                     " bytes, which the kernel's receive buffer holds until they are read",
                 limit.cause,
                 "To show every step, " + limit.remedy + "; service and clients are not affected"};
}

}  // namespace

void use_idle_scheduling() {
  const sched_param none{};
  ::sched_setscheduler(0, SCHED_IDLE, &none);
}

LiveView::LiveView(const Scene& scene, UdpmReceiver receiver, std::vector<Route> routes, PoseChannels poses,
                   SnapshotBroadcaster& broadcaster)
    : receiver_(std::move(receiver)),
      routes_(std::move(routes)),
      broadcaster_(&broadcaster),
      start_(seconds_now()),
      now_(start_),
      monitor_(scene, start_, std::move(poses)),
      receives_sea_(scene.receives_sea()) {}

Expected<LiveView> LiveView::open(const Scene& scene, const std::string& lcm_url,
                                  const ObservedChannels& channels, SnapshotBroadcaster& broadcaster) {
  Expected<UdpmReceiver> receiver = UdpmReceiver::open(lcm_url);
  if (!receiver) return tl::unexpected(receiver.error());
  const std::size_t bytes_per_step = largest_step(scene);
  receiver->reserve(bytes_per_step);
  std::vector<std::pair<std::string, Route>> subscriptions{
      {channels.states, {MessageKind::kRequest}},
      {channels.wrenches, {MessageKind::kResponse}},
      {channels.hydrostatics, {MessageKind::kHydrostatics}},
      {channels.loads, {MessageKind::kLoads}},
      {channels.status, {MessageKind::kStatus}}};
  if (scene.receives_sea()) {
    subscriptions.emplace_back(scene.receives_grids() ? channels.sea_grid : channels.sea,
                               Route{MessageKind::kSea});
  }
  if (scene.bodies_with_subdivision() > 0) {
    subscriptions.emplace_back(channels.condition, Route{MessageKind::kCondition});
  }
  // Several pose channels of one body may share its force-torque channel.
  std::set<std::string> force_torque_channels;
  for (std::size_t i = 0; i < channels.poses.channels.size(); ++i) {
    const PoseChannel& pose = channels.poses.channels[i];
    subscriptions.emplace_back(pose.channel, Route{MessageKind::kPose, i});
    if (!pose.force_torque_channel.empty() &&
        force_torque_channels.insert(pose.force_torque_channel).second) {
      subscriptions.emplace_back(pose.force_torque_channel, Route{MessageKind::kForceTorque, i});
    }
  }
  std::vector<Route> routes;
  for (const auto& [channel, route] : subscriptions) {
    const Expected<std::size_t> subscribed = receiver->subscribe(channel);
    if (!subscribed) return tl::unexpected(subscribed.error());
    routes.push_back(route);
  }
  std::optional<Warning> warning = step_warning(scene, bytes_per_step, receiver->receive_buffer());
  LiveView view(scene, std::move(*receiver), std::move(routes), channels.poses, broadcaster);
  view.buffer_warning_ = std::move(warning);
  return view;
}

void LiveView::run(const TerminationSignals& termination, const std::function<bool()>& keep_running) {
  constexpr double kPeriod = 1.0 / kSnapshotsPerSecond;
  const timespec sleep = to_timespec(kReceivePeriod);
  double next = seconds_now();
  while (keep_running()) {
    now_ = seconds_now();
    drain();
    if (now_ >= next) {
      monitor_.tick(now_);
      if (broadcaster_->listeners() > 0) publish();
      if (metrics_ != nullptr) update_metrics();
      // Snapshots that were missed during a delay are skipped.
      next = std::max(next + kPeriod, now_);
    }
    pollfd terminated{termination.fileno(), POLLIN, 0};
    if (::ppoll(&terminated, 1, &sleep, nullptr) > 0) break;
  }
}

void LiveView::update_metrics() {
  constexpr double kInterval = 0.5;  // [s], half of that of the status
  if (now_ < next_metrics_) return;
  next_metrics_ = now_ + kInterval;
  const std::optional<double> received = monitor_.status_received();
  const bool is_current = received && now_ - *received <= BusMonitor::kStatusTimeout;
  metrics_->set(metrics_text(is_current ? &*monitor_.status() : nullptr));
}

void LiveView::drain() {
  for (int i = 0; i < kMaxPacketsPerDrain; ++i) {
    const auto message = receiver_.receive(kMaxPacketsPerDrain);
    if (!message) break;
    dispatch(routes_[message->channel], message->payload, {message->arrived, now_});
  }
  monitor_.record_drops(receiver_.drop_counts());
}

void LiveView::dispatch(const Route& route, Bytes bytes, ArrivalTime arrival) {
  switch (route.kind) {
    case MessageKind::kRequest:
      return monitor_.on_request(bytes, arrival);
    case MessageKind::kResponse:
      return monitor_.on_response(bytes, arrival);
    case MessageKind::kHydrostatics:
      return monitor_.on_hydrostatics(bytes);
    case MessageKind::kLoads:
      return monitor_.on_loads(bytes);
    case MessageKind::kStatus:
      return monitor_.on_status(bytes, arrival.now);
    case MessageKind::kSea:
      return monitor_.on_sea(bytes);
    case MessageKind::kCondition:
      return monitor_.on_condition(bytes);
    case MessageKind::kPose:
      return monitor_.on_pose(route.index, bytes, arrival);
    case MessageKind::kForceTorque:
      return monitor_.on_force_torque(route.index, bytes, arrival);
  }
}

void LiveView::publish_surface(const SeaPeriod& sea, const RequestTime& time) {
  if (time == surface_time_ || now_ < next_surface_) return;
  surface_time_ = time;
  sea_text_ = std::make_shared<const std::string>(surface_json(sea, time.utime, time.lead_time).dump());
  next_surface_ = now_ + static_cast<double>(sea_text_->size()) / kSurfaceBytesPerSecond;
}

void LiveView::publish() {
  if (receives_sea_) {
    const std::shared_ptr<const SeaPeriod> sea = monitor_.sea_period();
    if (sea && monitor_.scene().receives_grids()) {
      publish_surface(*sea, *monitor_.request_time());
    } else if (sea && sea != sea_) {
      sea_ = sea;
      sea_text_ = std::make_shared<const std::string>(sea_json(*sea).dump());
    }
  }
  broadcaster_->publish(history_json(monitor_),
                        snapshot_json(monitor_, ++snapshots_, seconds_since_1970(), now_ - start_, now_),
                        sea_text_);
}

}  // namespace buoyancy::view
