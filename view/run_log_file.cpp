#include "view/run_log_file.h"

#include <deque>
#include <map>
#include <utility>

#include "recording/event_log.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMostWaiting = 4'096;
constexpr std::int64_t kEventsBetweenProgress = 4'096;

// Questions until their answers come, in order of arrival.
class Conversation {
 public:
  explicit Conversation(RunCollector& collector) : collector_(collector) {}

  void question(std::int64_t timestamp, Bytes bytes) {
    Asked asked{timestamp, {}};
    if (const auto rejection = decode(bytes, asked.question)) {
      collector_.add_trouble(std::string("a question that is ") + describe(*rejection) + ": left out");
      return;
    }
    const Key key{asked.question.key.session_id, asked.question.key.seq};
    if (waiting_.contains(key) || key == last_answered_) return;  // asked again
    waiting_.emplace(key, std::move(asked));
    order_.push_back(key);
    while (waiting_.size() > kMostWaiting) give_up_oldest();
  }

  void answer(std::int64_t timestamp, Bytes bytes) {
    if (const auto rejection = decode(bytes, answer_)) {
      collector_.add_trouble(std::string("an answer that is ") + describe(*rejection) + ": left out");
      return;
    }
    const auto asked = waiting_.find({answer_.key.session_id, answer_.key.seq});
    if (asked == waiting_.end())
      return;  // of a question that the log does not hold, or the same answer again
    last_answered_ = asked->first;
    add(asked->second, 1e-6 * static_cast<double>(timestamp - asked->second.timestamp));
    waiting_.erase(asked);
    while (!order_.empty() && !waiting_.contains(order_.front())) order_.pop_front();
  }

  void give_up_all() {
    while (!waiting_.empty()) give_up_oldest();
  }
  std::int64_t rows() const { return rows_; }

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;  // session, seq
  struct Asked {
    std::int64_t timestamp = 0;
    Question question;
  };

  void give_up_oldest() {
    const auto asked = waiting_.find(order_.front());
    order_.pop_front();
    if (asked == waiting_.end()) return;
    answer_.bodies.clear();
    add(asked->second, kNotKnown);
    waiting_.erase(asked);
  }

  // With the wrenches of answer_, which stand in the question's order.
  void add(const Asked& asked, double round_trip) {
    const Question& question = asked.question;
    for (std::size_t i = 0; i < question.bodies.size(); ++i) {
      RecordedState row{.utime = question.key.utime,
                        .session_id = question.key.session_id,
                        .state = question.bodies[i],
                        .lead_time = question.lead_time,
                        .wrench = std::nullopt,
                        .energy = std::nullopt,
                        .velocities = true,
                        .round_trip = round_trip};
      if (i < answer_.bodies.size() && answer_.bodies[i].body_id == row.state.body_id)
        row.wrench = answer_.bodies[i];
      collector_.add(row);
      ++rows_;
    }
  }

  RunCollector& collector_;
  std::map<Key, Asked> waiting_;
  std::deque<Key> order_;
  std::optional<Key> last_answered_;
  Answer answer_;  // reused
  std::int64_t rows_ = 0;
};

}  // namespace

Expected<void> read_run_log(const std::filesystem::path& path, const RunFileOptions& options,
                            RunCollector& collector) {
  Expected<EventLogReader> log = EventLogReader::open(path, [&options](std::string_view channel) {
    return channel == options.states_channel || channel == options.wrenches_channel ||
           channel == options.status_channel;
  });
  if (!log) return tl::unexpected(log.error());
  Conversation conversation(collector);
  for (std::int64_t number = 1;; ++number) {
    const InputItem item = log->next();
    if (std::holds_alternative<EndOfInput>(item)) break;
    if (const auto* damage = std::get_if<Damage>(&item)) {
      collector.add_trouble(damage->description);
      continue;
    }
    const auto& event = std::get<RecordedEvent>(item);
    if (event.channel == options.states_channel) {
      conversation.question(event.timestamp, event.bytes);
    } else if (event.channel == options.wrenches_channel) {
      conversation.answer(event.timestamp, event.bytes);
    } else if (ServiceStatus status; !decode(event.bytes, status)) {
      collector.set_status(std::move(status));
    }
    if (number % kEventsBetweenProgress == 0 && options.progress &&
        !options.progress(log->offset(), log->size(), conversation.rows())) {
      break;
    }
  }
  conversation.give_up_all();
  return {};
}

}  // namespace buoyancy
