// Handles requests, for the wrenches on bodies or the water at points: takes the bytes of a request and
// returns the bytes of its response. The live service, the replay and an embedded client share it; it has no
// transport, and a clock only where begin() is given a deadline.
//
// Contract:
// - The response carries the request's (utime, session_id, seq).
// - A retry, byte for byte the session's last request, gets the same bytes back without computing, unless
//   there was no sea for its time and one has been received since then.
// - The same (session_id, seq) with other bytes is a new request.
// - A seq lower than the session's newest is handled too, and counted as stale: if it were dropped, a client
//   that starts over would get no response.
// - A new session_id starts a new session. The number of stored sessions is bounded; the least recently used
//   one is evicted, which loses only its stored response.
// - The scene may change between two requests. Sessions, counters and stored responses remain: a retry of a
//   request that the previous scene handled gets that scene's response.
// - begin() and resume() divide a request into slices, between which other requests are handled. The response
//   has the same bytes: it is that of the water at the time of its begin; if the scene or a condition of a
//   compartment or tank changes meanwhile, the request starts again.
// - What a request may cost is bounded by RequestBudgets. An allocation that fails costs the request that
//   needs it, and nothing else.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/body_evaluator.h"
#include "engine/condition_timeline.h"
#include "engine/motion_check.h"
#include "engine/sea_timeline.h"
#include "engine/water_at_time.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "scene/scene.h"

namespace buoyancy {

// What a request may cost. The default is no bound.
struct RequestBudgets {
  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

  std::size_t extra_bodies = kUnlimited;    // more than the scene has: repeated or unknown ids
  std::size_t message_bytes = kUnlimited;   // of hydrostatics and loads, larger ones are left out; of samples
                                            // of the water, requests for more points are rejected
  std::size_t retained_bytes = kUnlimited;  // of all requests in progress and all stored replies
  std::chrono::nanoseconds computing = std::chrono::nanoseconds::max();  // in its resume() calls
};

struct RequestHandlerOptions {
  std::size_t max_sessions = 64;  // >= 1; the lookup is linear
  unsigned threads = 0;           // for the bodies of one request; 0: number of hardware threads
  RequestBudgets budgets{};
  bool checks_motion = true;  // see take_findings()
};

// A state of a body whose status is not OK.
struct BodyFailure {
  std::int64_t session_id = 0;
  std::int32_t body_id = 0;
};
// The newest one of each status, indexed by BodyStatus; nullopt: there has been none.
using BodyFailures = std::array<std::optional<BodyFailure>, kBodyStatusCount>;

class RequestHandler {
 public:
  // The most requests that are in progress at a time.
  static constexpr std::size_t kMaxInProgress = 8;

  enum class Step {
    kAnswered,  // last_response() and the others have its bytes
    kRejected,  // and counted by cause
    kStarted,   // it is in progress: resume() goes on with it
    kBusy,      // not handled, nor counted: its session has another one in progress, or too many are
  };

  // scene must outlive the handler or the next set_scene().
  explicit RequestHandler(const Scene& scene, const RequestHandlerOptions& options = {});

  // Handles the request until it is complete. Returns the response's bytes, valid until the next call, or no
  // bytes if the request was rejected. A session stores the bytes of its last request, response, hydrostatics
  // and loads; there is no heap allocation once these buffers are as large as the session's largest message.
  // O(sessions + bytes), plus the bodies' queries.
  Bytes handle(Bytes request) {
    return begin(request, kNoDeadline) == Step::kAnswered ? last_response() : Bytes();
  }

  // Handles the request until the deadline, and leaves the other bodies or points in progress: a body is not
  // divided. A retry of a request in progress is counted, and answered with it.
  Step begin(Bytes request, Deadline deadline);
  // Continues a request in progress; several take turns. Precondition: in_progress() > 0.
  Step resume(Deadline deadline);
  std::size_t in_progress() const { return in_progress_.size(); }
  // The session of the request that resume() goes on with. Precondition: in_progress() > 0.
  SessionKey next_session() const { return sessions_[in_progress_.front()].key; }
  // Has the session no request in progress, and is there room for one more?
  bool has_room_for(const SessionKey& session) const;
  // Returns how many slices the last request of a session took.
  enum class Pace { kUnknown, kOneSlice, kSeveralSlices };
  Pace pace_of(const SessionKey& session) const;
  // Is it a retry of the session's last request, which begin() answers or counts without computing?
  bool is_retry(const SessionKey& session, Bytes request) const;

  // The response of the last call that was answered, valid until the next call: a body_wrenches_t, or a
  // water_samples_t if its session (last_session()) is one of points.
  Bytes last_response() const {
    return last_session_ ? Bytes(sessions_[*last_session_].last_response) : Bytes();
  }

  // The hydrostatics of that response: the bytes of a bodies_hydrostatics_t, valid until the next call. A
  // retry gets the same bytes. There are no bytes if no body of the request has this output, or if they would
  // be more than RequestBudgets::message_bytes.
  Bytes last_hydrostatics() const {
    return last_session_ ? Bytes(sessions_[*last_session_].last_hydrostatics) : Bytes();
  }

  // The loads of that response, likewise as the bytes of a bodies_loads_t.
  Bytes last_loads() const { return last_session_ ? Bytes(sessions_[*last_session_].last_loads) : Bytes(); }

  // The session of the last request. Precondition: it was answered.
  SessionKey last_session() const { return sessions_[last_session_.value()].key; }

  // Receives a sea_state_t or sea_grid_t for a scene that receives it (Scene::receives_sea()); see
  // SeaTimeline. Counts it. Errors: those of SeaTimeline::receive(); then nothing changes.
  Expected<void> receive_sea(Bytes message);
  // These receive a sea_grid_t whose surface is set elsewhere meanwhile: the memory for it, and the result.
  std::shared_ptr<ElevationSpline> spare_surface() { return water_.spare_surface(); }
  void receive_surface(const SeaGridHeader& header, std::shared_ptr<const ElevationSpline> surface) {
    water_.receive_surface(header, std::move(surface)), ++counters_.seas_received;
  }
  // The sea that holds for the latest requests; nullptr: none has been received, or the sea comes on grids.
  std::shared_ptr<const SeaPeriod> newest_sea() const {
    return water_.sea_at(std::numeric_limits<std::int64_t>::max(), 0.0);
  }
  // These are for a replay that divides a recording: they replace the seas received so far; replace them and
  // count one more received sea, which is the last of them; count a sea that could not be used.
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
  // ConditionTimeline::for_scene(). Throws std::bad_alloc; then the current scene stays in use, as it was.
  // O(bodies of both scenes), independent of their meshes.
  void set_scene(const Scene& scene);

  // Mode latest: counts a request that was superseded before it was handled.
  void record_superseded() { ++counters_.requests, ++counters_.superseded; }
  // Mode latest: counts a request that is not handled because a newer one of its session has been handled.
  void record_stale() { ++counters_.requests, ++counters_.stale; }
  // Counts a message that could not be converted into a request, by cause, like a rejected request.
  void record_rejected(DecodeError cause) { ++counters_.requests, count_decode_error(cause); }
  // These count a request that the caller does not handle because of kBusy, or for lack of memory, and a
  // retry of a request that waits.
  void record_busy() { ++counters_.requests, ++counters_.rejected_busy; }
  void record_no_memory() { ++counters_.requests, ++counters_.rejected_memory; }
  void record_retry() { ++counters_.requests, ++counters_.retries; }
  // Discards sessions and cached results; the counters stay.
  void reset();
  // The newest seq handled in the session; nullopt: unknown session.
  std::optional<std::int64_t> newest_seq(const SessionKey& session) const;

  // Returns where velocities contradicted the motion since the last call, see MotionCheck. All findings are
  // counted; of many at once only the first are kept.
  std::vector<MotionFinding> take_findings();

  const BodyFailures& newest_failures() const { return newest_failures_; }

  // Number of threads available for the bodies of one request.
  unsigned thread_count() const { return evaluator_.thread_count(); }
  const ServiceCounters& counters() const { return counters_; }
  const Scene& scene() const { return *scene_; }

 private:
  // How far a request has come.
  struct Work {
    bool in_progress = false;               // between two slices
    std::size_t next = 0;                   // the states or points before it are evaluated
    std::vector<std::uint32_t> unfinished;  // of the part from next on; empty: all of it
    bool has_failures = false;              // in that part
    std::size_t loads = 0;                  // number of loads of the states before next
    std::size_t hydrostatics_next = 0;      // the hydrostatics of the states before it are computed
    std::size_t hydrostatics = 0;           // number of them
    std::uint64_t changes = 0;              // value of changes_ at the begin
    std::shared_ptr<const SeaPeriod> sea;   // set once it is in progress; nullptr: none holds
    std::chrono::nanoseconds spent{0};      // in resume()
  };
  struct Session {
    SessionKey key{0};
    std::int64_t newest_seq = 0;
    std::int64_t last_seq = 0;
    std::uint64_t last_use = 0;              // value of use_ at the last use; the smallest is evicted first
    std::vector<std::uint8_t> last_request;  // empty: none is stored
    std::vector<std::uint8_t> last_response;
    std::vector<std::uint8_t> last_hydrostatics;  // empty: no body of the last request has this output
    std::vector<std::uint8_t> last_loads;         // likewise
    Work work;
    bool lacks_sea = false;  // last_response
    Pace pace = Pace::kUnknown;
    MotionCheck motion;
    std::size_t counted = 0;  // retained() when retained_ was updated last

    std::size_t retained() const {
      return last_request.capacity() + last_response.capacity() + last_hydrostatics.capacity() +
             last_loads.capacity() + work.unfinished.capacity() * sizeof(std::uint32_t);
    }
  };

  void count_decode_error(DecodeError error);
  void check_motion(Session& session, const RequestView& request);
  // Is it the session's last request, and is its response still that of the water at its time?
  bool is_retry(const Session& session, const RequestHeader& header, Bytes bytes) const;
  void record_failures(const RequestView& request, std::size_t begin, std::size_t end,
                       const ResponseWriter& response);
  // Evicts the least recently used session if necessary; nullptr: all have a request in progress.
  Session* start_session(const RequestHeader& first);
  // Begins a request, or begins it again. False: there is no room for what it will retain.
  bool begin_work(const RequestHeader& header, Bytes request, Session& session);
  // Runs a step of the work on a session's request, and counts the request if it is then answered, or
  // rejected because the step throws std::bad_alloc.
  template <typename Task>
  Step finish(std::size_t index, const Task& task);
  // Works on a request until it is complete, or until the deadline. Returns whether it is complete.
  bool advance(Bytes request, Session& session, const WaterAtTime::Change& now, Deadline deadline);
  bool sample_water(Bytes request, Session& session, const WaterState& water, Deadline deadline);
  bool evaluate_part(const RequestView& request, Session& session, const WaterState& water,
                     Deadline deadline);
  bool compute_hydrostatics(const RequestView& request, Session& session, Deadline deadline);
  void apply_conditions(std::int64_t utime);
  // The number of states whose body has this output.
  std::size_t count_states_with(bool Body::*output, const RequestView& request) const;
  bool make_room(Session& session, std::size_t bytes);
  void update_retained(Session& session);
  void discard_reply(Session& session);  // and frees its memory

  const Scene* scene_;
  std::size_t max_sessions_;
  RequestBudgets budgets_;
  bool checks_motion_;
  std::vector<Session> sessions_;
  std::uint64_t use_ = 0;
  ServiceCounters counters_;
  BodyEvaluator evaluator_;
  WaterAtTime water_;
  ConditionTimeline conditions_;
  // The times at which evaluator_'s conditions hold; nullopt: they are the scene file's, or outdated.
  std::optional<UtimeRange> applied_conditions_;
  BodyCondition condition_;                 // reused
  std::vector<std::uint32_t> load_places_;  // reused
  struct CachedHydrostatics {
    bool valid = false;
    PoseBits pose{};
    BodyHydrostatics hydrostatics;
  };
  std::vector<CachedHydrostatics> cached_hydrostatics_;  // by body; empty if no body has this output
  std::vector<MotionFinding> findings_;
  BodyFailures newest_failures_;
  std::optional<std::size_t>
      last_session_;                      // index into sessions_; nullopt: the last request was not answered
  std::vector<std::size_t> in_progress_;  // indices into sessions_, in the order of their turns
  std::size_t retained_ = 0;              // by all sessions [bytes]
  std::uint64_t changes_ = 0;             // of the scene and of conditions
};

}  // namespace buoyancy
