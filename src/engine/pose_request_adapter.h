// Bodies whose poses come one by one, each on a channel of its own, as bot_core's messages have them: such a
// pose turned into a request for RequestHandler, and the response turned into the message that goes back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "messages/bot_core.h"
#include "messages/request.h"

namespace buoyancy {

// What a pose's velocities are given in. Read only where lead_time is not 0.
enum class VelocityFrame { kWorld, kBody };

struct PoseChannel {
  std::string channel;
  std::int32_t body_id = 0;
  std::string force_torque_channel;  // of the response, as six_axis_force_torque_t; empty: as body_wrenches_t
};

struct PoseChannels {
  std::vector<PoseChannel> channels;
  std::optional<VelocityFrame> velocity_frame{};  // nullopt: not known, velocities mean nothing
  double lead_time = 0.0;  // s, of every request; not 0: a rigid_transform_t cannot be answered
};

// What a pose says of its body.
struct StampedBodyState {
  std::int64_t utime = 0;  // us
  BodyState state;         // velocities in W; as they stand where their frame is not known
};

// What a message on poses.channels[index] says. Causes: as decode_bot_pose().
tl::expected<StampedBodyState, DecodeError> decode_pose(const PoseChannels& poses, std::size_t index,
                                                        Bytes pose);

class PoseRequestAdapter {
 public:
  // Channel i asks as session first_session + i, so that each has its own newest request.
  PoseRequestAdapter(PoseChannels poses, std::int64_t first_session);

  const std::vector<PoseChannel>& channels() const { return poses_.channels; }
  // The channel whose poses ask in this session; nullptr: none. O(1).
  const PoseChannel* channel_of_session(std::int64_t session_id) const;

  // The request that a message on channels()[index] asks, with the pose's utime and the next seq of its
  // session; valid until the next call. No heap after the first.
  tl::expected<Bytes, DecodeError> request(std::size_t index, Bytes pose);

 private:
  PoseChannels poses_;
  std::int64_t first_session_;
  std::vector<std::int64_t> asked_;  // by channel
  WrenchRequest request_;            // reused
  std::vector<std::uint8_t> bytes_;  // reused
};

// Replaces bytes by a six_axis_force_torque_t of the one body that answer, the bytes of a body_wrenches_t, is
// about: force and torque in W, about the body's reference point. Of a body that is not OK zeros, as in the
// answer: the type has no place for a status.
// read is room for the decoded answer, for the caller to keep: no heap after the first.
void encode_force_torque(Bytes response, WrenchResponse& read, std::vector<std::uint8_t>& bytes);

}  // namespace buoyancy
