#include "client/ping/ping.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "base/format.h"
#include "client/client.h"
#include "client/ping/likely_causes.h"
#include "client/ping/ping_poses.h"
#include "client/ping/service_causes.h"
#include "engine/request_handler.h"

namespace buoyancy::ping {
namespace {

// The run ends after so many requests in a row without a reply; before the first reply, after one.
constexpr std::int64_t kMaxUnansweredInARow = 3;
// How long to wait for a status, from the start of the run. The service publishes one when a session begins
// and once a second.
constexpr std::chrono::seconds kStatusTimeout{2};
constexpr std::int64_t kTimeBetweenRequests = 100'000;  // [us], simulated

Clock::duration to_duration(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}
double to_seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

ByteVector copy_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

AwaitedOutputs outputs_of(const Scene& scene) {
  return {.hydrostatics = scene.bodies_with_hydrostatics() > 0, .loads = scene.bodies_with_loads() > 0};
}

class Run {
 public:
  Run(const PingTask& task, const TerminationSignals& signals)
      : task_(task),
        signals_(signals),
        handler_(task.scene),
        result_(task.scene),
        awaited_(outputs_of(task.scene)),
        session_id_(make_session_id()) {
    const Water& water = task.scene.water();
    surface_.level = water.level;
    if (const Sea* const sea = task.scene.sea()) set_sea(*sea);
  }

  PingResult finish() && {
    Expected<ServiceLink> link = open_link();
    if (!link) {
      fail(kConnectionCheck, link.error().message());
      return std::move(result_);
    }
    result_.url = link->url();
    reserve(*link);
    ping_all(*link);
    result_.seconds = to_seconds(Clock::now() - start_);
    conclude(*link);
    return std::move(result_);
  }

 private:
  void set_sea(const Sea& sea) {
    surface_.level = sea.water().level;
    surface_.max_elevation = sea.max_elevation();
    // The first request lies within the ramp, so that its shape is compared too.
    first_utime_ = sea.time_origin() + static_cast<std::int64_t>(sea.ramp() * 0.5e6);
  }

  // Makes the request handler and the checks use the sea that is to be published.
  Expected<void> use_sea() {
    if (task_.sea.empty()) return {};
    if (Expected<void> used = handler_.receive_sea(task_.sea); !used) return used;
    if (Expected<void> used = result_.checks.receive_sea(task_.sea); !used) return used;
    SeaState state;
    decode(task_.sea, state);
    const Expected<Sea> sea = to_sea(state, task_.scene.water(), task_.scene.current_W());
    if (!sea) return make_error(sea.error());
    set_sea(*sea);
    first_utime_ = std::max(first_utime_, state.utime);
    return {};
  }

  Expected<ServiceLink> open_link() {
    if (const Expected<void> used = use_sea(); !used) return make_error(used.error());
    return ServiceLink::open(task_.link, awaited_);
  }

  void reserve(ServiceLink& link) {
    const Scene& scene = task_.scene;
    std::size_t bytes = response_size(scene.bodies().size());
    if (awaited_.hydrostatics) bytes += hydrostatics_size(scene.bodies_with_hydrostatics());
    if (awaited_.loads) bytes += loads_size(scene.bodies_with_loads());
    if (std::optional<Warning> warning = link.reserve(scene.bodies().size(), bytes)) {
      result_.warnings.push_back(std::move(*warning));
    }
  }

  void ping_all(ServiceLink& link) {
    Clock::time_point next_send = Clock::now();
    std::int64_t unanswered_in_a_row = 0;
    for (std::int64_t seq = 0; seq < task_.count && !signals_.pending(); ++seq) {
      if (task_.rate > 0.0) {
        link.wait_until(next_send, signals_);
        if (signals_.pending()) return;
        next_send += to_duration(1.0 / task_.rate);
      }
      if (ping_once(link, seq)) {
        unanswered_in_a_row = 0;
        continue;
      }
      if (signals_.pending()) return;
      ++result_.unanswered;
      const bool none_so_far = result_.checks.replies() == 0;
      if (none_so_far || ++unanswered_in_a_row == kMaxUnansweredInARow) return;
    }
  }

  // Returns whether the request got a complete reply.
  bool ping_once(ServiceLink& link, std::int64_t seq) {
    const RequestId id{
        .utime = first_utime_ + seq * kTimeBetweenRequests, .session_id = session_id_, .seq = seq};
    make_states(task_.scene, surface_, task_.seed, seq, states_);
    encode(BorrowedRequest(id, 0.0, states_), request_);
    const ExpectedReply expected{.wrenches = copy_of(handler_.handle(request_)),
                                 .hydrostatics = copy_of(handler_.last_hydrostatics()),
                                 .loads = copy_of(handler_.last_loads())};
    const Clock::time_point sent_at = Clock::now();
    ++result_.requests;
    const bool complete = exchange(link, id);
    const Reply& reply = link.reply();
    if (!reply.wrenches.empty()) {
      result_.round_trips.push_back(to_seconds(reply.wrenches_at - sent_at));
      result_.checks.add(id, states_, expected, reply);
    }
    if (!complete && !signals_.pending()) explain(link, seq, to_seconds(Clock::now() - sent_at));
    return complete;
  }

  // Sends the request until its reply is complete or the retries are used up.
  bool exchange(ServiceLink& link, const RequestId& id) {
    for (std::int64_t retry = 0; retry <= task_.retry_policy.max_retries; ++retry) {
      if (retry > 0) ++result_.retries;
      if (!task_.sea.empty()) static_cast<void>(link.send_sea(task_.sea));  // a lost one is sent again
      const Expected<void> sent = link.send(id, request_);
      send_error_ = sent ? std::nullopt : std::optional(sent.error());
      const Clock::time_point deadline = Clock::now() + to_duration(task_.retry_policy.timeout);
      if (link.wait_for_reply(awaited_, deadline, signals_)) return true;
      if (signals_.pending()) return false;
    }
    return false;
  }

  // Records why a reply is not complete. An output that never came is not waited for again.
  void explain(ServiceLink& link, std::int64_t seq, double waited) {
    const Reply& reply = link.reply();
    const std::string after = " after " + format_number(waited, 3) + " s and " +
                              pluralize(task_.retry_policy.max_retries, "retry", "retries");
    if (reply.wrenches.empty()) {
      if (silent_++ > 0) return;
      std::string message = format_text("request {}: no response{} on {}, channels {} and {}", seq, after,
                                        link.url(), task_.link.states_channel, task_.link.wrenches_channel);
      if (send_error_) message += "; sending fails: " + send_error_->message();
      if (const std::int64_t dropped = link.packets_dropped(); dropped > 0) {
        message += "; the kernel dropped " + pluralize(dropped, "packet", "packets") +
                   " because this program's receive buffer was full";
      }
      fail(kResponsesCheck, message);
      if (link.stats().undecodable.count > 0) return;  // damaged messages have causes of their own
      link.wait_for_description(false, start_ + kStatusTimeout, signals_);
      add_cause(cause_of_silence(task_.link, link.url(), link.service()));
      return;
    }
    const auto missing = [&](bool& awaited, const ByteVector& bytes, const char* name,
                             const std::string& channel) {
      if (!awaited || !bytes.empty()) return;
      fail(kOutputsCheck,
           format_text("request {}: a response, but no {}{} on channel {}", seq, name, after, channel));
      add_cause(
          format_text("the service's scene does not list \"{}\" among the outputs of these bodies, or it "
                      "publishes them on another channel",
                      name));
      awaited = false;
    };
    missing(awaited_.hydrostatics, reply.hydrostatics, "hydrostatics", task_.link.hydrostatics_channel);
    missing(awaited_.loads, reply.loads, "loads", task_.link.loads_channel);
  }

  void fail(const char* check, std::string_view message) {
    result_.failures.push_back({check, std::string(message)});
  }
  void add_cause(std::string_view cause) { result_.likely_causes.emplace_back(cause); }

  void report_damaged(const UndecodableMessages& damaged) {
    std::string where;
    if (damaged.first_channel == task_.link.wrenches_channel) {
      where = ", where a response has " + std::to_string(response_size(task_.scene.bodies().size()));
    }
    fail(kDecodableCheck, format_text("{} could not be decoded; the first, of {} bytes on channel {}{}: {}",
                                      pluralize(damaged.count, "message", "messages"), damaged.first_size,
                                      damaged.first_channel, where, to_string(damaged.first_error)));
    add_cause(
        damaged.first_error == DecodeError::kFingerprint
            ? "another program, or another version of the service, publishes on this channel, or something "
              "damages the responses"
            : "something between the service and here cuts the responses short or damages them");
  }

  // Records what is known once the last request is over.
  void conclude(ServiceLink& link) {
    const LinkStats& stats = link.stats();
    if (stats.undecodable.count > 0) report_damaged(stats.undecodable);
    if (stats.conflicting > 0) {
      fail(kSingleResponseCheck, pluralize(stats.conflicting, "request", "requests") +
                                     " got a second response with other contents");
      add_cause(
          "several services with different scenes respond on these channels, or something repeats and "
          "changes "
          "their responses");
    }
    if (result_.checks.wrong_ids() > 0) {
      fail(kIdsCheck, result_.checks.first_wrong_ids());
      add_cause(
          "a program other than buoyancyd responds on these channels, or its scene requests the outputs of "
          "other bodies");
    }
    if (silent_ > 1) {
      fail(kResponsesCheck, pluralize(silent_, "request", "requests") + " got no response");
    }
    const std::int64_t others = result_.checks.replies() - result_.checks.identical();
    if (task_.identical && others > 0) {
      fail(kIdenticalCheck,
           pluralize(others, "reply is", "replies are") +
               " not identical to the last bit; expected the bits that the same scene, version and "
               "instruction set give");
    }
    if (signals_.pending()) {
      fail(kResponsesCheck, "stopped after " + std::to_string(result_.requests) + " of " +
                                std::to_string(task_.count) + " requests");
    }
    if (!result_.checks.all_passed()) find_causes(link);
    if (result_.checks.replies() > 0) {
      link.wait_for_description(false, start_ + kStatusTimeout, signals_);
      std::ranges::move(service_warnings(task_.scene, link.service()), std::back_inserter(result_.warnings));
    }
    result_.link = link.stats();
    result_.service = link.service();
  }

  void find_causes(ServiceLink& link) {
    const bool sea_expected = task_.scene.sea() != nullptr;
    link.wait_for_description(sea_expected, start_ + kStatusTimeout, signals_);
    for (std::vector<std::string> causes : {causes_of_differences(task_.scene, result_.checks),
                                            causes_from_service(task_.scene, link.service())}) {
      std::ranges::move(causes, std::back_inserter(result_.likely_causes));
    }
    if (result_.likely_causes.empty()) add_cause("the service has another scene file, or another version");
  }

  const PingTask& task_;
  const TerminationSignals& signals_;
  RequestHandler handler_;
  PingResult result_;
  AwaitedOutputs awaited_;
  std::int64_t session_id_;
  WaterSurface surface_;
  std::int64_t first_utime_ = 0;  // [us]
  Clock::time_point start_ = Clock::now();
  std::vector<BodyState> states_;
  std::vector<std::uint8_t> request_;
  std::optional<Error> send_error_;  // of the last sending
  std::int64_t silent_ = 0;          // requests without wrenches
};

}  // namespace

RoundTrips summarize_round_trips(std::vector<double> round_trips) {
  if (round_trips.empty()) return {};
  std::ranges::sort(round_trips);
  const auto percentile = [&round_trips](double fraction) {
    const double rank = std::ceil(fraction * static_cast<double>(round_trips.size()));
    return round_trips[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  return {.min = round_trips.front(),
          .median = percentile(0.5),
          .p90 = percentile(0.9),
          .p99 = percentile(0.99),
          .max = round_trips.back()};
}

PingResult run_ping(const PingTask& task, const TerminationSignals& signals) {
  return Run(task, signals).finish();
}

}  // namespace buoyancy::ping
