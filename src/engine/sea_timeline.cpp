#include "engine/sea_timeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "messages/sea_state.h"

namespace buoyancy {
namespace {

// A sea_state_t begins with its fingerprint, utime and instance_id. Its content is what follows.
constexpr std::size_t kFingerprintSize = 8;
constexpr std::size_t kContentOffset = 24;

bool same_sea(Bytes a, Bytes b) {
  return a.size() == b.size() && a.size() >= kContentOffset &&
         std::ranges::equal(a.first(kFingerprintSize), b.first(kFingerprintSize)) &&
         std::ranges::equal(a.subspan(kContentOffset), b.subspan(kContentOffset));
}

Error not_a_sea(DecodeError error) {
  return {"a message of the sea", to_string(error), "the bytes of a sea_state_t of this version",
          "the sender has another version of the message, or sends another type on this channel", ""};
}

// The time of the grid with which a period ends.
std::int64_t end_of(const std::shared_ptr<const SeaPeriod>& period) {
  return period->sea->surfaces().back().utime;
}

// [us], within the range of a utime.
std::int64_t later_by(std::int64_t utime, double seconds) {
  if (!std::isfinite(seconds)) return utime;
  constexpr double kFar = 9e18;
  const double microseconds = std::clamp(std::nearbyint(1e6 * seconds), -kFar, kFar);
  std::int64_t sum = 0;
  if (!__builtin_add_overflow(utime, static_cast<std::int64_t>(microseconds), &sum)) return sum;
  return microseconds < 0.0 ? std::numeric_limits<std::int64_t>::min()
                            : std::numeric_limits<std::int64_t>::max();
}

}  // namespace

std::shared_ptr<ElevationSpline> GridMemory::surface() {
  for (const Period& pooled : periods_) {
    if (pooled.period.use_count() == 1) pooled.sea->release_surfaces();
  }
  for (const std::shared_ptr<ElevationSpline>& pooled : surfaces_) {
    if (pooled.use_count() == 1) return pooled;
  }
  return surfaces_.emplace_back(std::make_shared<ElevationSpline>());
}

std::shared_ptr<const SeaPeriod> GridMemory::period(std::int64_t from_utime,
                                                    std::span<const TimedElevation> surfaces,
                                                    const Water& water, double level) {
  const auto unused =
      std::ranges::find_if(periods_, [](const Period& pooled) { return pooled.period.use_count() == 1; });
  if (unused != periods_.end()) {
    unused->sea->set_surfaces(surfaces, level);
    unused->period->from_utime = from_utime;
    unused->period->water.level = level;
    return unused->period;
  }
  Water received = water;
  received.level = level;
  auto sea = std::make_shared<PreparedSea>(Sea::of_surfaces(surfaces, received));
  auto period = std::make_shared<SeaPeriod>(SeaPeriod{from_utime, std::move(received), sea, {}});
  return periods_.emplace_back(Period{std::move(period), std::move(sea)}).period;
}

SeaTimeline::SeaTimeline(const Scene& scene) : on_grids_(scene.receives_grids()) {
  if (on_grids_) periods_.reserve(kMaxSeas + 1);
  if (scene.receives_sea()) return;
  periods_.push_back(std::make_shared<const SeaPeriod>(
      SeaPeriod{std::numeric_limits<std::int64_t>::min(), scene.water(), scene.prepared_sea(), {}}));
}

Expected<void> SeaTimeline::receive(Bytes message, const Scene& scene, GridMemory& memory) {
  if (on_grids_) {
    std::shared_ptr<ElevationSpline> surface = memory.surface();
    Expected<void> set = set_surface(message, *surface);
    if (set) add(peek_sea_grid(message).value(), std::move(surface), scene, memory);
    return set;
  }
  const tl::expected<std::int64_t, DecodeError> utime = peek_sea_utime(message);
  if (!utime) return make_error(not_a_sea(utime.error()));
  const auto replaced =
      std::ranges::lower_bound(periods_, *utime, {}, [](const auto& period) { return period->from_utime; });
  if (replaced != periods_.begin() && same_sea((*(replaced - 1))->message, message)) {
    periods_.erase(replaced, periods_.end());
    return {};
  }
  SeaState state;
  if (const std::optional<DecodeError> error = decode(message, state)) return make_error(not_a_sea(*error));
  Expected<Sea> sea = to_sea(state, scene.water(), scene.current_W());
  if (!sea) return make_error(std::move(sea.error()));
  SeaPeriod period{*utime, sea->water(), nullptr, {message.begin(), message.end()}};
  if (!sea->is_still()) period.sea = std::make_shared<const PreparedSea>(*std::move(sea));
  periods_.erase(replaced, periods_.end());
  if (periods_.size() == kMaxSeas) periods_.erase(periods_.begin());
  periods_.push_back(std::make_shared<const SeaPeriod>(std::move(period)));
  return {};
}

void SeaTimeline::add(const SeaGridHeader& header, std::shared_ptr<const ElevationSpline> surface,
                      const Scene& scene, GridMemory& memory) {
  if (header.instance_id != instance_id_) periods_.clear();
  const auto place = std::ranges::lower_bound(periods_, header.utime, {}, end_of);
  const bool is_first = place == periods_.begin();
  const bool replaces = place != periods_.end() && end_of(*place) == header.utime;
  if (is_first && !replaces && periods_.size() == kMaxSeas) return;
  // The period that ends with a surface, over the level of that surface.
  const auto ending_with = [&](const TimedElevation& before, double level_before, const TimedElevation& last,
                               double level) {
    const std::array<TimedElevation, 2> surfaces{
        {{before.utime, before.spline, level_before - level}, {last.utime, last.spline, 0.0}}};
    return memory.period(before.utime, std::span(surfaces).last(before.spline == nullptr ? 1 : 2),
                         scene.water(), level);
  };
  const TimedElevation own{header.utime, std::move(surface)};
  const TimedElevation none{header.utime, nullptr};
  const SeaPeriod* const previous = is_first ? nullptr : (place - 1)->get();
  std::shared_ptr<const SeaPeriod> period =
      ending_with(is_first ? none : previous->sea->surfaces().back(), is_first ? 0.0 : previous->water.level,
                  own, header.level);
  const auto next = replaces ? place + 1 : place;
  if (next != periods_.end()) {
    *next = ending_with(own, header.level, (*next)->sea->surfaces().back(), (*next)->water.level);
  }
  if (replaces) {
    *place = std::move(period);
  } else {
    periods_.insert(place, std::move(period));
  }
  if (periods_.size() > kMaxSeas) periods_.erase(periods_.begin());
  instance_id_ = header.instance_id;
}

const std::shared_ptr<const SeaPeriod>* SeaTimeline::at(std::int64_t utime, double lead_time) const {
  if (on_grids_) {
    utime = later_by(utime, lead_time);
    const auto last = std::ranges::lower_bound(periods_, utime, {}, end_of);
    const bool is_known = last != periods_.end() && (last != periods_.begin() || end_of(*last) == utime);
    return is_known ? &*last : nullptr;
  }
  const auto after =
      std::ranges::upper_bound(periods_, utime, {}, [](const auto& period) { return period->from_utime; });
  return after == periods_.begin() ? nullptr : &*(after - 1);
}

}  // namespace buoyancy
