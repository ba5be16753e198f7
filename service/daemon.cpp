#include "service/daemon.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <random>
#include <system_error>

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/timerfd.h>

#include "hydrostatics/wet_tree_sum.h"
#include "messages/status.h"
#include "service/file_descriptor.h"
#include "service/troubles.h"

namespace buoyancy {
namespace {

// Messages that liblcm keeps for us while we compute. Beyond it liblcm drops the newest; a bound there must
// be, or a sender that is faster than we are takes all memory.
constexpr int kQueueCapacity = 10'000;
constexpr int kDrainedAtOnce = 4096;  // mode latest, so that a flood cannot keep us from answering
constexpr std::size_t kMaxSessions = ExchangeOptions{}.max_sessions;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::int64_t utime_now() {
  using std::chrono::microseconds;
  return std::chrono::duration_cast<microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::int64_t random_id() {
  std::random_device device;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(device()) << 32U | device());
}

FileDescriptor one_hertz_timer() {
  FileDescriptor timer(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
  const itimerspec every_second{{1, 0}, {1, 0}};
  if (timer.valid()) ::timerfd_settime(timer.value(), 0, &every_second, nullptr);
  return timer;
}

}  // namespace

std::string_view name(Mode mode) {
  return mode == Mode::kLockstep ? "lockstep" : "latest";
}

Daemon::Daemon(const Scene& scene, LcmConnection connection, Mode mode, ChannelNames channels,
               unsigned threads)
    : mode_(mode),
      channels_(std::move(channels)),
      connection_(std::move(connection)),
      exchange_(scene, {.max_sessions = kMaxSessions, .threads = threads}),
      latest_(kMaxSessions),
      instance_id_(random_id()),
      other_instances_(instance_id_) {}

Expected<void> Daemon::run(TerminationSignals& signals) {
  const FileDescriptor timer = one_hertz_timer();
  if (!timer.valid() || signals.fileno() < 0) {
    return failure({"timer and signals", std::generic_category().message(errno), "two file descriptors",
                    "too many open files", ""});
  }
  Expected<void> subscribed = connection_.subscribe(
      channels_.states,
      [this](Bytes question, std::string_view) {
        if (mode_ == Mode::kLockstep) {
          answer(question, seconds_now());
        } else {
          take_in(question, seconds_now());
        }
      },
      kQueueCapacity);
  if (subscribed) {
    subscribed = connection_.subscribe(
        channels_.status, [this](Bytes status, std::string_view) { other_instances_.hear(status); },
        kQueueCapacity);
  }
  if (!subscribed) return subscribed;
  spdlog::info(
      "ready: {} bodies; questions on {}, answers on {}, hydrostatics on {}, status on {}; {}, mode {}, "
      "instance {}",
      exchange_.scene().bodies().size(), channels_.states, channels_.wrenches, channels_.hydrostatics,
      channels_.status, connection_.url(), name(mode_), instance_id_);
  report();

  std::array<pollfd, 3> waiting{pollfd{connection_.fileno(), POLLIN, 0}, pollfd{signals.fileno(), POLLIN, 0},
                                pollfd{timer.value(), POLLIN, 0}};
  const auto& [messages, signal, tick] = waiting;
  while (true) {
    const int forever_or_not_at_all = latest_.empty() ? -1 : 0;
    if (::poll(waiting.data(), waiting.size(), forever_or_not_at_all) < 0) {
      if (errno == EINTR) continue;  // a debugger, a stop and go
      return failure(
          {"waiting for messages", std::generic_category().message(errno), "poll to work", "", ""});
    }
    if (signal.revents != 0) break;
    if (tick.revents != 0) {
      std::uint64_t expirations = 0;
      if (::read(timer.value(), &expirations, sizeof expirations) > 0) report();
    }
    if (messages.revents != 0) {
      if (Expected<void> received = receive(); !received) return received;
    }
    answer_next_waiting();
  }
  report();
  spdlog::info("ended by {}; {}", signals.take(),
               describe_totals(exchange_.counters(), latency_.percentiles()));
  return {};
}

Expected<void> Daemon::receive() {
  if (!connection_.handle_one()) {
    return failure({connection_.url(), "LCM stopped receiving", "a connection that lasts",
                    "what LCM itself printed above", "Start the service again"});
  }
  if (mode_ == Mode::kLatest) {
    for (int drained = 1; drained < kDrainedAtOnce && connection_.handle_one(); ++drained) {
    }
  }
  return {};
}

void Daemon::take_in(Bytes question, double arrival) {
  const auto key = peek_key(question);
  if (!key) {
    answer(question, arrival);  // there it is rejected and counted by its cause
    return;
  }
  LatestQuestions::Fate fate = latest_.offer(*key, question, arrival);
  if (fate == LatestQuestions::Fate::kNoRoom) {
    answer_next_waiting();
    fate = latest_.offer(*key, question, arrival);
  }
  if (fate == LatestQuestions::Fate::kOvertook) exchange_.count_overtaken();
  if (fate == LatestQuestions::Fate::kStale) exchange_.count_stale();
}

void Daemon::answer_next_waiting() {
  latest_.take_next([this](Bytes question, double arrival) { answer(question, arrival); });
}

void Daemon::answer(Bytes question, double arrival) {
  const Bytes bytes = exchange_.answer(question);
  if (bytes.empty()) return;
  if (publish(channels_.wrenches, bytes)) latency_.add(seconds_now() - arrival);
  if (const Bytes hydrostatics = exchange_.hydrostatics(); !hydrostatics.empty()) {
    publish(channels_.hydrostatics, hydrostatics);
  }
}

bool Daemon::publish(const std::string& channel, Bytes bytes) {
  const Expected<void> published = connection_.publish(channel, bytes);
  if (!published) publish_error_ = published.error().message();
  return published.has_value();
}

void Daemon::report() {
  const Counters& counters = exchange_.counters();
  encode(ServiceStatus{.utime = utime_now(),
                       .instance_id = instance_id_,
                       .version = BUOYANCY_VERSION,
                       .simd_target = simd_target_from_name(simd_target()),
                       .threads = static_cast<std::int32_t>(exchange_.threads()),
                       .counters = counters,
                       .latency = latency_.percentiles()},
         status_bytes_);
  publish(channels_.status, status_bytes_);
  for (const std::string& trouble : describe_troubles(reported_, counters)) spdlog::warn("{}", trouble);
  for (const std::int64_t other : other_instances_.take_new()) {
    spdlog::warn(
        "another buoyancyd, instance {}, is on {}: if it also hears {}, every question is answered twice. "
        "Stop one of the two, or give each its own channels",
        other, channels_.status, channels_.states);
  }
  if (!publish_error_.empty()) spdlog::warn("{}", publish_error_);
  publish_error_.clear();
  reported_ = counters;
}

}  // namespace buoyancy
