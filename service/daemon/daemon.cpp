#include "service/daemon/daemon.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <random>
#include <system_error>
#include <utility>

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/timerfd.h>

#include "base/format.h"
#include "base/unique_fd.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "messages/status.h"
#include "service/daemon/counter_warnings.h"

namespace buoyancy {
namespace {

constexpr int kDrainedAtOnce = 4096;  // mode latest, so that a flood cannot keep us from answering
constexpr std::size_t kMaxSessions = RequestHandlerOptions{}.max_sessions;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::int64_t random_id() {
  std::random_device device;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(device()) << 32U | device());
}

std::string in_words(const std::vector<Body>& bodies) {
  return pluralize(static_cast<std::int64_t>(bodies.size()), "body", "bodies");
}

UniqueFd timer_of(std::chrono::microseconds interval) {
  UniqueFd timer(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
  constexpr std::int64_t kPerSecond = 1'000'000;
  const timespec each{interval.count() / kPerSecond, interval.count() % kPerSecond * 1'000};
  const itimerspec periodic{each, each};
  if (timer.valid()) ::timerfd_settime(timer.value(), 0, &periodic, nullptr);
  return timer;
}

// Has the timer run out since the last call?
bool take_expiration(const UniqueFd& timer) {
  std::uint64_t expirations = 0;
  return ::read(timer.value(), &expirations, sizeof expirations) > 0;
}

}  // namespace

std::string_view to_string(ServiceMode mode) {
  return mode == ServiceMode::kLockstep ? "lockstep" : "latest";
}

Daemon::Daemon(std::unique_ptr<const Scene> scene, LcmConnection connection, ServiceMode mode,
               ChannelNames channels, PoseChannels poses, unsigned threads)
    : scene_(std::move(scene)),
      loader_(scene_->name()),
      mode_(mode),
      channels_(std::move(channels)),
      connection_(std::move(connection)),
      handler_(*scene_, {.max_sessions = kMaxSessions, .threads = threads}),
      poses_(std::move(poses), random_id()),
      latest_(kMaxSessions),
      start_(seconds_now()),
      instance_id_(random_id()),
      instances_(instance_id_) {}

Expected<void> Daemon::subscribe() {
  Expected<void> subscribed =
      connection_.subscribe(channels_.states, [this](Bytes request, std::string_view) {
        record_queue_delay();
        on_request(request);
      });
  for (std::size_t i = 0; subscribed && i < poses_.channels().size(); ++i) {
    subscribed = connection_.subscribe(poses_.channels()[i].channel,
                                       [this, i](Bytes pose, std::string_view) { on_pose(i, pose); });
  }
  if (!subscribed) return subscribed;
  return connection_.subscribe(channels_.status,
                               [this](Bytes status, std::string_view) { instances_.observe(status); });
}

Expected<void> Daemon::run(TerminationSignals& termination, SignalFd& reload) {
  const UniqueFd every_second = timer_of(std::chrono::seconds(1));
  // Where no watchdog waits, as rarely as there is no harm in it.
  const auto watchdog = SystemdNotifier::watchdog_interval();
  const UniqueFd watchdog_timer = timer_of(watchdog.value_or(std::chrono::hours(1)));
  std::array<pollfd, 6> waiting{
      pollfd{termination.fileno(), POLLIN, 0},   pollfd{reload.fileno(), POLLIN, 0},
      pollfd{loader_.fileno(), POLLIN, 0},       pollfd{every_second.value(), POLLIN, 0},
      pollfd{watchdog_timer.value(), POLLIN, 0}, pollfd{connection_.fileno(), POLLIN, 0}};
  const auto& [end, hang_up, loaded, second, beat, messages] = waiting;
  if (std::ranges::any_of(waiting, [](const pollfd& one) { return one.fd < 0; })) {
    return make_error({"timers and signals", std::generic_category().message(errno), "a few file descriptors",
                       "too many open files", ""});
  }
  if (Expected<void> subscribed = subscribe(); !subscribed) return subscribed;
  spdlog::info(
      "ready: {}; requests on {}, answers on {}, hydrostatics on {}, status on {}; {}, mode {}, "
      "instance {}",
      in_words(scene_->bodies()), channels_.states, channels_.wrenches, channels_.hydrostatics,
      channels_.status, connection_.url(), to_string(mode_), instance_id_);
  for (const PoseChannel& pose : poses_.channels()) {
    spdlog::info("poses of body {} on {}, answered on {}", pose.body_id, pose.channel,
                 pose.force_torque_channel.empty() ? channels_.wrenches : pose.force_torque_channel);
  }
  report();
  systemd_.ready();

  while (true) {
    const bool at_work = !latest_.empty() || connection_.handle_one_spinning();
    const int forever_or_not_at_all = at_work ? 0 : -1;
    if (::poll(waiting.data(), waiting.size(), forever_or_not_at_all) < 0) {
      if (errno == EINTR) continue;  // a debugger, a stop and go
      return make_error(
          {"waiting for messages", std::generic_category().message(errno), "poll to work", "", ""});
    }
    if (end.revents != 0) break;
    if (hang_up.revents != 0 && reload.consume()) begin_reload();
    if (loaded.revents != 0) end_reload();
    if (second.revents != 0 && take_expiration(every_second)) report();
    if (beat.revents != 0 && take_expiration(watchdog_timer) && watchdog) systemd_.ping_watchdog();
    if (messages.revents != 0) receive();
    response_next_waiting();
  }
  systemd_.stopping();
  report();
  spdlog::info("ended by {}; {}", termination.consume(),
               describe_totals(handler_.counters(), latency_.percentiles()));
  return {};
}

void Daemon::receive() {
  const int most = mode_ == ServiceMode::kLatest ? kDrainedAtOnce : 1;
  for (int received = 0; received < most && connection_.handle_one(); ++received) {
  }
}

void Daemon::record_queue_delay() {
  constexpr double kSecondsPerMicrosecond = 1e-6;
  const std::int64_t waited = utime_now() - connection_.received_utime();
  queue_delay_ = std::max(queue_delay_, static_cast<double>(waited) * kSecondsPerMicrosecond);
}

void Daemon::on_request(Bytes request) {
  if (mode_ == ServiceMode::kLockstep) {
    response(request, seconds_now());
  } else {
    take_in(request, seconds_now());
  }
}

void Daemon::on_pose(std::size_t channel, Bytes pose) {
  record_queue_delay();
  if (const auto request = poses_.make_request(channel, pose)) {
    on_request(*request);
  } else {
    handler_.record_rejected(request.error());
  }
}

void Daemon::take_in(Bytes request, double arrival) {
  const auto key = peek_request_id(request);
  if (!key) {
    response(request, arrival);  // there it is rejected and counted by its cause
    return;
  }
  LatestRequestQueue::PushResult fate = latest_.push(*key, request, arrival);
  if (fate == LatestRequestQueue::PushResult::kFull) {
    response_next_waiting();
    fate = latest_.push(*key, request, arrival);
  }
  if (fate == LatestRequestQueue::PushResult::kReplaced) handler_.record_superseded();
  if (fate == LatestRequestQueue::PushResult::kStale) handler_.record_stale();
}

void Daemon::response_next_waiting() {
  latest_.pop_next([this](Bytes request, double arrival) { response(request, arrival); });
}

void Daemon::response(Bytes request, double arrival) {
  const ServiceCounters& counters = handler_.counters();
  const std::int64_t sessions_before = counters.sessions + counters.sessions_evicted;
  const Bytes bytes = handler_.handle(request);
  if (bytes.empty()) return;
  if (counters.sessions + counters.sessions_evicted != sessions_before) {
    const RequestId key = peek_request_id(request).value();
    spdlog::debug("session {} starts with seq {}", key.session_id, key.seq);
  }
  if (publish_response(bytes)) latency_.add(seconds_now() - arrival);
  if (const Bytes hydrostatics = handler_.last_hydrostatics(); !hydrostatics.empty()) {
    publish(channels_.hydrostatics, hydrostatics);
  }
}

bool Daemon::publish_response(Bytes response) {
  const PoseChannel* const pose = poses_.channel_of_session(handler_.last_session_id());
  if (pose == nullptr || pose->force_torque_channel.empty()) return publish(channels_.wrenches, response);
  encode_force_torque(response, response_, force_torque_bytes_);
  return publish(pose->force_torque_channel, force_torque_bytes_);
}

bool Daemon::publish(const std::string& channel, Bytes bytes) {
  const Expected<void> published = connection_.publish(channel, bytes);
  if (published) return true;
  ++send_failures_;
  warnings_.add({"messages not sent", 1, published.error().message()}, seconds_now());
  return false;
}

void Daemon::begin_reload() {
  if (loader_.is_loading()) spdlog::debug("a load is under way: one more follows it");
  loader_.request();
  systemd_.reloading();
  spdlog::info("SIGHUP: loading {} again; the scene at hand answers until the new one is ready",
               scene_->name());
}

void Daemon::end_reload() {
  std::optional<SceneLoader::Loaded> loaded = loader_.poll();
  if (!loaded) return;
  last_reload_failed_ = !loaded->has_value();
  if (last_reload_failed_) {
    ++reloads_failed_;
    spdlog::error("reload failed, the scene at hand goes on answering: {}", loaded->error().message());
  } else {
    ++reloads_;
    const std::size_t bodies_before = scene_->bodies().size();
    handler_.set_scene(***loaded);
    loader_.release(std::exchange(scene_, std::move(**loaded)));
    spdlog::info("reloaded: {} (before: {}) from {}", in_words(scene_->bodies()), bodies_before,
                 scene_->name());
  }
  if (!loader_.is_loading()) systemd_.ready();
}

void Daemon::report() {
  const ServiceCounters& counters = handler_.counters();
  const DropCounts losses = connection_.drop_counts();
  const double now = seconds_now();
  encode(ServiceStatus{.utime = utime_now(),
                       .instance_id = instance_id_,
                       .version = BUOYANCY_VERSION,
                       .scene = scene_->name(),
                       .uptime = now - start_,
                       .mode = mode_,
                       .simd_target = simd_target_from_name(simd_target()),
                       .threads = static_cast<std::int32_t>(handler_.thread_count()),
                       .scene_bodies = static_cast<std::int32_t>(scene_->bodies().size()),
                       .reloads = reloads_,
                       .reloads_failed = reloads_failed_,
                       .send_failures = send_failures_,
                       .packets_dropped = losses.packets,
                       .fragments_dropped = losses.fragments,
                       .counters = counters,
                       .latency = latency_.percentiles(),
                       .queue_wait = std::exchange(queue_delay_, 0.0)},
         status_bytes_);
  publish(channels_.status, status_bytes_);
  systemd_.status(fmt::format("{}, {} answered{}", in_words(scene_->bodies()),
                              pluralize(counters.computed + counters.retries, "request", "requests"),
                              last_reload_failed_ ? "; the last reload failed, see the log" : ""));
  for (const LogEvent& warning : warnings_since(reported_, counters)) warnings_.add(warning, now);
  for (const LogEvent& warning : warnings_since(reported_losses_, losses)) warnings_.add(warning, now);
  for (const std::string& line : warnings_.drain(now)) spdlog::warn("{}", line);
  for (const std::int64_t other : instances_.take_new()) {
    spdlog::warn(
        "another buoyancyd, instance {}, is on {}: if it also hears {}, every request is answered twice. "
        "Stop one of the two, or give each its own channels",
        other, channels_.status, channels_.states);
  }
  reported_ = counters;
  reported_losses_ = losses;
}

}  // namespace buoyancy
