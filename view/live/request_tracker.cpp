#include "view/live/request_tracker.h"

#include <algorithm>

namespace buoyancy {

bool QuestionLedger::hear_question(const QuestionKey& key, std::int64_t utime, double now, Seq seq) {
  const Key question{key.session_id, key.seq};
  const bool is_new = note_in_session(key, now, seq);
  if (questions_.contains(question)) {
    ++counts_.questions_repeated;
    return false;
  }
  if (questions_.size() == kMostRemembered) forget_oldest();
  questions_.emplace(question, Remembered{utime, now, false});
  order_.push_back(question);
  ++(is_new ? counts_.questions : counts_.questions_repeated);
  return is_new;
}

bool QuestionLedger::note_in_session(const QuestionKey& key, double now, Seq seq) {
  const auto found = sessions_.find(key.session_id);
  if (found == sessions_.end()) {
    if (sessions_.size() == kMostSessions) {
      sessions_.erase(
          std::ranges::min_element(sessions_, {}, [](const auto& session) { return session.second.heard; }));
    }
    sessions_.emplace(key.session_id, Session{key.seq, now});
    ++counts_.sessions;
    return true;
  }
  Session& session = found->second;
  session.heard = now;
  // Without a sign: the distance of any two numbers is one.
  const std::uint64_t ahead =
      static_cast<std::uint64_t>(key.seq) - static_cast<std::uint64_t>(session.newest_seq);
  const bool is_repeat = ahead == 0;
  if (seq == Seq::kCounted && key.seq > session.newest_seq && ahead <= kLargestGap) {
    counts_.questions_missed += static_cast<std::int64_t>(ahead) - 1;
  }
  session.newest_seq = key.seq;
  return !is_repeat;
}

std::optional<double> QuestionLedger::hear_answer(const QuestionKey& key, std::int64_t utime) {
  const auto found = questions_.find({key.session_id, key.seq});
  if (found == questions_.end()) {
    ++counts_.answers_without_question;
    return std::nullopt;
  }
  Remembered& question = found->second;
  if (question.answered) {
    ++counts_.answers_repeated;
    return std::nullopt;
  }
  question.answered = true;
  ++counts_.answers;
  constexpr double kSecondsPerMicrosecond = 1e-6;
  return kSecondsPerMicrosecond * static_cast<double>(std::max<std::int64_t>(utime - question.utime, 0));
}

void QuestionLedger::give_up_old(double now) {
  while (!order_.empty() && questions_.at(order_.front()).heard + kPatience < now) forget_oldest();
}

void QuestionLedger::forget_oldest() {
  const auto oldest = questions_.find(order_.front());
  if (!oldest->second.answered) ++counts_.unanswered;
  questions_.erase(oldest);
  order_.pop_front();
}

}  // namespace buoyancy
