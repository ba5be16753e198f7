// The conditions of compartments and tanks of a scene's bodies, as messages on a bus or in a log change them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/error.h"
#include "engine/condition_timeline.h"
#include "messages/wire.h"
#include "scene/scene.h"

namespace buoyancy::view {

class ConditionTracker {
 public:
  // scene must outlive the tracker. O(bodies).
  explicit ConditionTracker(const Scene& scene);

  // Receives a body_condition_t. Errors: those of ConditionTimeline::receive(), some of which take effect.
  Expected<void> receive(Bytes message);
  // Was any message received, whether or not it took effect?
  bool has_received() const { return has_received_; }

  // The condition of a body of the scene, by its index, at the time of a request; the same object as before
  // as long as it is equal. nullptr: the body has neither compartments nor tanks, or its condition is unknown
  // (BodyStatus::kBadCondition). O(1) while it does not change.
  std::shared_ptr<const BodyCondition> at(std::size_t body, std::int64_t utime);

 private:
  struct TrackedBody {
    bool is_current = false;  // whether `range` and `condition` are those of the timeline
    UtimeRange range;
    std::shared_ptr<const BodyCondition> condition;  // in `range`
  };

  const Scene* scene_;
  ConditionTimeline timeline_;
  std::vector<TrackedBody> bodies_;  // in the order of the timeline
  BodyCondition found_;              // reused
  bool has_received_ = false;
};

}  // namespace buoyancy::view
