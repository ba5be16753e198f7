// The wrenches of one question's bodies, at no more cost than the scene needs.
//
// A body whose pose is, bit for bit, that of its last answer gets that answer again. A dry body, and one that
// is wholly wet, costs its bounds. What is left is computed, on several threads where there is so much of it
// that this pays. Each body's answer is computed by one thread from its own state alone: the bits do not
// depend on how many there are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exchange/body_exchange.h"
#include "exchange/workers.h"

namespace buoyancy {

class BodyAnswers {
 public:
  // scene must outlive this. threads: as Workers has it.
  BodyAnswers(const Scene& scene, unsigned threads);

  // Fills wrenches with one per state, in the question's order. No heap of ours once all is as large as the
  // largest question.
  void answer(const Question& question, std::vector<BodyWrench>& wrenches, Counters& counters);

  unsigned threads() const { return workers_.threads(); }

 private:
  // A body's last answer that was kOk.
  struct Remembered {
    bool valid = false;
    PoseBits pose{};
    BodyOutcome outcome;
  };
  // What has to be computed.
  struct Pending {
    std::size_t state = 0;  // index into the question's bodies
    std::size_t body = 0;   // index into the scene's
    AskedPose asked;
  };

  void answer_or_postpone(const BodyState& state, double lead_time, std::size_t i);
  void compute_pending();
  void remember(std::size_t body, const Pose& pose, const BodyOutcome& outcome);

  const Scene* scene_;
  Workers workers_;
  std::vector<double> expected_time_;  // ns, by body: of a query that crosses the water, roughly
  std::vector<Remembered> remembered_;
  std::vector<BodyOutcome> outcomes_;  // of the question at hand
  std::vector<Pending> pending_;       // likewise
};

}  // namespace buoyancy
