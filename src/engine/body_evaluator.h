// The wrenches of one request's bodies, at no more cost than the scene needs.
//
// A body whose pose is, bit for bit, that of its last response gets that answer again. A dry body, and one
// that is wholly wet, costs its bounds. What is left is computed, on several threads where there is so much
// of it that this pays. Each body's response is computed by one thread from its own state alone: the bits do
// not depend on how many there are.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/body_evaluation.h"
#include "engine/thread_pool.h"

namespace buoyancy {

class BodyEvaluator {
 public:
  // scene must outlive this, or be replaced by set_scene(). threads: as ThreadPool has it.
  BodyEvaluator(const Scene& scene, unsigned threads) : scene_(&scene), thread_pool_(threads) {
    set_scene(scene);
  }

  // Answers from this scene from now on and forgets the responses of the one before, which is not looked at
  // again.
  void set_scene(const Scene& scene);

  // Fills wrenches with one per state, in the request's order. No heap of ours once all is as large as the
  // largest request.
  void evaluate_all(const WrenchRequest& request, std::vector<BodyWrench>& wrenches,
                    ServiceCounters& counters);

  // No body's last response is given again.
  void clear_cache();

  unsigned thread_count() const { return thread_pool_.thread_count(); }

 private:
  // A body's last outcome.
  struct CachedResult {
    bool valid = false;  // it was kOk: the same pose gets it again
    PoseBits pose{};
    BodyOutcome outcome;

    void evaluated_at(const Pose& at);  // says that outcome is this pose's
  };
  // What has to be computed.
  struct Pending {
    std::size_t state = 0;  // index into the request's bodies
    std::size_t body = 0;   // index into the scene's
    ValidatedPose validated;
    BodyOutcome outcome;
  };

  // Valid until the next call; nullptr: left to compute_pending().
  const BodyOutcome* evaluate_or_defer(const BodyState& state, double lead_time, std::size_t i);
  void compute_pending();
  // Index into the scene's bodies of the one that a request names in place i; nullopt: there is none.
  std::optional<std::size_t> body_of(std::int32_t id, std::size_t i) const;

  const Scene* scene_;
  ThreadPool thread_pool_;
  std::vector<FullySubmerged> fully_submerged_;  // by body
  std::vector<double> expected_time_;            // ns, by body: of a query that crosses the water, roughly
  std::vector<CachedResult> cached_;
  std::vector<Pending> pending_;  // of the request at hand
  BodyOutcome refused_;           // of a state that names no body, or no pose
};

}  // namespace buoyancy
