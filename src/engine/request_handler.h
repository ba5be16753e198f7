// Handles requests: takes the bytes of a request and returns the bytes of its response. The live service, the
// replay and an embedded client share it; it has no transport and no clock.
//
// Contract:
// - The response carries the request's (utime, session_id, seq).
// - A retry, byte for byte the session's last request, gets the same bytes back without computing.
// - The same (session_id, seq) with other bytes is a new request.
// - A seq lower than the session's newest is handled too, and counted as stale: if it were dropped, a client
//   that starts over would get no response.
// - A new session_id starts a new session. The number of stored sessions is bounded; the least recently used
//   one is evicted, which loses only its stored response.
// - The scene may change between two requests. Sessions, counters and stored responses remain: a retry of a
//   request that the previous scene handled gets that scene's response.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/body_evaluator.h"
#include "engine/condition_timeline.h"
#include "engine/sea_timeline.h"
#include "engine/water_at_time.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "scene/scene.h"

namespace buoyancy {

struct RequestHandlerOptions {
  std::size_t max_sessions = 64;  // >= 1; the lookup is linear
  unsigned threads = 0;           // for the bodies of one request; 0: number of hardware threads
};

class RequestHandler {
 public:
  // scene must outlive the handler or the next set_scene().
  explicit RequestHandler(const Scene& scene, const RequestHandlerOptions& options = {});

  // Returns the response's bytes, valid until the next call, or no bytes if the request was rejected (and
  // counted by cause). A session stores the bytes of its last request, response and hydrostatics; there is no
  // heap allocation once these buffers are as large as the session's largest message. O(sessions + bytes),
  // plus the bodies' queries.
  Bytes handle(Bytes request);

  // The hydrostatics of the response that handle() last returned: the bytes of a bodies_hydrostatics_t, valid
  // until the next call of handle(). A retry gets the same bytes. There are no bytes if no body of the
  // request has this output, or if the request was rejected.
  Bytes last_hydrostatics() const {
    return last_session_ ? Bytes(sessions_[*last_session_].last_hydrostatics) : Bytes();
  }

  // Likewise the loads: the bytes of a bodies_loads_t.
  Bytes last_loads() const { return last_session_ ? Bytes(sessions_[*last_session_].last_loads) : Bytes(); }

  // The session of the last request. Precondition: handle() did not reject that request.
  std::int64_t last_session_id() const { return sessions_[last_session_.value()].id; }

  // Receives a sea_state_t for a scene whose waves are received (Scene::receives_sea()); see SeaTimeline.
  // Counts it. Errors: those of SeaTimeline::receive(); then nothing changes.
  Expected<void> receive_sea(Bytes message);
  // The one that holds for the latest requests; nullptr: none has been received.
  std::shared_ptr<const SeaPeriod> newest_sea() const {
    return water_.sea_at(std::numeric_limits<std::int64_t>::max());
  }
  // For a replay that divides a recording: replaces the seas received so far; takes over and counts one more
  // received sea, with those before it; counts a sea that could not be used.
  void set_seas(SeaTimeline seas) { water_.set_seas(std::move(seas)); }
  void receive_seas(SeaTimeline seas) { water_.set_seas(std::move(seas)), ++counters_.seas_received; }
  void record_rejected_sea() { ++counters_.seas_rejected; }

  // Receives a body_condition_t, see ConditionTimeline, and counts it. Errors: those of
  // ConditionTimeline::receive(), some of which take effect too. No heap allocation once the history of the
  // compartment or tank is as long as it gets, except for errors.
  Expected<void> receive_condition(Bytes message);
  // For a replay that divides a recording: replaces the conditions received so far.
  void set_conditions(ConditionTimeline conditions);
  const ConditionTimeline& conditions() const { return conditions_; }

  // Evaluates new requests in this scene, which must outlive the handler or the next call. The previous scene
  // is not accessed again. For received seas see WaterAtTime::set_scene(), for conditions
  // ConditionTimeline::set_scene(). O(bodies of both scenes), independent of their meshes.
  void set_scene(const Scene& scene);

  // Mode latest: counts a request that was superseded before it was handled.
  void record_superseded() { ++counters_.requests, ++counters_.superseded; }
  // Mode latest: counts a request that is not handled because a newer one of its session has been handled.
  void record_stale() { ++counters_.requests, ++counters_.stale; }
  // Counts a message that could not be converted into a request, by cause, like a rejected request.
  void record_rejected(DecodeError cause) { ++counters_.requests, count_decode_error(cause); }
  // Discards sessions and cached results; the counters stay.
  void reset();
  // The newest seq handled in the session; nullopt: unknown session.
  std::optional<std::int64_t> newest_seq(std::int64_t session_id) const;

  // Number of threads available for the bodies of one request.
  unsigned thread_count() const { return evaluator_.thread_count(); }
  const ServiceCounters& counters() const { return counters_; }
  const Scene& scene() const { return *scene_; }

 private:
  struct Session {
    std::int64_t id = 0;
    std::int64_t newest_seq = 0;
    std::int64_t last_seq = 0;
    std::uint64_t last_use = 0;  // value of use_ at the last use; the smallest is evicted first
    std::vector<std::uint8_t> last_request;
    std::vector<std::uint8_t> last_response;
    std::vector<std::uint8_t> last_hydrostatics;  // empty: no body of the last request has this output
    std::vector<std::uint8_t> last_loads;         // likewise
  };

  void count_decode_error(DecodeError error);
  Session& start_session(const RequestId& first);  // evicts the least recently used session if necessary
  void compute(Bytes bytes, const RequestView& request, Session& session);
  void apply_conditions(std::int64_t utime);
  void compute_hydrostatics(const RequestView& request, const ResponseWriter& response);
  void collect_loads(const RequestView& request, const ResponseWriter& response);

  const Scene* scene_;
  std::size_t max_sessions_;
  std::vector<Session> sessions_;
  std::uint64_t use_ = 0;
  ServiceCounters counters_;
  BodyEvaluator evaluator_;
  WaterAtTime water_;
  ConditionTimeline conditions_;
  // Where the conditions that evaluator_ has hold; nullopt: those of the scene file, or outdated ones.
  std::optional<UtimeRange> applied_conditions_;
  BodyCondition condition_;          // reused
  BodiesHydrostatics hydrostatics_;  // reused
  BodiesLoads loads_;                // reused
  struct CachedHydrostatics {
    bool valid = false;
    PoseBits pose{};
    BodyHydrostatics hydrostatics;
  };
  std::vector<CachedHydrostatics> cached_hydrostatics_;  // by body; empty if no body has this output
  std::optional<std::size_t> last_session_;  // index into sessions_; nullopt: the last request was rejected
};

}  // namespace buoyancy
