#include "engine/pose_request_adapter.h"

#include <cassert>
#include <utility>

#include <Eigen/Geometry>

#include "messages/conversions.h"

namespace buoyancy {
namespace {

std::array<double, 3> to_world(const std::array<double, 4>& q_WB, const std::array<double, 3>& v_B) {
  const auto& [w, x, y, z] = q_WB;
  return as_array(Eigen::Quaterniond(w, x, y, z).normalized() * as_vec3(v_B));
}

}  // namespace

tl::expected<PosedBody, Rejection> posed_body(const PoseChannels& poses, std::size_t index, Bytes pose) {
  const tl::expected<BotPose, Rejection> read = decode_bot_pose(pose);
  if (!read) return tl::unexpected(read.error());
  PosedBody posed{read->utime,
                  {poses.channels[index].body_id, read->position, read->quaternion_wxyz, read->velocity,
                   read->rotation_rate}};
  if (poses.velocity_frame == VelocityFrame::kBody) {
    posed.state.linear_velocity = to_world(read->quaternion_wxyz, read->velocity);
    posed.state.angular_velocity = to_world(read->quaternion_wxyz, read->rotation_rate);
  }
  return posed;
}

PoseQuestions::PoseQuestions(PoseChannels poses, std::int64_t first_session)
    : poses_(std::move(poses)), first_session_(first_session), asked_(poses_.channels.size()) {
  question_.lead_time = poses_.lead_time;
  question_.bodies.resize(1);
}

const PoseChannel* PoseQuestions::asks_in(std::int64_t session_id) const {
  const std::uint64_t index =
      static_cast<std::uint64_t>(session_id) - static_cast<std::uint64_t>(first_session_);
  return index < poses_.channels.size() ? &poses_.channels[index] : nullptr;
}

tl::expected<Bytes, Rejection> PoseQuestions::question(std::size_t index, Bytes pose) {
  const tl::expected<PosedBody, Rejection> posed = posed_body(poses_, index, pose);
  if (!posed) return tl::unexpected(posed.error());
  const auto session = static_cast<std::uint64_t>(first_session_) + index;
  question_.key = {posed->utime, static_cast<std::int64_t>(session), asked_[index]++};
  question_.bodies.front() = posed->state;
  encode(question_, bytes_);
  return Bytes(bytes_);
}

void force_torque_of(Bytes answer, Answer& read, std::vector<std::uint8_t>& bytes) {
  [[maybe_unused]] const auto rejected = decode(answer, read);
  assert(!rejected && read.bodies.size() == 1);
  const BodyWrench& wrench = read.bodies.front();
  encode_six_axis_force_torque(read.key.utime, wrench.force, wrench.torque, bytes);
}

}  // namespace buoyancy
