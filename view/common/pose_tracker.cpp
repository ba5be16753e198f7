#include "view/common/pose_tracker.h"

#include <algorithm>
#include <limits>

namespace buoyancy::view {
namespace {

RequestId pose_request_id(std::int32_t body_id, std::int64_t utime) {
  constexpr std::int64_t kSessionOfBodyZero =
      std::numeric_limits<std::int64_t>::min() + (std::int64_t{1} << 32U);
  return {.utime = utime, .session_id = kSessionOfBodyZero + body_id, .seq = utime};
}

}  // namespace

tl::expected<WrenchRequest, DecodeError> PoseTracker::request(std::size_t index, Bytes pose) const {
  const tl::expected<StampedBodyState, DecodeError> decoded = decode_pose(poses_, index, pose);
  if (!decoded) return tl::unexpected(decoded.error());
  return WrenchRequest{.id = pose_request_id(decoded->state.body_id, decoded->utime),
                       .lead_time = poses_.lead_time,
                       .bodies = {decoded->state}};
}

std::optional<RequestId> PoseTracker::request_id_for_pose(std::int32_t body_id, std::int64_t utime) const {
  if (std::ranges::find(poses_.channels, body_id, &PoseChannel::body_id) == poses_.channels.end()) {
    return std::nullopt;
  }
  return pose_request_id(body_id, utime);
}

}  // namespace buoyancy::view
