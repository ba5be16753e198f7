#include "messages/bot_core.h"

#include <limits>

#include "messages/wire_layout.h"

namespace buoyancy {
namespace {

// Encoded sizes [bytes], including the fingerprint.
constexpr std::size_t kPoseSize = 8 + 8 + 16 * sizeof(double);
constexpr std::size_t kRigidTransformSize = 8 + 8 + 7 * sizeof(double);
constexpr std::size_t kSixAxisForceTorqueSize = 8 + 8 + 6 * sizeof(double);

constexpr std::array<double, 3> nan_vector() {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {kNaN, kNaN, kNaN};
}

}  // namespace

tl::expected<BotPose, DecodeError> decode_bot_pose(Bytes bytes) {
  std::uint64_t fingerprint = 0;
  if (bytes.size() < sizeof fingerprint) return tl::unexpected(DecodeError::kTruncated);
  BigEndianReader reader(bytes.data());
  reader(fingerprint);
  if (fingerprint != kBotPoseFingerprint && fingerprint != kBotRigidTransformFingerprint)
    return tl::unexpected(DecodeError::kFingerprint);
  const std::size_t size = fingerprint == kBotPoseFingerprint ? kPoseSize : kRigidTransformSize;
  if (bytes.size() < size) return tl::unexpected(DecodeError::kTruncated);
  if (bytes.size() > size) return tl::unexpected(DecodeError::kLength);
  BotPose pose;
  if (fingerprint == kBotPoseFingerprint) {
    reader(pose.utime, pose.position, pose.velocity, pose.quaternion_wxyz, pose.rotation_rate);
  } else {
    reader(pose.utime, pose.position, pose.quaternion_wxyz);
    pose.velocity = nan_vector();
    pose.rotation_rate = nan_vector();
  }
  return pose;
}

tl::expected<BotForceTorque, DecodeError> decode_six_axis_force_torque(Bytes bytes) {
  std::uint64_t fingerprint = 0;
  if (bytes.size() < sizeof fingerprint) return tl::unexpected(DecodeError::kTruncated);
  BigEndianReader reader(bytes.data());
  reader(fingerprint);
  if (fingerprint != kBotForceTorqueFingerprint) return tl::unexpected(DecodeError::kFingerprint);
  if (bytes.size() < kSixAxisForceTorqueSize) return tl::unexpected(DecodeError::kTruncated);
  if (bytes.size() > kSixAxisForceTorqueSize) return tl::unexpected(DecodeError::kLength);
  BotForceTorque message;
  reader(message.utime, message.force, message.torque);
  return message;
}

void encode_six_axis_force_torque(std::int64_t utime, const std::array<double, 3>& force,
                                  const std::array<double, 3>& torque, std::vector<std::uint8_t>& bytes) {
  bytes.resize(kSixAxisForceTorqueSize);
  BigEndianWriter writer(bytes.data());
  writer(kBotForceTorqueFingerprint, utime, force, torque);
}

}  // namespace buoyancy
