#include "view/live/live_view.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include <poll.h>
#include <sched.h>
#include <time.h>

#include "view/live/snapshot_json.h"

namespace buoyancy {
namespace {

// How often the kernel's buffer is emptied. Where nobody allowed larger ones it holds 400 kB, which is 20
// messages about a hundred bodies: what comes in 10 ms of a run at 1 kHz.
constexpr double kListeningPeriod = 0.002;  // s
constexpr int kMaxAtOnce = 2'000;           // packets, so that a flood cannot keep the page from being told

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

}  // namespace

void use_idle_scheduling() {
  const sched_param none{};
  ::sched_setscheduler(0, SCHED_IDLE, &none);
}

LiveView::LiveView(const Scene& scene, UdpmReceiver receiver, std::vector<Route> routes, PoseChannels poses,
                   SnapshotBroadcaster& hub)
    : receiver_(std::move(receiver)),
      routes_(std::move(routes)),
      hub_(&hub),
      start_(seconds_now()),
      now_(start_),
      watch_(scene, start_, std::move(poses)) {}

Expected<LiveView> LiveView::open(const Scene& scene, const std::string& lcm_url,
                                  const WatchedChannels& channels, SnapshotBroadcaster& hub) {
  Expected<UdpmReceiver> receiver = UdpmReceiver::open(lcm_url);
  if (!receiver) return tl::unexpected(receiver.error());
  std::vector<std::pair<std::string, Route>> named{{channels.states, {MessageKind::kRequests}},
                                                   {channels.wrenches, {MessageKind::kResponses}},
                                                   {channels.hydrostatics, {MessageKind::kHydrostatics}},
                                                   {channels.status, {MessageKind::kStatus}}};
  std::set<std::string>
      force_torques;  // several channels with poses of one body share its responses' channel
  for (std::size_t i = 0; i < channels.poses.channels.size(); ++i) {
    const PoseChannel& pose = channels.poses.channels[i];
    named.emplace_back(pose.channel, Route{MessageKind::kPoses, i});
    if (!pose.force_torque_channel.empty() && force_torques.insert(pose.force_torque_channel).second) {
      named.emplace_back(pose.force_torque_channel, Route{MessageKind::kForceTorques, i});
    }
  }
  std::vector<Route> routes;
  for (const auto& [channel, route] : named) {
    const Expected<std::size_t> subscribed = receiver->subscribe(channel);
    if (!subscribed) return tl::unexpected(subscribed.error());
    routes.push_back(route);
  }
  return LiveView(scene, std::move(*receiver), std::move(routes), channels.poses, hub);
}

void LiveView::run(const TerminationSignals& termination, const std::function<bool()>& keep_running) {
  constexpr double kPeriod = 1.0 / kSnapshotsPerSecond;
  const timespec sleep = to_timespec(kListeningPeriod);
  double next = seconds_now();
  while (keep_running()) {
    now_ = seconds_now();
    take_in();
    if (now_ >= next) {
      watch_.tick(now_);
      if (hub_->listeners() > 0) publish();
      // On time again, not faster for a while, after the machine had no time for us.
      next = std::max(next + kPeriod, now_);
    }
    pollfd end{termination.fileno(), POLLIN, 0};
    if (::ppoll(&end, 1, &sleep, nullptr) > 0) break;
  }
}

void LiveView::take_in() {
  for (int i = 0; i < kMaxAtOnce; ++i) {
    const auto message = receiver_.receive(kMaxAtOnce);
    if (!message) break;
    hear(routes_[message->channel], message->payload, {message->arrived, now_});
  }
  watch_.record_drops(receiver_.drop_counts());
}

void LiveView::hear(const Route& route, Bytes bytes, ArrivalTime arrival) {
  switch (route.carries) {
    case MessageKind::kRequests:
      return watch_.on_request(bytes, arrival);
    case MessageKind::kResponses:
      return watch_.on_response(bytes, arrival);
    case MessageKind::kHydrostatics:
      return watch_.on_hydrostatics(bytes);
    case MessageKind::kStatus:
      return watch_.on_status(bytes, arrival.now);
    case MessageKind::kPoses:
      return watch_.on_pose(route.index, bytes, arrival);
    case MessageKind::kForceTorques:
      return watch_.on_force_torque(route.index, bytes, arrival);
  }
}

void LiveView::publish() {
  hub_->publish(history_json(watch_),
                snapshot_json(watch_, ++snapshots_, seconds_since_1970(), now_ - start_, now_));
}

}  // namespace buoyancy
