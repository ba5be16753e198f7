// Adapts bot_core messages, which carry the pose of one body per channel: converts a pose into a request for
// RequestHandler, and the response into a bot_core force and torque message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "messages/bot_core.h"
#include "messages/request.h"

namespace buoyancy {

// The frame of a pose's velocities. It matters where lead_time is not 0, and for bodies with drag or added
// mass.
enum class VelocityFrame { kWorld, kBody };

struct PoseChannel {
  std::string channel;
  std::int32_t body_id = 0;
  std::string force_torque_channel;  // for a six_axis_force_torque_t response; empty: body_wrenches_t instead
};

struct PoseChannels {
  std::vector<PoseChannel> channels;
  std::optional<VelocityFrame> velocity_frame{};  // nullopt: unknown, the velocities are unusable
  // [s], of every request. If it is not 0, a rigid_transform_t cannot be evaluated.
  double lead_time = 0.0;
};

struct StampedBodyState {
  std::int64_t utime = 0;  // [us]
  BodyState state;         // velocities in W, or unconverted if their frame is unknown
};

// Decodes a message of channel poses.channels[index]. Errors: those of decode_bot_pose().
tl::expected<StampedBodyState, DecodeError> decode_pose(const PoseChannels& poses, std::size_t index,
                                                        Bytes pose);

// What to do about poses without velocities of bodies with drag or added mass.
inline constexpr const char* kMissingVelocitiesRemedy =
    "such a body needs its velocities: without them it has the status NON_FINITE_TWIST and carries zeros. "
    "Send pose_t instead of rigid_transform_t, and give the frame of its velocities with --velocity-frame";

class PoseRequestAdapter {
 public:
  // Channel i is session first_session + i, so that each channel has its own newest request.
  PoseRequestAdapter(PoseChannels poses, std::int64_t first_session);

  const std::vector<PoseChannel>& channels() const { return poses_.channels; }
  // The channel of this session, or nullptr. O(1).
  const PoseChannel* channel_of_session(std::int64_t session_id) const;

  std::int64_t session_of(std::size_t index) const;
  std::int64_t next_seq(std::size_t index) const { return next_seq_[index]; }
  // The number of requests of this channel whose velocities cannot be used.
  std::int64_t without_velocities(std::size_t index) const { return without_velocities_[index]; }

  // Converts a message of channel channels()[index] into a request's bytes, with the pose's utime and the
  // next seq of its session. Valid until the next call. No heap allocation after the first call. Velocities
  // of a rigid_transform_t, and those of an unknown frame, are NaN in the request: a body that needs them
  // gets the status kNonFiniteTwist, never a load at velocity 0.
  tl::expected<Bytes, DecodeError> make_request(std::size_t index, Bytes pose);

 private:
  PoseChannels poses_;
  std::int64_t first_session_;
  std::vector<std::int64_t> next_seq_;            // by channel
  std::vector<std::int64_t> without_velocities_;  // by channel
  WrenchRequest request_;                         // reused
  std::vector<std::uint8_t> bytes_;               // reused
};

// Replaces bytes by a six_axis_force_torque_t: force and torque in W, about the body's reference point. It
// holds zeros if the body's status is not OK, since the type has no status field. Precondition: response is a
// body_wrenches_t of one body. decoded is a buffer that the caller keeps, so that only the first call
// allocates heap memory.
void encode_force_torque(Bytes response, WrenchResponse& decoded, std::vector<std::uint8_t>& bytes);

}  // namespace buoyancy
