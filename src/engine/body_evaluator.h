// Computes the wrenches on the bodies of one request and skips the work that the scene does not need.
//
// A body whose pose equals, bit for bit, that of its last result gets that result again. A dry or a fully
// submerged body is evaluated from its bounds. The other bodies are computed, on several threads where the
// estimated work justifies it. One thread computes each body's result from that body's state alone, so the
// result's bits do not depend on the number of threads.
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
  // scene must outlive the evaluator or the next set_scene(). threads: see ThreadPool.
  BodyEvaluator(const Scene& scene, unsigned threads) : scene_(&scene), thread_pool_(threads) {
    set_scene(scene);
  }

  // Replaces the scene and clears the cached results. The previous scene is not accessed again.
  void set_scene(const Scene& scene);

  // Replaces wrenches by one wrench per state, in the request's order. Makes no heap allocation of its own
  // once all buffers are as large as the largest request needs.
  void evaluate_all(const WrenchRequest& request, std::vector<BodyWrench>& wrenches,
                    ServiceCounters& counters);

  // Discards the cached results, so that every body is evaluated anew.
  void clear_cache();

  unsigned thread_count() const { return thread_pool_.thread_count(); }

 private:
  struct CachedResult {
    bool valid = false;  // outcome.status is kOk and outcome belongs to pose
    PoseBits pose{};
    BodyOutcome outcome;

    void set_pose(const Pose& evaluated);  // records the pose that outcome belongs to
  };
  // A body that compute_pending() has to compute.
  struct Pending {
    std::size_t state = 0;  // index into the request's bodies
    std::size_t body = 0;   // index into the scene's
    ValidatedPose validated;
    BodyOutcome outcome;
  };

  // Returns the outcome, valid until the next call, or nullptr after deferring the body to compute_pending().
  const BodyOutcome* evaluate_or_defer(const BodyState& state, double lead_time, std::size_t i);
  void compute_pending();
  // Index into the scene's bodies of the body with this id, which is the i-th body of the request.
  std::optional<std::size_t> find_body(std::int32_t id, std::size_t i) const;

  const Scene* scene_;
  ThreadPool thread_pool_;
  std::vector<FullySubmerged> fully_submerged_;  // by body
  std::vector<double> estimated_time_;           // [ns], by body: rough cost of a partially submerged query
  std::vector<CachedResult> cached_;             // by body
  std::vector<Pending> pending_;                 // bodies of the current request
  BodyOutcome rejected_;                         // outcome of a state with an unknown body or an invalid pose
};

}  // namespace buoyancy
