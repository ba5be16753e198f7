// Identifies requests that other projects send as poses. The service converts such a pose into a request
// (engine/pose_request_adapter.h) whose session_id and seq an observer does not know, but the response
// repeats the pose's utime. A pose is therefore identified by its body and its utime.
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

namespace buoyancy::view {

class PoseTracker {
 public:
  explicit PoseTracker(PoseChannels poses) : poses_(std::move(poses)) {}

  const PoseChannels& channels() const { return poses_; }

  // Converts a message on channels().channels[index] to a request. Its session_id is derived from the body's
  // id and is unlikely to be a client's; its seq is the pose's utime, so two poses of one body with the same
  // utime are the same request. Errors: see decode_bot_pose().
  tl::expected<WrenchRequest, DecodeError> request(std::size_t index, Bytes pose) const;

  // The id of the request that a response about this one body belongs to if a pose caused it.
  // nullopt: no channel carries this body's poses. O(number of channels).
  std::optional<RequestId> request_id_for_pose(std::int32_t body_id, std::int64_t utime) const;

 private:
  PoseChannels poses_;
};

}  // namespace buoyancy::view
