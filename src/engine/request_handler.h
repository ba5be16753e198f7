// A request's bytes in, its response's bytes out: what the live service, the replay and an embedded client
// share. No transport, no clock.
//
// Lock-step law: the response carries the request's (utime, session_id, seq). A repeat, byte for byte the
// session's last request, gets the same bytes back without computing. The same (session_id, seq) with other
// bytes is a new request. A lower seq than the session's newest is answered too, and counted as stale: a
// service that dropped it would go quiet on a client that starts over. A new session_id starts afresh.
// Sessions kept are bounded; the least recently used goes, which costs nothing but the memory of its last
// answer.
//
// The scene may be another from one request to the next. Sessions, counters and what is kept for repeats
// stay: a repeat of a request that the old scene answered gets the bytes that it got.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/body_evaluator.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "scene/scene.h"

namespace buoyancy {

struct RequestHandlerOptions {
  std::size_t max_sessions = 64;  // >= 1; looked up one after another
  unsigned threads = 0;  // for the bodies of one request: 1 or more; 0: as many as the processor runs
};

class RequestHandler {
 public:
  // scene must outlive the handler, or be replaced by set_scene().
  explicit RequestHandler(const Scene& scene, const RequestHandlerOptions& options = {});

  // The response's bytes, valid until the next call; empty if the request was rejected (and counted by
  // cause). No heap once the session's buffers are as large as its largest message; a session keeps the bytes
  // of its last request, answer and hydrostatics. O(sessions + bytes) beside the bodies' queries.
  Bytes handle(Bytes request);

  // The hydrostatics that go with what handle() last returned: the bytes of a bodies_hydrostatics_t, of a
  // repeated request the same again, valid until the next call of handle(); empty where no body of the
  // request asks, or the request was rejected.
  Bytes last_hydrostatics() const {
    return answered_ ? Bytes(sessions_[*answered_].last_hydrostatics) : Bytes();
  }

  // The session whose request handle() last answered; only where it did.
  std::int64_t last_session_id() const { return sessions_[answered_.value()].id; }

  // Answers new requests from this scene, which must outlive the handler or the next call; the one before
  // is not looked at again. O(bodies of both), whatever their meshes.
  void set_scene(const Scene& scene);

  // For mode latest: counts a request that was superseded before it was answered.
  void record_superseded() { ++counters_.requests, ++counters_.superseded; }
  // For mode latest: a request that arrived after a newer one of its session was answered; counted, not
  // answered.
  void record_stale() { ++counters_.requests, ++counters_.stale; }
  // For bytes that should have become a request and did not: counted by cause, like a rejected request.
  void record_rejected(DecodeError cause) { ++counters_.requests, count_decode_error(cause); }
  // Forgets sessions and answers, as if it had just been made; what it has counted stays.
  void reset();
  // The newest seq answered in the session; nullopt: no such session.
  std::optional<std::int64_t> newest_seq(std::int64_t session_id) const;

  // That a request's bodies are shared among, where there is enough to do.
  unsigned thread_count() const { return evaluator_.thread_count(); }
  const ServiceCounters& counters() const { return counters_; }
  const Scene& scene() const { return *scene_; }

 private:
  struct Session {
    std::int64_t id = 0;
    std::int64_t newest_seq = 0;
    std::int64_t last_seq = 0;
    std::uint64_t last_use = 0;  // of use_; least: forgotten first
    std::vector<std::uint8_t> last_request;
    std::vector<std::uint8_t> last_response;
    std::vector<std::uint8_t> last_hydrostatics;  // empty: none of the last request's bodies asks
  };

  void count_decode_error(DecodeError rejection);
  Session& start_session(const RequestId& first);  // in place of the least recently used one, if need be
  void compute(Bytes request, Session& session);
  void compute_hydrostatics();

  const Scene* scene_;
  std::size_t max_sessions_;
  std::vector<Session> sessions_;
  std::uint64_t use_ = 0;
  ServiceCounters counters_;
  BodyEvaluator evaluator_;
  WrenchRequest request_;            // reused
  WrenchResponse response_;          // reused
  BodiesHydrostatics hydrostatics_;  // reused
  // By body of the scene: the last ones, and the pose that they are of.
  struct LastHydrostatics {
    bool valid = false;
    PoseBits pose{};
    BodyHydrostatics hydrostatics;
  };
  std::vector<LastHydrostatics> last_hydrostatics_;
  std::optional<std::size_t> answered_;  // the session that handle() last answered
};

}  // namespace buoyancy
