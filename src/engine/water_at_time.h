// Gives the water of a scene at the times of successive requests: at rest, or with the waves of each time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "engine/body_evaluation.h"
#include "engine/sea_timeline.h"
#include "scene/scene.h"

namespace buoyancy {

class WaterAtTime {
 public:
  // scene must outlive this object or the next set_scene().
  explicit WaterAtTime(const Scene& scene) : scene_(&scene), seas_(scene) {}

  // Received seas remain where both scenes receive them, in the same messages, and agree about the water's
  // densities, up, gravity and current; else `seas`, those of the new scene, hold. The previous scene is not
  // accessed again.
  void set_scene(const Scene& scene, SeaTimeline seas) noexcept;

  // See SeaTimeline::receive().
  Expected<void> receive_sea(Bytes message) { return seas_.receive(message, *scene_, memory_); }
  // A surface for receive_surface(), see GridMemory::surface().
  std::shared_ptr<ElevationSpline> spare_surface() { return memory_.surface(); }
  // See SeaTimeline::add().
  void receive_surface(const SeaGridHeader& header, std::shared_ptr<const ElevationSpline> surface) {
    seas_.add(header, std::move(surface), *scene_, memory_);
  }
  void set_seas(SeaTimeline seas) { seas_ = std::move(seas); }
  // The sea that holds at this time, see SeaTimeline::at(); nullptr: none is known for it, or the scene's
  // water is at rest.
  std::shared_ptr<const SeaPeriod> sea_at(std::int64_t utime, double lead_time) const;

  struct Change {
    WaterState water;
    bool changed = false;  // is it another water than that of the last call?
  };
  // Moves to this time. utime: [us]; lead_time: [s], added to it; one that is not finite counts as 0. The
  // result is valid until the next call of a member. No heap allocation for the sea of the last call.
  // Complexity: O(components) where the time changes.
  Change move_to(std::int64_t utime, double lead_time);
  // Moves to this time in a sea that sea_at() returned, even if it has been replaced since then.
  Change move_to(const std::shared_ptr<const SeaPeriod>& period, std::int64_t utime, double lead_time);

 private:
  const Scene* scene_;
  GridMemory memory_;
  SeaTimeline seas_;
  // These belong to the last call of move_to().
  std::shared_ptr<const SeaPeriod> period_;
  std::optional<SeaAtTime> waves_;  // of its sea, if that has waves
  std::int64_t utime_ = 0;
  double lead_time_ = 0.0;
};

}  // namespace buoyancy
