// Poses of other projects as an onlooker hears them. Who answers such a pose makes a request of it
// (engine/pose_request_adapter.h) whose session and number nobody else knows; but its response repeats the
// pose's utime. So a pose is known here by its body and that.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/pose_request_adapter.h"
#include "messages/bot_core.h"
#include "messages/request.h"

namespace buoyancy {

class PoseTracker {
 public:
  explicit PoseTracker(PoseChannels poses) : poses_(std::move(poses)) {}

  const PoseChannels& channels() const { return poses_; }

  // The request that a message on channels().channels[index] asks, with a key of our own: a session of its
  // body's, which no client's is by any likelihood, and its utime for the number. Two poses of one body at
  // one instant are the same request. Causes: as decode_bot_pose().
  tl::expected<WrenchRequest, DecodeError> request(std::size_t index, Bytes pose) const;

  // The key of the request that a response about this one body would belong to, if a pose asked it.
  // nullopt: no channel has this body's poses. O(number of channels).
  std::optional<RequestId> request_id_for_pose(std::int32_t body_id, std::int64_t utime) const;

 private:
  PoseChannels poses_;
};

}  // namespace buoyancy
