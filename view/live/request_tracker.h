// Which answer belongs to which question, as somebody sees it who hears both pass by: pairs them by
// (session_id, seq), tells the time between them, and counts what has no partner.
//
// A question is remembered for kPatience after it was heard first, and no more than kMostRemembered are: the
// oldest goes first, given up early. Sessions are remembered for the sake of their newest seq alone; the
// least recently heard of more than kMostSessions goes. So memory is bounded whatever arrives. O(1), but for
// a new session once all places are taken: O(kMostSessions).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <unordered_map>

#include "messages/request.h"

namespace buoyancy {

class QuestionLedger {
 public:
  static constexpr double kPatience = 2.0;  // s
  static constexpr std::size_t kMostRemembered = 16'384;
  static constexpr std::size_t kMostSessions = 256;
  static constexpr std::uint64_t kLargestGap = 1'000'000;  // beyond it a seq is a new beginning, not a loss

  struct Counts {
    std::int64_t questions = 0;                 // each once, however often it was heard
    std::int64_t questions_repeated = 0;        // heard again
    std::int64_t answers = 0;                   // the first to a question
    std::int64_t answers_repeated = 0;          // any further one
    std::int64_t answers_without_question = 0;  // its question was not heard, or longer ago than kPatience
    std::int64_t unanswered = 0;                // questions given up
    std::int64_t questions_missed = 0;          // numbers left out between two questions of a session
    std::int64_t sessions = 0;                  // begun
  };

  // What seq is: counted up by one with each question of a session, so that a gap is a loss; or any number.
  enum class Seq { kCounted, kAnyNumber };

  // utime: us since 1970, when it arrived; now: s of a clock that never jumps, for kPatience. False: a
  // repeat.
  bool hear_question(const QuestionKey& key, std::int64_t utime, double now, Seq seq = Seq::kCounted);
  bool remembers(const QuestionKey& key) const { return questions_.contains({key.session_id, key.seq}); }

  // s: between the first hearing of its question and this first answer to it; 0 where the clock went back.
  // nullopt: no such question is waiting.
  std::optional<double> hear_answer(const QuestionKey& key, std::int64_t utime);

  void give_up_old(double now);

  const Counts& counts() const { return counts_; }
  std::size_t remembered() const { return questions_.size(); }

 private:
  struct Key {
    std::int64_t session_id, seq;
    bool operator==(const Key&) const = default;
  };
  struct HashKey {
    std::size_t operator()(const Key& key) const {
      return std::hash<std::int64_t>()(key.session_id) * 31 + std::hash<std::int64_t>()(key.seq);
    }
  };
  struct Remembered {
    std::int64_t utime;
    double heard;
    bool answered;
  };
  struct Session {
    std::int64_t newest_seq;
    double heard;
  };

  bool note_in_session(const QuestionKey& key, double now, Seq seq);  // false: heard before
  void forget_oldest();

  std::unordered_map<Key, Remembered, HashKey> questions_;
  std::deque<Key> order_;  // of questions_, the oldest in front
  std::unordered_map<std::int64_t, Session> sessions_;
  Counts counts_;
};

}  // namespace buoyancy
