#include "engine/pose_request_adapter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "messages/conversions.h"

namespace buoyancy {
namespace {

bool has_velocities(const BodyState& state) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::ranges::all_of(state.linear_velocity, finite) &&
         std::ranges::all_of(state.angular_velocity, finite);
}

}  // namespace

tl::expected<StampedBodyState, DecodeError> decode_pose(const PoseChannels& poses, std::size_t index,
                                                        Bytes pose) {
  const tl::expected<BotPose, DecodeError> decoded = decode_bot_pose(pose);
  if (!decoded) return tl::unexpected(decoded.error());
  StampedBodyState stamped{decoded->utime,
                           {poses.channels[index].body_id, decoded->position, decoded->quaternion_wxyz,
                            decoded->velocity, decoded->rotation_rate}};
  if (poses.velocity_frame == VelocityFrame::kBody) {
    stamped.state.linear_velocity = to_world(decoded->quaternion_wxyz, decoded->velocity);
    stamped.state.angular_velocity = to_world(decoded->quaternion_wxyz, decoded->rotation_rate);
  }
  return stamped;
}

PoseRequestAdapter::PoseRequestAdapter(PoseChannels poses, std::int64_t first_session)
    : poses_(std::move(poses)),
      first_session_(first_session),
      next_seq_(poses_.channels.size()),
      without_velocities_(poses_.channels.size()) {
  request_.lead_time = poses_.lead_time;
  request_.bodies.resize(1);
}

const PoseChannel* PoseRequestAdapter::channel_of_session(std::int64_t session_id) const {
  const std::uint64_t index =
      static_cast<std::uint64_t>(session_id) - static_cast<std::uint64_t>(first_session_);
  return index < poses_.channels.size() ? &poses_.channels[index] : nullptr;
}

std::int64_t PoseRequestAdapter::session_of(std::size_t index) const {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(first_session_) + index);
}

tl::expected<Bytes, DecodeError> PoseRequestAdapter::make_request(std::size_t index, Bytes pose) {
  const tl::expected<StampedBodyState, DecodeError> stamped = decode_pose(poses_, index, pose);
  if (!stamped) return tl::unexpected(stamped.error());
  request_.id = {stamped->utime, session_of(index), next_seq_[index]++};
  BodyState& state = request_.bodies.front();
  state = stamped->state;
  if (!poses_.velocity_frame) {
    state.linear_velocity.fill(std::numeric_limits<double>::quiet_NaN());
    state.angular_velocity = state.linear_velocity;
  }
  if (!has_velocities(state)) ++without_velocities_[index];
  encode(request_, bytes_);
  return Bytes(bytes_);
}

void encode_force_torque(Bytes response, WrenchResponse& decoded, std::vector<std::uint8_t>& bytes) {
  [[maybe_unused]] const auto error = decode(response, decoded);
  assert(!error && decoded.bodies.size() == 1);
  const BodyWrench& wrench = decoded.bodies.front();
  encode_six_axis_force_torque(decoded.id.utime, wrench.force, wrench.torque, bytes);
}

}  // namespace buoyancy
