#include "service/daemon/daemon.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>
#include <random>
#include <span>
#include <system_error>
#include <utility>

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/timerfd.h>

#include "base/format.h"
#include "base/unique_fd.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "messages/sea_state.h"
#include "messages/status.h"
#include "scene/mesh_warnings.h"
#include "scene/scene_fingerprint.h"
#include "service/daemon/budgets.h"
#include "service/daemon/counter_warnings.h"
#include "service/daemon/message_sizes.h"
#include "waves/sea_report.h"

namespace buoyancy::service {
namespace {

constexpr int kMaxDrained = 4096;  // mode latest: bounds the time that a flood delays the responses
constexpr int kIgnored = -1;       // a descriptor that poll() skips
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kMaxWait = 3600.0;  // [s]
// Two grids of the sea of 1024 x 1024 samples, or many usual ones.
constexpr std::size_t kUsualGridBytes = std::size_t{8} << 20U;
constexpr std::size_t kMaxSessions = RequestHandlerOptions{}.max_sessions;

Deadline end_of_slice() {
  return std::chrono::steady_clock::now() + kSlice;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::int64_t random_id() {
  std::random_device device;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(device()) << 32U | device());
}

std::string format_body_count(const std::vector<Body>& bodies) {
  return pluralize(static_cast<std::int64_t>(bodies.size()), "body", "bodies");
}

UniqueFd make_timer(std::chrono::microseconds interval) {
  UniqueFd timer(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
  constexpr std::int64_t kPerSecond = 1'000'000;
  const timespec period{interval.count() / kPerSecond, interval.count() % kPerSecond * 1'000};
  const itimerspec periodic{period, period};
  if (timer.valid()) ::timerfd_settime(timer.value(), 0, &periodic, nullptr);
  return timer;
}

// Has the timer expired since the last call?
bool consume_expiration(const UniqueFd& timer) {
  std::uint64_t expirations = 0;
  return ::read(timer.value(), &expirations, sizeof expirations) > 0;
}

// Calls poll(2) with a time limit in seconds, of which at most kMaxWait is used; kForever: no limit.
int poll_for(std::span<pollfd> descriptors, double seconds) {
  constexpr int kNoLimit = -1;
  if (seconds == 0.0) return ::poll(descriptors.data(), descriptors.size(), 0);
  if (seconds == kForever) return ::poll(descriptors.data(), descriptors.size(), kNoLimit);
  constexpr double kNanosecondsPerSecond = 1e9;
  const double whole = std::floor(std::min(seconds, kMaxWait));
  const double fraction = std::min(seconds, kMaxWait) - whole;
  // Rounded up: a wait that ends early would be followed by another one.
  const timespec limit{static_cast<time_t>(whole),
                       std::min(std::lround(std::ceil(fraction * kNanosecondsPerSecond)), 999'999'999L)};
  return ::ppoll(descriptors.data(), descriptors.size(), &limit, nullptr);
}

void log_warnings(const Scene& scene) {
  for (const Warning& warning : mesh_warnings(scene)) spdlog::warn("{}", warning.message());
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
      handler_(*scene_, {.max_sessions = kMaxSessions, .threads = threads, .budgets = kBudgets}),
      poses_(std::move(poses), random_id()),
      latest_(kMaxSessions, kMaxWaitingBytes),
      waiting_(kMaxWaiting, kMaxWaitingBytes),
      start_(seconds_now()),
      instance_id_(random_id()),
      scene_fingerprint_(scene_fingerprint(*scene_)),
      instances_(instance_id_),
      reported_without_velocities_(poses_.channels().size()) {
  arrivals_.reserve(RequestHandler::kMaxInProgress);
}

void Daemon::inject_faults(const FaultOptions& options) {
  faults_.emplace(options, seconds_now(), [this](const Reply& reply) { publish_reply(reply); });
  spdlog::warn(
      "injecting faults on purpose: {}; responses are lost, late or corrupted. This is for tests of clients: "
      "never use it in production, and start the service without --inject to stop it",
      to_string(options));
}

bool Daemon::is_stalled() const {
  return faults_ && faults_->is_stalled(seconds_now());
}

Expected<void> Daemon::subscribe() {
  const auto subscribe_to_requests = [this](const std::string& channel, RequestKind kind) {
    return connection_.subscribe(channel, [this, kind](Bytes request, std::string_view) {
      record_queue_delay();
      guard([&] { on_request(kind, request); });
    });
  };
  Expected<void> subscribed = subscribe_to_requests(channels_.states, RequestKind::kBodies);
  if (subscribed) subscribed = subscribe_to_requests(channels_.water_points, RequestKind::kWaterPoints);
  for (std::size_t i = 0; subscribed && i < poses_.channels().size(); ++i) {
    subscribed = connection_.subscribe(poses_.channels()[i].channel, [this, i](Bytes pose, std::string_view) {
      guard([&] { on_pose(i, pose); });
    });
  }
  if (!subscribed) return subscribed;
  subscribed = connection_.subscribe(
      channels_.sea, [this](Bytes message, std::string_view) { guard([&] { on_sea(message); }); });
  if (subscribed) subscribed = subscribe_to_grids();
  if (subscribed) subscribed = subscribe_to_conditions();
  if (!subscribed) return subscribed;
  return connection_.subscribe(channels_.status, [this](Bytes status, std::string_view) {
    guard([&] { instances_.observe(status); });
  });
}

Expected<void> Daemon::subscribe_to_grids() {
  if (grids_ || !scene_->receives_grids()) return {};
  grids_.emplace();
  return connection_.subscribe(channels_.sea_grid,
                               [this](Bytes message, std::string_view) { guard([&] { on_grid(message); }); });
}

Expected<void> Daemon::subscribe_to_conditions() {
  if (receives_conditions_ || scene_->bodies_with_subdivision() == 0) return {};
  receives_conditions_ = true;
  return connection_.subscribe(channels_.condition, [this](Bytes message, std::string_view) {
    guard([&] { on_condition(message); });
  });
}

void Daemon::prepare_for_messages() {
  sea_bytes_.clear();
  if (const Sea* const sea = scene_->sea()) {
    encode(to_sea_state(*sea, instance_id_), sea_bytes_);
    for (const Warning& warning : sea_warnings(scene_->name(), *sea, scene_->wave_systems())) {
      spdlog::warn("{}", warning.message());
    }
  }
  const LargestMessages messages = largest_messages(*scene_, channels_);
  const std::size_t request_bytes = std::min(messages.request.bytes, kMaxMessageBytes);
  const std::size_t grid_bytes = scene_->receives_grids() ? kUsualGridBytes : 0;
  const auto buffer = connection_.reserve_receive_buffer(std::max(request_bytes, grid_bytes));
  if (!buffer) return;
  receive_buffer_limit_ = buffer_limit(*buffer, request_bytes);
  for (const Warning& warning : size_warnings(messages, *buffer)) spdlog::warn("{}", warning.message());
}

Expected<void> Daemon::run(TerminationSignals& termination, SignalFd& reload) {
  const UniqueFd status_timer = make_timer(std::chrono::seconds(1));
  // Without a watchdog the timer is not needed: its interval is long enough to cost nothing.
  const auto watchdog = SystemdNotifier::watchdog_interval();
  const UniqueFd watchdog_timer = make_timer(watchdog.value_or(std::chrono::hours(1)));
  if (Expected<void> subscribed = subscribe(); !subscribed) return subscribed;
  std::array<pollfd, 7> descriptors{pollfd{grids_ ? grids_->fileno() : termination.fileno(), POLLIN, 0},
                                    pollfd{termination.fileno(), POLLIN, 0},
                                    pollfd{reload.fileno(), POLLIN, 0},
                                    pollfd{loader_.fileno(), POLLIN, 0},
                                    pollfd{status_timer.value(), POLLIN, 0},
                                    pollfd{watchdog_timer.value(), POLLIN, 0},
                                    pollfd{connection_.fileno(), POLLIN, 0}};
  const auto& [grids_ready, stop_signal, reload_signal, loaded, status_due, watchdog_due, messages] =
      descriptors;
  if (std::ranges::any_of(descriptors, [](const pollfd& descriptor) { return descriptor.fd < 0; })) {
    return make_error({"timers and signals", std::generic_category().message(errno), "a few file descriptors",
                       "too many open files", ""});
  }
  prepare_for_messages();
  spdlog::info(
      "ready: {}; requests on {}, responses on {}, hydrostatics on {}, loads on {}, status on {}; {}, mode "
      "{}, "
      "instance {}",
      format_body_count(scene_->bodies()), channels_.states, channels_.wrenches, channels_.hydrostatics,
      channels_.loads, channels_.status, connection_.url(), to_string(mode_), instance_id_);
  for (const PoseChannel& pose : poses_.channels()) {
    spdlog::info("poses of body {} on {}, responses on {}", pose.body_id, pose.channel,
                 pose.force_torque_channel.empty() ? channels_.wrenches : pose.force_torque_channel);
  }
  if (grids_) spdlog::info("grids of the sea on {}", channels_.sea_grid);
  spdlog::info("the water at points: requests on {}, responses on {}", channels_.water_points,
               channels_.water_samples);
  if (receives_conditions_) {
    spdlog::info("conditions of compartments and tanks on {}", channels_.condition);
  }
  log_warnings(*scene_);
  publish_status();
  systemd_.ready();

  bool has_worked = false;
  while (true) {
    const bool stalled = is_stalled();
    if (faults_) descriptors.back().fd = stalled ? kIgnored : connection_.fileno();
    descriptors.front().fd = grids_ ? grids_->fileno() : kIgnored;
    const bool works = has_work() && !stalled;
    bool handled = false;
    if (latest_.empty() && !works && !stalled) handled = connection_.handle_one_spinning();
    double max_wait = faults_ ? faults_->wait(seconds_now()) : kForever;
    if (handled || works || (!latest_.empty() && !stalled)) max_wait = 0.0;
    if (poll_for(descriptors, max_wait) < 0) {
      if (errno == EINTR) continue;  // interrupted, e.g. by SIGSTOP/SIGCONT or a debugger
      return make_error(
          {"waiting for messages", std::generic_category().message(errno), "poll() to succeed", "", ""});
    }
    if (stop_signal.revents != 0) break;
    if (reload_signal.revents != 0 && reload.consume()) begin_reload();
    if (loaded.revents != 0) guard([this] { end_reload(); });
    if (grids_ready.revents != 0) guard([this] { take_grids(); });
    if (status_due.revents != 0 && consume_expiration(status_timer)) guard([&] { publish_status(); });
    if (watchdog_due.revents != 0 && consume_expiration(watchdog_timer) && watchdog) systemd_.ping_watchdog();
    if (faults_) faults_->send_due(seconds_now());
    has_worked = works && !has_worked;
    guard([this, has_worked, have_arrived = messages.revents != 0] {
      if (has_worked) {
        work();
      } else {
        handle_messages(have_arrived);
      }
    });
  }
  systemd_.stopping();
  if (handler_.in_progress() > 0) {
    spdlog::warn("not answered, because they take several slices of time: {}",
                 pluralize(static_cast<std::int64_t>(handler_.in_progress()), "request", "requests"));
  }
  if (faults_) faults_->send_all();
  publish_status();
  spdlog::info("received {}, exiting; {}", termination.consume(),
               describe_totals(handler_.counters(), latency_.percentiles()));
  if (faults_) {
    spdlog::warn("injected faults ({}): {}", to_string(faults_->options()),
                 describe_faults(faults_->counters(seconds_now())));
  }
  return {};
}

template <typename Task>
void Daemon::guard(const Task& task) {
  try {
    task();
  } catch (const std::bad_alloc&) {
    handler_.record_no_memory();
  }
}

void Daemon::handle_messages(bool have_arrived) {
  const bool works = has_work();
  const Deadline end = end_of_slice();
  const int max_messages = mode_ == ServiceMode::kLatest || works ? kMaxDrained : 1;
  for (int received = 0; have_arrived && received < max_messages && connection_.handle_one(); ++received) {
    if (has_passed(end)) break;
  }
  while (handle_next() && works && !has_passed(end)) {
  }
}

bool Daemon::has_work() const {
  if (handler_.in_progress() > 0) return true;
  return !waiting_.empty() && (!grids_ || waiting_.first_arrival() < grids_->first_arrival());
}

bool Daemon::may_take_long(const SessionKey& session) const {
  using Pace = RequestHandler::Pace;
  const Pace pace = handler_.pace_of(session);
  return pace == Pace::kSeveralSlices || (pace == Pace::kUnknown && handler_.has_room_for(session));
}

void Daemon::work() {
  const double first_grid = grids_ ? grids_->first_arrival() : kForever;
  const auto has_room = [this, first_grid](const SessionKey& session, double arrival) {
    return handler_.has_room_for(session) && arrival < first_grid;
  };
  if (waiting_.pop_next(has_room,
                        [this](Bytes request, double arrival) { handle(request, arrival, false); })) {
    return;
  }
  const SessionKey session = handler_.next_session();
  const RequestHandler::Step step = handler_.resume(end_of_slice());
  if (step == RequestHandler::Step::kStarted) return;
  const auto arrival = std::ranges::find(arrivals_, session, &Arrival::session);
  const double time = arrival->time;
  arrivals_.erase(arrival);
  if (step == RequestHandler::Step::kAnswered) send_reply(time);
}

void Daemon::record_queue_delay() {
  constexpr double kSecondsPerMicrosecond = 1e-6;
  const std::int64_t delay = utime_now() - connection_.received_utime();
  queue_delay_ = std::max(queue_delay_, static_cast<double>(delay) * kSecondsPerMicrosecond);
}

void Daemon::on_request(RequestKind kind, Bytes request) {
  const auto header = peek_request(request);
  if (header && header->kind != kind) return handler_.record_rejected(DecodeError::kFingerprint);
  if (mode_ == ServiceMode::kLatest) return enqueue(request, seconds_now());
  const bool awaits_grid = grids_ && grids_->is_busy();
  if (header && (awaits_grid || has_work())) {
    const SessionKey session = header->session();
    const bool waits = (awaits_grid || waiting_.contains(session) || may_take_long(session)) &&
                       !handler_.is_retry(session, request);
    if (waits) return wait(request, seconds_now());
  }
  handle(request, seconds_now(), true);
}

void Daemon::on_pose(std::size_t channel, Bytes pose) {
  record_queue_delay();
  if (const auto request = poses_.make_request(channel, pose)) {
    on_request(RequestKind::kBodies, *request);
  } else {
    handler_.record_rejected(request.error());
  }
}

void Daemon::on_sea(Bytes message) {
  if (!scene_->receives_sea()) return;  // the message may be this service's own
  if (const Expected<void> received = handler_.receive_sea(message); !received) {
    return warn_of_rejected_sea(received.error());
  }
  std::shared_ptr<const SeaPeriod> sea = handler_.newest_sea();
  if (sea == newest_sea_) return;
  newest_sea_ = std::move(sea);
  if (newest_sea_->sea == nullptr) return;
  std::string detail;
  for (const Warning& warning : sea_warnings("received", *newest_sea_->sea, {})) {
    if (!detail.empty()) detail += ' ';
    detail += warning.message();
  }
  if (!detail.empty())
    warnings_.add({"seas received that are too high or too steep", 1, detail}, seconds_now());
}

void Daemon::warn_of_rejected_sea(const Error& error) {
  warnings_.add({"messages of the sea rejected", 1, error.message()}, seconds_now());
}

void Daemon::on_grid(Bytes message) {
  if (!scene_->receives_grids()) return;  // an earlier scene did
  const auto header = peek_sea_grid(message);
  const bool is_small = !header || message.size() < sea_grid_size(1, GridPreparer::kMinSamples);
  if (is_small && !grids_->is_busy()) {
    const Expected<void> received = handler_.receive_sea(message);
    if (!received) warn_of_rejected_sea(received.error());
    return;
  }
  if (header && grids_->push(*header, message, handler_.spare_surface(), seconds_now())) return;
  handler_.record_rejected_sea();
  warn_of_rejected_sea(
      {channels_.sea_grid,
       header ? "grids that arrive faster than they can be prepared" : to_string(header.error()),
       header ? "25 ns per sample" : "the bytes of a sea_grid_t of this version", "",
       header ? "Send smaller grids, around the bodies, or fewer" : ""});
}

void Daemon::take_grids() {
  while (std::optional<GridPreparer::Prepared> grid = grids_->poll()) {
    if (!grid->surface) {
      handler_.record_rejected_sea();
      warn_of_rejected_sea(grid->surface.error());
    } else if (scene_->receives_grids()) {
      handler_.receive_surface(grid->header, *std::move(grid->surface));
    }
  }
}

void Daemon::on_condition(Bytes message) {
  if (scene_->bodies_with_subdivision() == 0) return;  // an earlier scene had compartments or tanks
  if (const Expected<void> received = handler_.receive_condition(message); !received) {
    warnings_.add({"conditions rejected", 1, received.error().message()}, seconds_now());
  }
}

void Daemon::enqueue(Bytes request, double arrival) {
  const auto header = peek_request(request);
  if (!header) {
    handle(request, arrival, false);  // rejects it and counts the cause
    return;
  }
  LatestRequestQueue::PushResult result = latest_.push(*header, request, arrival);
  if (result == LatestRequestQueue::PushResult::kFull) {
    handle_next();
    result = latest_.push(*header, request, arrival);
  }
  if (result == LatestRequestQueue::PushResult::kReplaced) handler_.record_superseded();
  if (result == LatestRequestQueue::PushResult::kStale) handler_.record_stale();
  if (result == LatestRequestQueue::PushResult::kFull) handler_.record_busy();
}

bool Daemon::handle_next() {
  return latest_.pop_next(
      [this, works = has_work()](const SessionKey& session) {
        return handler_.has_room_for(session) && !(works && may_take_long(session));
      },
      [this](Bytes request, double arrival) { handle(request, arrival, false); });
}

void Daemon::wait(Bytes request, double arrival) {
  switch (waiting_.push(peek_request(request).value().session(), request, arrival)) {
    case WaitingRequests::PushResult::kQueued:
      break;
    case WaitingRequests::PushResult::kRetry:
      handler_.record_retry();
      break;
    case WaitingRequests::PushResult::kFull:
      handler_.record_busy();
      break;
  }
}

void Daemon::handle(Bytes request, double arrival, bool may_wait) {
  using Step = RequestHandler::Step;
  const ServiceCounters& counters = handler_.counters();
  const std::int64_t sessions_before = counters.sessions + counters.sessions_evicted;
  const Step step = handler_.begin(request, end_of_slice());
  if (step == Step::kRejected) return;
  if (step == Step::kBusy && may_wait) return wait(request, arrival);
  if (step == Step::kBusy) return handler_.record_busy();
  const bool is_new = counters.sessions + counters.sessions_evicted != sessions_before;
  if (is_new && spdlog::should_log(spdlog::level::debug)) {
    const RequestId id = peek_request(request).value().id;
    details_.add({"sessions started", 1, fmt::format("session {} with seq {}", id.session_id, id.seq)},
                 seconds_now());
  }
  if (step == Step::kAnswered) send_reply(arrival);
  has_new_session_ = has_new_session_ || is_new;
  if (has_new_session_) publish_status_to_new_sessions();
  if (step == Step::kAnswered) return;
  const SessionKey session = peek_request(request).value().session();
  const bool is_retry = std::ranges::find(arrivals_, session, &Arrival::session) != arrivals_.end();
  if (!is_retry) arrivals_.push_back({session, arrival});
}

void Daemon::send_reply(double arrival) {
  const Bytes bytes = handler_.last_response();
  if (faults_) return faults_->push(copy_reply(bytes, arrival), seconds_now());
  const AddressedResponse response = address(bytes);
  if (publish(response.channel, response.bytes)) latency_.add(seconds_now() - arrival);
  if (const Bytes hydrostatics = handler_.last_hydrostatics(); !hydrostatics.empty()) {
    publish(channels_.hydrostatics, hydrostatics);
  }
  if (const Bytes loads = handler_.last_loads(); !loads.empty()) publish(channels_.loads, loads);
}

Daemon::AddressedResponse Daemon::address(Bytes response) {
  const SessionKey session = handler_.last_session();
  if (session.kind == RequestKind::kWaterPoints) return {channels_.water_samples, response};
  const PoseChannel* const pose = poses_.channel_of_session(session.id);
  if (pose == nullptr || pose->force_torque_channel.empty()) return {channels_.wrenches, response};
  encode_force_torque(response, response_, force_torque_bytes_);
  return {pose->force_torque_channel, force_torque_bytes_};
}

Reply Daemon::copy_reply(Bytes response, double arrival) {
  Reply reply;
  reply.arrival = arrival;
  const auto add = [&reply](const std::string& channel, Bytes bytes) {
    if (!bytes.empty()) reply.messages.push_back({channel, {bytes.begin(), bytes.end()}});
  };
  const AddressedResponse addressed = address(response);
  add(addressed.channel, addressed.bytes);
  add(channels_.hydrostatics, handler_.last_hydrostatics());
  add(channels_.loads, handler_.last_loads());
  return reply;
}

void Daemon::publish_reply(const Reply& reply) {
  for (const Reply::Message& message : reply.messages) {
    const bool published = publish(message.channel, message.bytes);
    if (published && &message == reply.messages.data()) latency_.add(seconds_now() - reply.arrival);
  }
}

bool Daemon::publish(const std::string& channel, Bytes bytes) {
  const Expected<void> published = connection_.publish(channel, bytes);
  if (published) return true;
  ++send_failures_;
  warnings_.add({"messages not sent", 1, published.error().message()}, seconds_now());
  return false;
}

void Daemon::publish_sea() {
  if (!sea_bytes_.empty()) publish(channels_.sea, sea_bytes_);
}

void Daemon::warn_of_missing_velocities(double now) {
  for (std::size_t i = 0; i < poses_.channels().size(); ++i) {
    const std::int64_t count = poses_.without_velocities(i);
    const std::int64_t increase = count - std::exchange(reported_without_velocities_[i], count);
    if (increase == 0) continue;
    if (const std::optional<LogEvent> warning = missing_velocities(poses_.channels()[i], *scene_, increase)) {
      warnings_.add(*warning, now);
    }
  }
}

void Daemon::begin_reload() {
  if (loader_.is_loading()) spdlog::debug("reload requested while another is in progress; queued");
  loader_.request();
  systemd_.reloading();
  spdlog::info("SIGHUP: reloading {}; serving the current scene until it is ready", scene_->name());
}

void Daemon::end_reload() {
  std::optional<SceneLoader::Loaded> loaded = loader_.poll();
  if (!loaded) return;
  try {
    if (*loaded) handler_.set_scene(***loaded);
  } catch (const std::bad_alloc&) {
    loaded.emplace(tl::unexpect, out_of_memory_for(scene_->name()));
  }
  last_reload_failed_ = !loaded->has_value();
  if (last_reload_failed_) {
    ++reloads_failed_;
    spdlog::error("reload failed; still serving the current scene: {}", loaded->error().message());
  } else {
    ++reloads_;
    const std::size_t bodies_before = scene_->bodies().size();
    loader_.release(std::exchange(scene_, std::move(**loaded)));
    scene_fingerprint_ = scene_fingerprint(*scene_);
    spdlog::info("reloaded: {} (before: {}) from {}", format_body_count(scene_->bodies()), bodies_before,
                 scene_->name());
    guard([this] {
      log_warnings(*scene_);
      prepare_for_scene();
    });
  }
  if (!loader_.is_loading()) systemd_.ready();
}

void Daemon::prepare_for_scene() {
  prepare_for_messages();
  if (const Expected<void> subscribed = subscribe_to_conditions(); !subscribed) {
    spdlog::error("conditions are not received: {}", subscribed.error().message());
  }
  if (const Expected<void> subscribed = subscribe_to_grids(); !subscribed) {
    spdlog::error("grids are not received: {}", subscribed.error().message());
  }
  publish_sea();
}

// A status tells the client of a new session at once which scene the service has loaded.
void Daemon::publish_status_to_new_sessions() {
  constexpr double kMinInterval = 0.1;  // [s]: sessions may be begun as fast as requests
  if (seconds_now() - last_status_ >= kMinInterval) publish_status();
}

void Daemon::publish_status() {
  const ServiceCounters& counters = handler_.counters();
  const DropCounts drops = connection_.drop_counts();
  const double now = seconds_now();
  last_status_ = now;
  has_new_session_ = false;
  encode(ServiceStatus{.utime = utime_now(),
                       .instance_id = instance_id_,
                       .version = BUOYANCY_VERSION,
                       .scene = scene_->name(),
                       .injected_faults = faults_ ? to_string(faults_->options()) : std::string(),
                       .uptime = now - start_,
                       .mode = mode_,
                       .simd_target = simd_target_from_name(simd_target()),
                       .threads = static_cast<std::int32_t>(handler_.thread_count()),
                       .scene_bodies = static_cast<std::int32_t>(scene_->bodies().size()),
                       .scene_fingerprint = scene_fingerprint_,
                       .other_services = static_cast<std::int64_t>(instances_.count()),
                       .reloads = reloads_,
                       .reloads_failed = reloads_failed_,
                       .send_failures = send_failures_,
                       .packets_dropped = drops.packets,
                       .fragments_dropped = drops.fragments,
                       .partial_messages_evicted = drops.partial_messages_evicted,
                       .faults = faults_ ? faults_->counters(now) : FaultCounters{},
                       .counters = counters,
                       .latency = latency_.percentiles(),
                       .queue_wait = std::exchange(queue_delay_, 0.0)},
         status_bytes_);
  publish(channels_.status, status_bytes_);
  publish_sea();
  systemd_.status(fmt::format("{}, {} answered{}{}", format_body_count(scene_->bodies()),
                              pluralize(counters.computed + counters.retries, "request", "requests"),
                              last_reload_failed_ ? "; the last reload failed, see the log" : "",
                              faults_ ? "; injects faults on purpose (--inject)" : ""));
  for (const LogEvent& warning : warnings_since(reported_, counters, handler_.newest_failures())) {
    warnings_.add(warning, now);
  }
  for (const LogEvent& warning : warnings_since(reported_drops_, drops, receive_buffer_limit_)) {
    warnings_.add(warning, now);
  }
  warn_of_missing_velocities(now);
  for (const MotionFinding& finding : handler_.take_findings()) warnings_.add(to_log_event(finding), now);
  for (const std::string& line : warnings_.drain(now)) spdlog::warn("{}", line);
  for (const std::string& line : details_.drain(now)) spdlog::debug("{}", line);
  for (const InstanceMonitor::Instance& other : instances_.take_new()) {
    spdlog::warn(
        "another buoyancyd (instance {}, {}) publishes on {}: if it also receives {}, every request gets two "
        "responses. Stop one of the two, or give each its own channels",
        other.id, other.scene_fingerprint == scene_fingerprint_ ? "the same scene" : "another scene",
        channels_.status, channels_.states);
  }
  reported_ = counters;
  reported_drops_ = drops;
}

}  // namespace buoyancy::service
