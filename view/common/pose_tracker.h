// Poses of other projects as an onlooker hears them. Who answers such a pose makes a question of it
// (engine/pose_request_adapter.h) whose session and number nobody else knows; but its answer repeats the
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

class HeardPoses {
 public:
  explicit HeardPoses(PoseChannels poses) : poses_(std::move(poses)) {}

  const PoseChannels& asked_on() const { return poses_; }

  // The question that a message on asked_on().channels[index] asks, with a key of our own: a session of its
  // body's, which no asker's is by any likelihood, and its utime for the number. Two poses of one body at one
  // instant are the same question. Causes: as decode_bot_pose().
  tl::expected<Question, Rejection> question(std::size_t index, Bytes pose) const;

  // The key of the question that an answer about this one body would belong to, if a pose asked it.
  // nullopt: no channel has this body's poses. O(number of channels).
  std::optional<QuestionKey> asked_by_pose(std::int32_t body_id, std::int64_t utime) const;

 private:
  PoseChannels poses_;
};

}  // namespace buoyancy
