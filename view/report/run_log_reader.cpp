#include "view/report/run_log_reader.h"

#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messages/conversions.h"
#include "recording/event_log.h"
#include "view/common/pose_tracker.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxWaiting = 4'096;
constexpr std::int64_t kEventsBetweenProgress = 4'096;

constexpr std::int64_t kSessionOfPoses = std::numeric_limits<std::int64_t>::min();

// Requests until their responses come, in order of arrival.
class Conversation {
 public:
  Conversation(PoseChannels poses, RunBuilder& builder) : poses_(std::move(poses)), builder_(builder) {}

  void request(std::int64_t timestamp, Bytes bytes) {
    WrenchRequest request;
    if (const auto rejection = decode(bytes, request)) return leave_out("a request", *rejection);
    const std::int64_t session_id = request.key.session_id;
    wait_for_response({timestamp, true, std::move(request), {}}, session_id);
  }

  void pose(std::int64_t timestamp, std::size_t index, Bytes bytes) {
    tl::expected<WrenchRequest, DecodeError> request = poses_.request(index, bytes);
    if (!request) return leave_out("a pose", request.error());
    const BodyState& state = request->bodies.front();
    const bool velocities = poses_.channels().velocity_frame && all_finite(state.linear_velocity) &&
                            all_finite(state.angular_velocity);
    wait_for_response({timestamp, velocities, *std::move(request), {}}, kSessionOfPoses);
  }

  void response(std::int64_t timestamp, Bytes bytes) {
    if (const auto rejection = decode(bytes, response_)) return leave_out("a response", *rejection);
    auto asked = waiting_.find(key_of(response_.key));
    if (asked == waiting_.end() && response_.bodies.size() == 1) {
      asked = find_pose(response_.bodies.front().body_id, response_.key.utime);
    }
    answered(timestamp, asked, std::nullopt);
  }

  void force_torque(std::int64_t timestamp, std::size_t index, Bytes bytes) {
    const auto heard = decode_six_axis_force_torque(bytes);
    if (!heard) return leave_out("a force and torque", heard.error());
    response_.bodies.clear();
    answered(timestamp, find_pose(poses_.channels().channels[index].body_id, heard->utime), *heard);
  }

  void give_up_all() {
    while (!waiting_.empty()) give_up_oldest();
  }
  std::int64_t rows() const { return rows_; }

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;  // session, seq
  struct Asked {
    std::int64_t timestamp = 0;
    bool velocities = false;  // are known
    WrenchRequest request;
    std::vector<std::int64_t> times;  // of its bodies, on the run's axis
  };
  using Waiting = std::map<Key, Asked>;

  static Key key_of(const RequestId& key) { return {key.session_id, key.seq}; }

  void leave_out(const char* what, DecodeError rejection) {
    builder_.add_warning(std::string(what) + " was left out: " + to_string(rejection));
  }

  void wait_for_response(Asked asked, std::int64_t session_id) {
    const Key key = key_of(asked.request.key);
    if (waiting_.contains(key) || key == last_answered_) return;  // asked again
    for (const BodyState& state : asked.request.bodies) {
      asked.times.push_back(builder_.time_of(state.body_id, session_id, asked.request.key.utime));
    }
    order_.push_back(waiting_.emplace(key, std::move(asked)).first->first);
    while (waiting_.size() > kMaxWaiting) give_up_oldest();
  }

  Waiting::iterator find_pose(std::int32_t body_id, std::int64_t utime) {
    const auto key = poses_.request_id_for_pose(body_id, utime);
    return key ? waiting_.find(key_of(*key)) : waiting_.end();
  }

  // asked: the end where the log does not hold the request, or the same response comes again.
  void answered(std::int64_t timestamp, Waiting::iterator asked,
                const std::optional<BotForceTorque>& force_torque) {
    if (asked == waiting_.end()) return;
    last_answered_ = asked->first;
    add(asked->second, 1e-6 * static_cast<double>(timestamp - asked->second.timestamp), force_torque);
    waiting_.erase(asked);
    while (!order_.empty() && !waiting_.contains(order_.front())) order_.pop_front();
  }

  void give_up_oldest() {
    const auto asked = waiting_.find(order_.front());
    order_.pop_front();
    if (asked == waiting_.end()) return;
    response_.bodies.clear();
    add(asked->second, kUnknown, std::nullopt);
    waiting_.erase(asked);
  }

  // With the wrenches of answer_, which stand in the request's order.
  void add(const Asked& asked, double round_trip, const std::optional<BotForceTorque>& force_torque) {
    const WrenchRequest& request = asked.request;
    for (std::size_t i = 0; i < request.bodies.size(); ++i) {
      RecordedState row{.time = asked.times[i],
                        .state = request.bodies[i],
                        .lead_time = request.lead_time,
                        .wrench = std::nullopt,
                        .force_torque = force_torque,
                        .energy = std::nullopt,
                        .velocities = asked.velocities,
                        .round_trip = round_trip};
      if (i < response_.bodies.size() && response_.bodies[i].body_id == row.state.body_id)
        row.wrench = response_.bodies[i];
      builder_.add(row);
      ++rows_;
    }
  }

  PoseTracker poses_;
  RunBuilder& builder_;
  Waiting waiting_;
  std::deque<Key> order_;
  std::optional<Key> last_answered_;
  WrenchResponse response_;  // reused
  std::int64_t rows_ = 0;
};

}  // namespace

Expected<void> read_run_log(const std::filesystem::path& path, const RunFileOptions& options,
                            RunBuilder& builder) {
  Conversation conversation(options.poses, builder);
  using Hear = std::function<void(const RecordedEvent&)>;
  std::map<std::string, Hear, std::less<>> heard{
      {options.states_channel,
       [&](const RecordedEvent& event) { conversation.request(event.timestamp, event.bytes); }},
      {options.wrenches_channel,
       [&](const RecordedEvent& event) { conversation.response(event.timestamp, event.bytes); }},
      {options.status_channel, [&](const RecordedEvent& event) {
         if (ServiceStatus status; !decode(event.bytes, status)) builder.set_status(std::move(status));
       }}};
  for (std::size_t i = 0; i < options.poses.channels.size(); ++i) {
    const PoseChannel& pose = options.poses.channels[i];
    heard[pose.channel] = [&conversation, i](const RecordedEvent& event) {
      conversation.pose(event.timestamp, i, event.bytes);
    };
    if (pose.force_torque_channel.empty()) continue;
    heard[pose.force_torque_channel] = [&conversation, i](const RecordedEvent& event) {
      conversation.force_torque(event.timestamp, i, event.bytes);
    };
  }
  Expected<EventLogReader> log =
      EventLogReader::open(path, [&heard](std::string_view channel) { return heard.contains(channel); });
  if (!log) return tl::unexpected(log.error());
  for (std::int64_t number = 1;; ++number) {
    const LogItem item = log->next();
    if (std::holds_alternative<EndOfLog>(item)) break;
    if (const auto* damage = std::get_if<CorruptSection>(&item)) {
      builder.add_warning(damage->description);
      continue;
    }
    const auto& event = std::get<RecordedEvent>(item);
    heard.find(event.channel)->second(event);
    if (number % kEventsBetweenProgress == 0 && options.progress &&
        !options.progress(log->offset(), log->size(), conversation.rows())) {
      break;
    }
  }
  conversation.give_up_all();
  return {};
}

}  // namespace buoyancy
