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

LiveView::LiveView(const Scene& scene, UdpmReceiver receiver, SnapshotHub& hub)
    : receiver_(std::move(receiver)),
      hub_(&hub),
      start_(seconds_now()),
      now_(start_),
      watch_(scene, start_) {}

Expected<LiveView> LiveView::open(const Scene& scene, const std::string& lcm_url,
                                  const WatchedChannels& channels, SnapshotHub& hub) {
  Expected<UdpmReceiver> receiver = UdpmReceiver::open(lcm_url);
  if (!receiver) return tl::unexpected(receiver.error());
  // In the order of which take_in() knows them.
  for (const std::string& channel :
       {channels.states, channels.wrenches, channels.hydrostatics, channels.status}) {
    const Expected<std::size_t> subscribed = receiver->subscribe(channel);
    if (!subscribed) return tl::unexpected(subscribed.error());
  }
  return LiveView(scene, std::move(*receiver), hub);
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
  for (int i = 0; i < kMostAtOnce; ++i) {
    const auto message = receiver_.take(kMostAtOnce);
    if (!message) break;
    const HeardAt arrival{message->arrived, now_};
    switch (message->channel) {
      case 0:
        watch_.hear_question(message->payload, arrival);
        break;
      case 1:
        watch_.hear_answer(message->payload, arrival);
        break;
      case 2:
        watch_.hear_hydrostatics(message->payload);
        break;
      default:
        watch_.hear_status(message->payload, now_);
    }
  }
  watch_.note_losses(receiver_.losses());
}

void LiveView::publish() {
  hub_->publish(history_json(watch_),
                snapshot_json(watch_, ++snapshots_, seconds_since_1970(), now_ - start_, now_));
}

}  // namespace buoyancy
