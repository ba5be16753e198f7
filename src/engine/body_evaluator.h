// Computes the wrenches on the bodies of a request, or of a part of it, and skips the work that the scene
// does not need.
//
// A body whose pose equals, bit for bit, that of its last result gets that result again; drag and added mass,
// which depend on its velocities, are added to it anew. A dry or a fully submerged body is evaluated from its
// bounds. The other bodies are computed. Large requests are shared among threads where the estimated work
// justifies it. One thread computes each body's result from that body's state alone, so the result's bits do
// not depend on the number of threads, nor on the parts that a request is divided into.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/body_evaluation.h"
#include "engine/load_evaluation.h"
#include "engine/thread_pool.h"
#include "messages/wire_views.h"

namespace buoyancy {

using Deadline = std::chrono::steady_clock::time_point;
inline constexpr Deadline kNoDeadline = Deadline::max();

inline bool has_passed(Deadline deadline) {
  return deadline != kNoDeadline && std::chrono::steady_clock::now() >= deadline;
}

class BodyEvaluator {
 public:
  // The most states of one evaluate(). A large scene is limited by memory, and several threads pay off.
  static constexpr std::size_t kMaxStates = 16'384;

  // Which states of a request to evaluate: those listed by their index, or else `count` from `first` on.
  struct States {
    std::size_t first = 0, count = 0;
    std::span<const std::uint32_t> listed;

    std::size_t size() const { return listed.empty() ? count : listed.size(); }
    std::size_t operator[](std::size_t i) const { return listed.empty() ? first + i : listed[i]; }
  };
  // Where the results go.
  struct Outputs {
    ResponseWriter response;          // of the whole request
    BodiesWriter<BodiesLoads> loads;  // with no bodies: the loads are not wanted
    std::span<const std::uint32_t>
        load_places;  // by state from `first` on: its place in loads, if it has one
  };

  // scene must outlive the evaluator or the next set_scene(). threads: see ThreadPool.
  BodyEvaluator(const Scene& scene, unsigned threads) : scene_(&scene), thread_pool_(threads) {
    set_scene(scene);
  }

  // Replaces the scene and clears the cached results. The previous scene is not accessed again. Throws
  // std::bad_alloc; then nothing has changed.
  void set_scene(const Scene& scene);

  // Sets one wrench per state: those in `water`, which must be that of the request's time, and the loads of
  // the states that have this output and get kOk. Results are cached until clear_cache(), which the caller
  // calls where the water is not that of the last request. Makes no heap allocation of its own once all
  // buffers are as large as the largest request needs. If the states contain a body more than once, it is
  // unspecified which of its poses is cached, which shows in counters.bodies_unchanged only. Returns whether
  // all states were evaluated: after the deadline no other body is begun, except the first, and those for
  // which there is time within as long as looking at all states took. Preconditions: there are at most
  // kMaxStates, and the outputs are of this request. Throws std::bad_alloc; then evaluate them again.
  bool evaluate(const RequestView& request, const States& states, const WaterState& water,
                const Outputs& outputs, ServiceCounters& counters, Deadline deadline = kNoDeadline);
  // The indices of the states that the last evaluate() has left, valid until the next one.
  std::span<const std::uint32_t> unfinished() const { return unfinished_; }

  // Discards the cached results, so that every body is evaluated anew.
  void clear_cache();

  // Replaces the condition of a body with compartments or tanks, and discards its cached result. At first a
  // body has the condition of the scene file. body: index into the scene's.
  void set_condition(std::size_t body, const BodyCondition& condition);
  // Makes the condition unknown until the next set_condition(): the body gets kBadCondition and no wrench.
  void set_condition_unknown(std::size_t body) { unknown_conditions_[body] = true; }
  // Precondition: the body has compartments or tanks.
  bool is_condition_known(std::size_t body) const { return !unknown_conditions_[body]; }
  // Returns nullptr for a body with neither compartments nor tanks.
  const BodyCondition* condition(std::size_t body) const {
    return conditions_.empty() || representative_of(body).subdivision == nullptr ? nullptr
                                                                                 : &conditions_[body];
  }

  unsigned thread_count() const { return thread_pool_.thread_count(); }
  ThreadPool& threads() { return thread_pool_; }  // for other work between two calls of evaluate()
  const Scene& scene() const { return *scene_; }

 private:
  // What bodies with the same mesh, method, tolerance and reference point share.
  struct BodyKind {
    const Body* representative = nullptr;  // one of the bodies
    FullySubmerged submerged;
    double estimated_time = 0.0;  // [ns], rough cost of a surface-piercing query
  };

  enum class Cached : std::uint8_t {
    kNothing,
    kPose,    // the bounds decided: evaluating them again is as quick as storing a result
    kResult,  // results_ holds the outcome
  };
  // What a body keeps from one request to the next. A large scene is limited by memory, so that a body
  // that does not cross the surface takes one cache line.
  struct alignas(64) LastPose {
    PoseBits pose{};
    std::uint32_t request = 0;  // number of the request that contained the body last
    Cached cached = Cached::kNothing;
  };
  static_assert(sizeof(LastPose) == 64);

  // A state whose body has to be computed.
  struct Pending {
    std::uint32_t state = 0;  // index into the request's bodies
    std::uint32_t body = 0;   // index into the scene's
    bool quaternion_normalised = false;
  };

  // What one task of a parallel loop counts on its own.
  struct alignas(64) TaskResult {
    ServiceCounters counters;
    std::uint32_t pending = 0;   // number of states that it added to pending_
    std::uint32_t repeated = 0;  // number of states that it added to repeated_
    std::size_t computed = 0;    // number of bodies that it computed, the first ones of its part
  };

  enum class EvaluationStep {
    kDone,
    kPending,   // the body has to be computed
    kRepeated,  // the request contains the body twice, and another state of it was first
  };

  void prepare_buffers(std::size_t states);
  std::size_t max_pending_tasks() const;
  // Calls task(i) for every i in [0, tasks), on several threads if that pays. time: estimated, of all [ns].
  template <typename Task>
  void run(std::size_t tasks, double time, const Task& task);

  // Evaluates the states of a chunk as far as cached results and bounds go; adds the others to pending_ and
  // repeated_.
  void evaluate_chunk(const RequestView& request, const States& states, std::size_t chunk);
  // state: the i-th of the request. Sets outcome for kDone, and pending for kPending, as well as for kDone
  // with status kOk in a scene that has loads.
  EvaluationStep evaluate_from_bounds(const BodyState& state, double lead_time, std::size_t i,
                                      Pending& pending, BodyOutcome& outcome);
  // Returns false if neither the cached result nor the bounds suffice: the body has to be computed.
  bool evaluate_from_bounds(const ValidatedPose& validated, std::size_t body, BodyOutcome& outcome);
  void compute_pending(const RequestView& request, ServiceCounters& counters, Deadline deadline);
  // Computes the bodies of at most kMaxGroup states together.
  void compute(std::span<const Pending> group, const RequestView& request, ServiceCounters& counters);
  // Sets the wrench of a state, and counts it.
  void respond(const Pending& pending, const BodyOutcome& buoyancy, const RequestView& request,
               ServiceCounters& counters);
  // Adds drag and added mass to the wrench of a body, if it has them, and sets its loads. Returns whether the
  // body is unchanged.
  bool add_loads_of(const Pending& pending, const BodyOutcome& buoyancy, const RequestView& request,
                    BodyWrench& wrench);
  const Body& representative_of(std::size_t body) const { return *kinds_[kind_of_[body]].representative; }
  // Evaluates the i-th state, whose body another state of the request has, after that one.
  void evaluate_repeated(const RequestView& request, std::size_t i, ServiceCounters& counters);

  const Scene* scene_;
  WaterState water_;  // of the current request
  ThreadPool thread_pool_;
  std::vector<BodyKind> kinds_;
  std::vector<std::uint32_t> kind_of_;     // by body: index into kinds_
  std::vector<LastPose> last_;             // by body
  std::vector<BodyOutcome> results_;       // by body
  bool has_loads_ = false;                 // does any body have drag, added mass or the loads output?
  bool needs_twists_ = false;              // has any body drag or added mass?
  std::vector<BodyTwist> last_twists_;     // by body; empty if no body has drag or added mass
  std::vector<BodyCondition> conditions_;  // by body; empty if no body has compartments or tanks
  std::vector<bool> unknown_conditions_;   // likewise
  std::uint32_t request_number_ = 0;

  // State of the current evaluate(). Chunk c's part of pending_ and repeated_ begins at its first state.
  Outputs outputs_;
  std::size_t first_state_ = 0;
  std::vector<Pending> pending_;
  std::vector<std::uint32_t> repeated_;        // indices of states
  std::vector<std::uint32_t> pending_order_;   // indices into pending_, without gaps
  std::vector<std::uint32_t> repeated_order_;  // indices into repeated_, without gaps
  std::vector<TaskResult> task_results_;
  std::vector<std::uint32_t> unfinished_;
};

}  // namespace buoyancy
