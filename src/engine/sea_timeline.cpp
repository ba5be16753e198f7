#include "engine/sea_timeline.h"

#include <algorithm>
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

}  // namespace

SeaTimeline::SeaTimeline(const Scene& scene) {
  if (scene.receives_sea()) return;
  periods_.push_back(std::make_shared<const SeaPeriod>(
      SeaPeriod{std::numeric_limits<std::int64_t>::min(), scene.water(), scene.prepared_sea(), {}}));
}

Expected<void> SeaTimeline::receive(Bytes message, const Scene& scene) {
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

const std::shared_ptr<const SeaPeriod>* SeaTimeline::at(std::int64_t utime) const {
  const auto after =
      std::ranges::upper_bound(periods_, utime, {}, [](const auto& period) { return period->from_utime; });
  return after == periods_.begin() ? nullptr : &*(after - 1);
}

}  // namespace buoyancy
