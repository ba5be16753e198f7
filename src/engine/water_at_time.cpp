#include "engine/water_at_time.h"

#include <cmath>

namespace buoyancy {
namespace {

// Is a received sea the same sea in both scenes?
bool is_same_medium(const Scene& a, const Scene& b) {
  return a.water().density == b.water().density && a.water().layers == b.water().layers &&
         a.water().gravity == b.water().gravity && a.water().up_W == b.water().up_W &&
         a.current() == b.current();
}

}  // namespace

void WaterAtTime::set_scene(const Scene& scene, SeaTimeline seas) noexcept {
  const bool keeps_seas = scene_->receives_sea() && scene.receives_sea() &&
                          scene_->receives_grids() == scene.receives_grids() &&
                          is_same_medium(*scene_, scene);
  if (!keeps_seas) {
    seas_ = std::move(seas);
    memory_ = {};
  }
  scene_ = &scene;
}

std::shared_ptr<const SeaPeriod> WaterAtTime::sea_at(std::int64_t utime, double lead_time) const {
  const std::shared_ptr<const SeaPeriod>* const period = seas_.at(utime, lead_time);
  return period == nullptr ? nullptr : *period;
}

WaterAtTime::Change WaterAtTime::move_to(std::int64_t utime, double lead_time) {
  if (scene_->sea() == nullptr && !scene_->receives_sea()) return {{&scene_->water(), nullptr}, false};
  const std::shared_ptr<const SeaPeriod>* const period = seas_.at(utime, lead_time);
  if (period == nullptr) return {};
  return move_to(*period, utime, lead_time);
}

WaterAtTime::Change WaterAtTime::move_to(const std::shared_ptr<const SeaPeriod>& period, std::int64_t utime,
                                         double lead_time) {
  if (!std::isfinite(lead_time)) lead_time = 0.0;
  const bool same_sea = period_ == period;
  const bool has_waves = period->sea != nullptr;
  const bool changed = !same_sea || (has_waves && (utime != utime_ || lead_time != lead_time_));
  if (changed) {
    period_.reset();  // so that a failed allocation leaves no sea of another time
    if (!has_waves) {
      waves_.reset();
    } else if (!same_sea) {
      waves_.emplace(*period->sea);
    }
    if (has_waves) waves_->set_time(utime, lead_time);
    period_ = period;
  }
  utime_ = utime;
  lead_time_ = lead_time;
  const bool moves = has_waves && waves_->amplitude_factor() > 0.0;
  return {{&period_->water, moves ? &*waves_ : nullptr}, changed};
}

}  // namespace buoyancy
