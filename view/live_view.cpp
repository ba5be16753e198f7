#include "view/live_view.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <poll.h>
#include <sched.h>
#include <time.h>

#include "view/snapshot_text.h"

namespace buoyancy {
namespace {

// How often the kernel's buffer is emptied. Where nobody allowed larger ones it holds 400 kB, which is 20
// messages about a hundred bodies: what comes in 10 ms of a run at 1 kHz.
constexpr double kListeningPeriod = 0.002;  // s
constexpr int kMostAtOnce = 2'000;          // packets, so that a flood cannot keep the page from being told

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

void give_way_to_others() {
  const sched_param none{};
  ::sched_setscheduler(0, SCHED_IDLE, &none);
}

LiveView::LiveView(const Scene& scene, BusListener listener, SnapshotHub& hub)
    : listener_(std::move(listener)),
      hub_(&hub),
      start_(seconds_now()),
      now_(start_),
      watch_(scene, start_) {}

Expected<LiveView> LiveView::open(const Scene& scene, const std::string& lcm_url,
                                  const WatchedChannels& channels, SnapshotHub& hub) {
  Expected<BusListener> listener = BusListener::open(
      lcm_url, {channels.states, channels.wrenches, channels.hydrostatics, channels.status});
  if (!listener) return tl::unexpected(listener.error());
  return LiveView(scene, std::move(*listener), hub);
}

void LiveView::run(const TerminationSignals& termination, const std::function<bool()>& goes_on) {
  constexpr double kPeriod = 1.0 / kSnapshotsPerSecond;
  const timespec sleep = to_timespec(kListeningPeriod);
  double next = seconds_now();
  while (goes_on()) {
    now_ = seconds_now();
    take_in();
    if (now_ >= next) {
      watch_.pass_time(now_);
      if (hub_->listeners() > 0) publish();
      // On time again, not faster for a while, after the machine had no time for us.
      next = std::max(next + kPeriod, now_);
    }
    pollfd end{termination.fileno(), POLLIN, 0};
    if (::ppoll(&end, 1, &sleep, nullptr) > 0) break;
  }
}

void LiveView::take_in() {
  listener_.take_in(kMostAtOnce, [this](std::size_t channel, Bytes payload, std::int64_t arrived) {
    switch (channel) {
      case 0:
        return watch_.hear_question(payload, {arrived, now_});
      case 1:
        return watch_.hear_answer(payload, {arrived, now_});
      case 2:
        return watch_.hear_hydrostatics(payload);
      default:
        return watch_.hear_status(payload, now_);
    }
  });
  watch_.note_drops(listener_.packets_dropped(), listener_.fragments_dropped());
}

void LiveView::publish() {
  hub_->publish(history_json(watch_),
                snapshot_json(watch_, ++snapshots_, seconds_since_1970(), now_ - start_, now_));
}

}  // namespace buoyancy
