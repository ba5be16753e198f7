#include "view/common/condition_tracker.h"

namespace buoyancy::view {

ConditionTracker::ConditionTracker(const Scene& scene)
    : scene_(&scene), timeline_(scene), bodies_(timeline_.size()) {}

Expected<void> ConditionTracker::receive(Bytes message) {
  for (TrackedBody& body : bodies_) body.is_current = false;
  has_received_ = true;
  return timeline_.receive(message, *scene_);
}

std::shared_ptr<const BodyCondition> ConditionTracker::at(std::size_t body, std::int64_t utime) {
  if (scene_->bodies()[body].subdivision == nullptr) return nullptr;
  std::size_t place = 0;
  std::size_t end = timeline_.size();
  while (end - place > 1) {  // the bodies of the timeline are in the order of the scene
    const std::size_t middle = place + (end - place) / 2;
    (timeline_.body(middle) <= body ? place : end) = middle;
  }
  TrackedBody& tracked = bodies_[place];
  if (tracked.is_current && tracked.range.contains(utime)) return tracked.condition;
  tracked.is_current = true;
  tracked.range = {};
  if (!timeline_.condition_at(utime, place, *scene_, found_, tracked.range)) {
    tracked.condition = nullptr;
  } else if (tracked.condition == nullptr || *tracked.condition != found_) {
    tracked.condition = std::make_shared<const BodyCondition>(found_);
  }
  return tracked.condition;
}

}  // namespace buoyancy::view
