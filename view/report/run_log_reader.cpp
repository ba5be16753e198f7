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

constexpr std::size_t kMostWaiting = 4'096;
constexpr std::int64_t kEventsBetweenProgress = 4'096;

constexpr std::int64_t kSessionOfPoses = std::numeric_limits<std::int64_t>::min();

// Questions until their answers come, in order of arrival.
class Conversation {
 public:
  Conversation(PoseChannels poses, RunCollector& collector)
      : poses_(std::move(poses)), collector_(collector) {}

  void question(std::int64_t timestamp, Bytes bytes) {
    Question question;
    if (const auto rejection = decode(bytes, question)) return leave_out("a question", *rejection);
    const std::int64_t session_id = question.key.session_id;
    wait_for_answer({timestamp, true, std::move(question), {}}, session_id);
  }

  void pose(std::int64_t timestamp, std::size_t index, Bytes bytes) {
    tl::expected<Question, Rejection> question = poses_.question(index, bytes);
    if (!question) return leave_out("a pose", question.error());
    const BodyState& state = question->bodies.front();
    const bool velocities = poses_.asked_on().velocity_frame && all_finite(state.linear_velocity) &&
                            all_finite(state.angular_velocity);
    wait_for_answer({timestamp, velocities, *std::move(question), {}}, kSessionOfPoses);
  }

  void answer(std::int64_t timestamp, Bytes bytes) {
    if (const auto rejection = decode(bytes, answer_)) return leave_out("an answer", *rejection);
    auto asked = waiting_.find(key_of(answer_.key));
    if (asked == waiting_.end() && answer_.bodies.size() == 1) {
      asked = find_pose(answer_.bodies.front().body_id, answer_.key.utime);
    }
    answered(timestamp, asked, std::nullopt);
  }

  void force_torque(std::int64_t timestamp, std::size_t index, Bytes bytes) {
    const auto heard = decode_six_axis_force_torque(bytes);
    if (!heard) return leave_out("a force and torque", heard.error());
    answer_.bodies.clear();
    answered(timestamp, find_pose(poses_.asked_on().channels[index].body_id, heard->utime), *heard);
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
    Question question;
    std::vector<std::int64_t> times;  // of its bodies, on the run's axis
  };
  using Waiting = std::map<Key, Asked>;

  static Key key_of(const QuestionKey& key) { return {key.session_id, key.seq}; }

  void leave_out(const char* what, Rejection rejection) {
    collector_.add_trouble(std::string(what) + " was left out: " + describe(rejection));
  }

  void wait_for_answer(Asked asked, std::int64_t session_id) {
    const Key key = key_of(asked.question.key);
    if (waiting_.contains(key) || key == last_answered_) return;  // asked again
    for (const BodyState& state : asked.question.bodies) {
      asked.times.push_back(collector_.time_of(state.body_id, session_id, asked.question.key.utime));
    }
    order_.push_back(waiting_.emplace(key, std::move(asked)).first->first);
    while (waiting_.size() > kMostWaiting) give_up_oldest();
  }

  Waiting::iterator find_pose(std::int32_t body_id, std::int64_t utime) {
    const auto key = poses_.asked_by_pose(body_id, utime);
    return key ? waiting_.find(key_of(*key)) : waiting_.end();
  }

  // asked: the end where the log does not hold the question, or the same answer comes again.
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
    answer_.bodies.clear();
    add(asked->second, kNotKnown, std::nullopt);
    waiting_.erase(asked);
  }

  // With the wrenches of answer_, which stand in the question's order.
  void add(const Asked& asked, double round_trip, const std::optional<BotForceTorque>& force_torque) {
    const Question& question = asked.question;
    for (std::size_t i = 0; i < question.bodies.size(); ++i) {
      RecordedState row{.time = asked.times[i],
                        .state = question.bodies[i],
                        .lead_time = question.lead_time,
                        .wrench = std::nullopt,
                        .force_torque = force_torque,
                        .energy = std::nullopt,
                        .velocities = asked.velocities,
                        .round_trip = round_trip};
      if (i < answer_.bodies.size() && answer_.bodies[i].body_id == row.state.body_id)
        row.wrench = answer_.bodies[i];
      collector_.add(row);
      ++rows_;
    }
  }

  HeardPoses poses_;
  RunCollector& collector_;
  Waiting waiting_;
  std::deque<Key> order_;
  std::optional<Key> last_answered_;
  Answer answer_;  // reused
  std::int64_t rows_ = 0;
};

}  // namespace

Expected<void> read_run_log(const std::filesystem::path& path, const RunFileOptions& options,
                            RunCollector& collector) {
  Conversation conversation(options.poses, collector);
  using Hear = std::function<void(const RecordedEvent&)>;
  std::map<std::string, Hear, std::less<>> heard{
      {options.states_channel,
       [&](const RecordedEvent& event) { conversation.question(event.timestamp, event.bytes); }},
      {options.wrenches_channel,
       [&](const RecordedEvent& event) { conversation.answer(event.timestamp, event.bytes); }},
      {options.status_channel, [&](const RecordedEvent& event) {
         if (ServiceStatus status; !decode(event.bytes, status)) collector.set_status(std::move(status));
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
    const InputItem item = log->next();
    if (std::holds_alternative<EndOfInput>(item)) break;
    if (const auto* damage = std::get_if<Damage>(&item)) {
      collector.add_trouble(damage->description);
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
