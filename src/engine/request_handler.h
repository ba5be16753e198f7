// A question's bytes in, its answer's bytes out: what the live service, the replay and an embedded client
// share. No transport, no clock.
//
// Lock-step law: the answer carries the question's (utime, session_id, seq). A repeat, byte for byte the
// session's last question, gets the same bytes back without computing. The same (session_id, seq) with other
// bytes is a new question. A lower seq than the session's newest is answered too, and counted as stale: a
// service that dropped it would go quiet on an asker that starts over. A new session_id starts afresh.
// Sessions kept are bounded; the least recently used goes, which costs nothing but the memory of its last
// answer.
//
// The scene may be another from one question to the next. Sessions, counters and what is kept for repeats
// stay: a repeat of a question that the old scene answered gets the bytes that it got.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/body_evaluator.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "scene/scene.h"

namespace buoyancy {

struct ExchangeOptions {
  std::size_t max_sessions = 64;  // >= 1; looked up one after another
  unsigned threads = 0;  // for the bodies of one question: 1 or more; 0: as many as the processor runs
};

class Exchange {
 public:
  // scene must outlive the exchange, or be replaced by use().
  explicit Exchange(const Scene& scene, const ExchangeOptions& options = {});

  // The answer's bytes, valid until the next call; empty if the question was rejected (and counted by cause).
  // No heap once the session's buffers are as large as its largest message; a session keeps the bytes of its
  // last question, answer and hydrostatics. O(sessions + bytes) beside the bodies' queries.
  Bytes answer(Bytes question);

  // The hydrostatics that go with what answer() last returned: the bytes of a bodies_hydrostatics_t, of a
  // repeated question the same again, valid until the next call of answer(); empty where no body of the
  // question asks, or the question was rejected.
  Bytes hydrostatics() const { return answered_ ? Bytes(sessions_[*answered_].last_hydrostatics) : Bytes(); }

  // The session whose question answer() last answered; only where it did.
  std::int64_t answered_session() const { return sessions_[answered_.value()].id; }

  // Answers new questions from this scene, which must outlive the exchange or the next call; the one before
  // is not looked at again. O(bodies of both), whatever their meshes.
  void use(const Scene& scene);

  // For mode latest: counts a question that was superseded before it was answered.
  void count_overtaken() { ++counters_.questions, ++counters_.overtaken; }
  // For mode latest: a question that arrived after a newer one of its session was answered; counted, not
  // answered.
  void count_stale() { ++counters_.questions, ++counters_.stale; }
  // For bytes that should have become a question and did not: counted by cause, like a rejected question.
  void count_rejected(Rejection cause) { ++counters_.questions, count_rejection(cause); }
  // Forgets sessions and answers, as if it had just been made; what it has counted stays.
  void begin_anew();
  // The newest seq answered in the session; nullopt: no such session.
  std::optional<std::int64_t> newest_seq(std::int64_t session_id) const;

  // That a question's bodies are shared among, where there is enough to do.
  unsigned threads() const { return body_answers_.threads(); }
  const Counters& counters() const { return counters_; }
  const Scene& scene() const { return *scene_; }

 private:
  struct Session {
    std::int64_t id = 0;
    std::int64_t newest_seq = 0;
    std::int64_t last_seq = 0;
    std::uint64_t last_use = 0;  // of use_; least: forgotten first
    std::vector<std::uint8_t> last_question;
    std::vector<std::uint8_t> last_answer;
    std::vector<std::uint8_t> last_hydrostatics;  // empty: none of the last question's bodies asks
  };

  void count_rejection(Rejection rejection);
  Session& start_session(const QuestionKey& first);  // in place of the least recently used one, if need be
  void compute(Bytes question, Session& session);
  void compute_hydrostatics();

  const Scene* scene_;
  std::size_t max_sessions_;
  std::vector<Session> sessions_;
  std::uint64_t use_ = 0;
  Counters counters_;
  BodyAnswers body_answers_;
  Question question_;                // reused
  Answer answer_;                    // reused
  BodiesHydrostatics hydrostatics_;  // reused
  // By body of the scene: the last ones, and the pose that they are of.
  struct LastHydrostatics {
    bool valid = false;
    PoseBits pose{};
    BodyHydrostatics hydrostatics;
  };
  std::vector<LastHydrostatics> last_hydrostatics_;
  std::optional<std::size_t> answered_;  // the session that answer() last answered
};

}  // namespace buoyancy
