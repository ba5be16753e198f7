// The wrenches of one question's bodies, at no more cost than the scene needs.
//
// A body whose pose is, bit for bit, that of its last answer gets that answer again. A dry body, and one that
// is wholly wet, costs its bounds. What is left is computed, on several threads where there is so much of it
// that this pays. Each body's answer is computed by one thread from its own state alone: the bits do not
// depend on how many there are.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/body_evaluation.h"
#include "engine/thread_pool.h"

namespace buoyancy {

class BodyAnswers {
 public:
  // scene must outlive this, or be replaced by use(). threads: as Workers has it.
  BodyAnswers(const Scene& scene, unsigned threads) : scene_(&scene), workers_(threads) { use(scene); }

  // Answers from this scene from now on and forgets the answers of the one before, which is not looked at
  // again.
  void use(const Scene& scene);

  // Fills wrenches with one per state, in the question's order. No heap of ours once all is as large as the
  // largest question.
  void answer(const Question& question, std::vector<BodyWrench>& wrenches, Counters& counters);

  // No body's last answer is given again.
  void forget();

  unsigned threads() const { return workers_.threads(); }

 private:
  // A body's last outcome.
  struct Remembered {
    bool valid = false;  // it was kOk: the same pose gets it again
    PoseBits pose{};
    BodyOutcome outcome;

    void evaluated_at(const Pose& at);  // says that outcome is this pose's
  };
  // What has to be computed.
  struct Pending {
    std::size_t state = 0;  // index into the question's bodies
    std::size_t body = 0;   // index into the scene's
    AskedPose asked;
    BodyOutcome outcome;
  };

  // Valid until the next call; nullptr: left to compute_pending().
  const BodyOutcome* answer_or_postpone(const BodyState& state, double lead_time, std::size_t i);
  void compute_pending();
  // Index into the scene's bodies of the one that a question names in place i; nullopt: there is none.
  std::optional<std::size_t> body_of(std::int32_t id, std::size_t i) const;

  const Scene* scene_;
  Workers workers_;
  std::vector<WhollyWet> wholly_wet_;  // by body
  std::vector<double> expected_time_;  // ns, by body: of a query that crosses the water, roughly
  std::vector<Remembered> remembered_;
  std::vector<Pending> pending_;  // of the question at hand
  BodyOutcome refused_;           // of a state that names no body, or no pose
};

}  // namespace buoyancy
