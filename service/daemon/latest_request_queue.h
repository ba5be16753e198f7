// Mode latest: of every session the newest question that waits, and nothing else.
//
// The law, per session: a question with a seq at least as high as another's is newer (of equals the last to
// arrive). An asker that starts over counts from the beginning: so is one whose seq is lower by more than
// kRestartGap, or that comes more than kRestartSilence after the other. What is lower by less and comes
// sooner was overtaken on the way and is stale. What waits when a newer one arrives is overtaken, and the
// newer one takes its place in the line: whoever asks fastest would else never be answered.
//
// Memory is bounded: by max_sessions times the largest message. Of sessions with nothing waiting the least
// recently used is forgotten, which costs only the knowledge of what would be stale.
#pragma once

#include <cstdint>
#include <vector>

#include "messages/wire.h"

namespace buoyancy {

inline constexpr std::uint64_t kRestartGap = 64;
inline constexpr double kRestartSilence = 0.2;  // s

// Is a question with seq `later`, which arrived after one with seq `earlier`, to be preferred to it?
bool supersedes(std::int64_t later, std::int64_t earlier);

class LatestQuestions {
 public:
  enum class Fate {
    kWaits,     // nothing of its session waited
    kOvertook,  // waits, in the place of an older one of its session
    kStale,     // not kept: a newer one of its session waits or was taken
    kNoRoom,    // not kept: a question waits in each of max_sessions sessions; take one and offer it again
  };

  explicit LatestQuestions(std::size_t max_sessions);  // >= 1

  // No heap once the session's buffer is as large as its largest message. arrival: seconds, on any clock; it
  // comes back with the question.
  Fate offer(const QuestionKey& key, Bytes question, double arrival);

  // Hands the question of the session that has waited longest to answer(Bytes question, double arrival); it
  // waits no longer. False: none waited. answer must not call offer.
  template <typename Answer>
  bool take_next(Answer&& answer);

  bool empty() const { return waiting_.empty(); }

 private:
  struct Session {
    std::int64_t id = 0;
    std::int64_t newest_seq = 0;  // of what waits, or else of what was taken last
    bool waits = false;
    double arrival = 0.0;  // of the same
    std::uint64_t last_use = 0;
    std::vector<std::uint8_t> question;
  };

  Session* find(std::int64_t id);
  Session* place_for_new();

  std::size_t max_sessions_;
  std::vector<Session> sessions_;
  std::vector<std::size_t> waiting_;  // indices into sessions_; the first has waited longest
  std::uint64_t use_ = 0;
};

template <typename Answer>
bool LatestQuestions::take_next(Answer&& answer) {
  if (waiting_.empty()) return false;
  Session& session = sessions_[waiting_.front()];
  waiting_.erase(waiting_.begin());
  session.waits = false;
  answer(Bytes(session.question), session.arrival);
  return true;
}

}  // namespace buoyancy
