#include "view/report/run_log_reader.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/motion_check.h"
#include "messages/conversions.h"
#include "recording/event_log.h"
#include "recording/sequence_gaps.h"
#include "view/common/pose_tracker.h"

namespace buoyancy::view {
namespace {

constexpr std::size_t kMaxPending = 4'096;
constexpr std::int64_t kEventsBetweenProgress = 4'096;
// A service sends the loads of a request right after its response.
constexpr std::size_t kMaxAwaitingLoads = 64;

constexpr std::int64_t kPoseSession = std::numeric_limits<std::int64_t>::min();

// Matches the requests of a log with their responses, in order of arrival.
class ResponseMatcher {
 public:
  ResponseMatcher(PoseChannels poses, RunBuilder& builder) : poses_(std::move(poses)), builder_(builder) {}

  void on_request(std::int64_t timestamp, Bytes bytes) {
    WrenchRequest request;
    if (const auto error = decode(bytes, request)) return warn_skipped("request", *error);
    const std::int64_t session_id = request.id.session_id;
    gaps_.add(session_id, request.id.seq);
    motion_.add(bytes, builder_.scene());
    add_pending({timestamp, true, std::move(request), {}}, session_id);
  }

  void on_pose(std::int64_t timestamp, std::size_t index, Bytes bytes) {
    tl::expected<WrenchRequest, DecodeError> request = poses_.request(index, bytes);
    if (!request) return warn_skipped("pose", request.error());
    const BodyState& state = request->bodies.front();
    const bool velocities = poses_.channels().velocity_frame && all_finite(state.linear_velocity) &&
                            all_finite(state.angular_velocity);
    add_pending({timestamp, velocities, *std::move(request), {}}, kPoseSession);
  }

  void on_response(std::int64_t timestamp, Bytes bytes) {
    if (const auto error = decode(bytes, response_)) return warn_skipped("response", *error);
    auto request = pending_.find(key_of(response_.id));
    if (request == pending_.end() && response_.bodies.size() == 1) {
      request = find_pose(response_.bodies.front().body_id, response_.id.utime);
    }
    complete(timestamp, request, std::nullopt);
  }

  void on_loads(Bytes bytes) {
    if (const auto error = decode(bytes, loads_)) return warn_skipped("loads", *error);
    auto rows = rows_awaiting(key_of(loads_.id));
    if (rows == awaiting_loads_.end() && loads_.bodies.size() == 1) {
      const auto id = poses_.request_id_for_pose(loads_.bodies.front().body_id, loads_.id.utime);
      if (id) rows = rows_awaiting(key_of(*id));
    }
    if (rows == awaiting_loads_.end()) return;
    for (const BodyLoads& loads : loads_.bodies) {
      for (const std::shared_ptr<RowLoads>& row : rows->second) {
        if (row->state.body_id == loads.body_id) row->recorded = loads;
      }
    }
  }

  void on_force_torque(std::int64_t timestamp, std::size_t index, Bytes bytes) {
    const auto message = decode_six_axis_force_torque(bytes);
    if (!message) return warn_skipped("force and torque", message.error());
    response_.bodies.clear();
    complete(timestamp, find_pose(poses_.channels().channels[index].body_id, message->utime), *message);
  }

  // Adds the requests that are still pending without a response, and what the log lacks or contradicts.
  void finish() {
    while (!pending_.empty()) drop_oldest();
    constexpr std::size_t kMaxNotices = 8;
    std::vector<std::string> notices = gap_lines(gaps_, "requests");
    for (const MotionFinding& finding : motion_.findings()) notices.push_back(finding.warning().message());
    const std::size_t shown = std::min(notices.size(), kMaxNotices);
    for (std::size_t i = 0; i < shown; ++i) builder_.add_notice(std::move(notices[i]));
    if (notices.size() > shown) builder_.add_notice(std::to_string(notices.size() - shown) + " more notices");
  }
  std::int64_t rows() const { return rows_; }

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;  // session_id, seq
  struct PendingRequest {
    std::int64_t timestamp = 0;
    bool velocities = false;  // known
    WrenchRequest request;
    std::vector<std::int64_t> times;  // of its bodies, on the run's time axis
  };
  using PendingRequests = std::map<Key, PendingRequest>;
  using AwaitingLoads = std::deque<std::pair<Key, std::vector<std::shared_ptr<RowLoads>>>>;

  static Key key_of(const RequestId& id) { return {id.session_id, id.seq}; }

  void warn_skipped(const char* message, DecodeError error) {
    builder_.add_warning(std::string(message) + " skipped: " + to_string(error));
  }

  void add_pending(PendingRequest pending, std::int64_t session_id) {
    const Key key = key_of(pending.request.id);
    if (pending_.contains(key) || key == last_completed_) return;  // a retry
    for (const BodyState& state : pending.request.bodies) {
      pending.times.push_back(builder_.time_of(state.body_id, session_id, pending.request.id.utime));
    }
    order_.push_back(pending_.emplace(key, std::move(pending)).first->first);
    while (pending_.size() > kMaxPending) drop_oldest();
  }

  PendingRequests::iterator find_pose(std::int32_t body_id, std::int64_t utime) {
    const auto id = poses_.request_id_for_pose(body_id, utime);
    return id ? pending_.find(key_of(*id)) : pending_.end();
  }

  AwaitingLoads::iterator rows_awaiting(const Key& key) {
    return std::ranges::find(awaiting_loads_, key, [](const auto& rows) { return rows.first; });
  }

  // request: pending_.end() if the log does not contain the request, or for a repeated response.
  void complete(std::int64_t timestamp, PendingRequests::iterator request,
                const std::optional<BotForceTorque>& force_torque) {
    if (request == pending_.end()) return;
    last_completed_ = request->first;
    add_rows(request->second, 1e-6 * static_cast<double>(timestamp - request->second.timestamp),
             force_torque);
    pending_.erase(request);
    while (!order_.empty() && !pending_.contains(order_.front())) order_.pop_front();
  }

  void drop_oldest() {
    const auto oldest = pending_.find(order_.front());
    order_.pop_front();
    if (oldest == pending_.end()) return;
    response_.bodies.clear();
    add_rows(oldest->second, kUnknown, std::nullopt);
    pending_.erase(oldest);
  }

  // Adds the request's bodies with the wrenches of response_, which have the same order.
  void add_rows(const PendingRequest& pending, double round_trip,
                const std::optional<BotForceTorque>& force_torque) {
    const WrenchRequest& request = pending.request;
    std::vector<std::shared_ptr<RowLoads>> loads;
    for (std::size_t i = 0; i < request.bodies.size(); ++i) {
      RecordedState row{.time = pending.times[i],
                        .utime = request.id.utime,
                        .state = request.bodies[i],
                        .lead_time = request.lead_time,
                        .wrench = std::nullopt,
                        .force_torque = force_torque,
                        .energy = std::nullopt,
                        .velocities = pending.velocities,
                        .round_trip = round_trip};
      if (i < response_.bodies.size() && response_.bodies[i].body_id == row.state.body_id)
        row.wrench = response_.bodies[i];
      if (std::shared_ptr<RowLoads> of_row = builder_.add(row)) loads.push_back(std::move(of_row));
      ++rows_;
    }
    if (loads.empty()) return;
    awaiting_loads_.emplace_front(key_of(request.id), std::move(loads));
    if (awaiting_loads_.size() > kMaxAwaitingLoads) awaiting_loads_.pop_back();
  }

  PoseTracker poses_;
  RunBuilder& builder_;
  PendingRequests pending_;
  std::deque<Key> order_;
  std::optional<Key> last_completed_;
  AwaitingLoads awaiting_loads_;  // rows of the latest responses, the latest first
  WrenchResponse response_;       // decode buffers, reused
  BodiesLoads loads_;
  SequenceGaps gaps_;
  MotionMonitor motion_;
  std::int64_t rows_ = 0;
};

}  // namespace

Expected<void> read_run_log(const std::filesystem::path& path, const RunFileOptions& options,
                            RunBuilder& builder) {
  ResponseMatcher matcher(options.poses, builder);
  using Handler = std::function<void(const RecordedEvent&)>;
  std::map<std::string, Handler, std::less<>> handlers{
      {options.states_channel,
       [&](const RecordedEvent& event) { matcher.on_request(event.timestamp, event.bytes); }},
      {options.wrenches_channel,
       [&](const RecordedEvent& event) { matcher.on_response(event.timestamp, event.bytes); }},
      {options.loads_channel, [&](const RecordedEvent& event) { matcher.on_loads(event.bytes); }},
      {builder.scene().receives_grids() ? options.sea_grid_channel : options.sea_channel,
       [&](const RecordedEvent& event) { builder.receive_sea(event.timestamp, event.bytes); }},
      {options.condition_channel,
       [&](const RecordedEvent& event) { builder.receive_condition(event.timestamp, event.bytes); }},
      {options.status_channel, [&](const RecordedEvent& event) {
         if (ServiceStatus status; !decode(event.bytes, status)) builder.set_status(std::move(status));
       }}};
  for (std::size_t i = 0; i < options.poses.channels.size(); ++i) {
    const PoseChannel& pose = options.poses.channels[i];
    handlers[pose.channel] = [&matcher, i](const RecordedEvent& event) {
      matcher.on_pose(event.timestamp, i, event.bytes);
    };
    if (pose.force_torque_channel.empty()) continue;
    handlers[pose.force_torque_channel] = [&matcher, i](const RecordedEvent& event) {
      matcher.on_force_torque(event.timestamp, i, event.bytes);
    };
  }
  Expected<EventLogReader> log = EventLogReader::open(
      path, [&handlers](std::string_view channel) { return handlers.contains(channel); });
  if (!log) return tl::unexpected(log.error());
  for (std::int64_t number = 1;; ++number) {
    const LogItem item = log->next();
    if (std::holds_alternative<EndOfLog>(item)) break;
    if (const auto* corrupt = std::get_if<CorruptSection>(&item)) {
      builder.add_warning(corrupt->description);
      continue;
    }
    const auto& event = std::get<RecordedEvent>(item);
    handlers.find(event.channel)->second(event);
    if (number % kEventsBetweenProgress == 0 && options.progress &&
        !options.progress(log->offset(), log->size(), matcher.rows())) {
      break;
    }
  }
  if (log->file().read_error()) return make_error(*log->file().read_error());
  matcher.finish();
  return {};
}

}  // namespace buoyancy::view
