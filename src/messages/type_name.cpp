#include "messages/type_name.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>

#include <buoyancy/bodies_hydrostatics_t.hpp>
#include <buoyancy/bodies_loads_t.hpp>
#include <buoyancy/body_condition_t.hpp>
#include <buoyancy/body_states_t.hpp>
#include <buoyancy/body_wrenches_t.hpp>
#include <buoyancy/sea_grid_t.hpp>
#include <buoyancy/sea_state_t.hpp>
#include <buoyancy/service_status_t.hpp>
#include <buoyancy/water_points_t.hpp>
#include <buoyancy/water_samples_t.hpp>

#include "messages/bot_core.h"
#include "messages/wire_layout.h"

namespace buoyancy {
namespace {

template <typename Type>
std::uint64_t fingerprint_of() {
  return static_cast<std::uint64_t>(Type::getHash());
}

}  // namespace

std::string type_name(Bytes message) {
  std::uint64_t fingerprint = 0;
  if (message.size() < sizeof fingerprint) return "no fingerprint";
  BigEndianReader{message.data()}(fingerprint);
  const std::array<std::pair<std::uint64_t, const char*>, 13> known{{
      {fingerprint_of<body_states_t>(), "buoyancy.body_states_t"},
      {fingerprint_of<body_wrenches_t>(), "buoyancy.body_wrenches_t"},
      {fingerprint_of<bodies_hydrostatics_t>(), "buoyancy.bodies_hydrostatics_t"},
      {fingerprint_of<bodies_loads_t>(), "buoyancy.bodies_loads_t"},
      {fingerprint_of<body_condition_t>(), "buoyancy.body_condition_t"},
      {fingerprint_of<sea_grid_t>(), "buoyancy.sea_grid_t"},
      {fingerprint_of<sea_state_t>(), "buoyancy.sea_state_t"},
      {fingerprint_of<service_status_t>(), "buoyancy.service_status_t"},
      {fingerprint_of<water_points_t>(), "buoyancy.water_points_t"},
      {fingerprint_of<water_samples_t>(), "buoyancy.water_samples_t"},
      {kBotPoseFingerprint, "bot_core.pose_t"},
      {kBotRigidTransformFingerprint, "bot_core.rigid_transform_t"},
      {kBotForceTorqueFingerprint, "bot_core.six_axis_force_torque_t"},
  }};
  for (const auto& [type, name] : known) {
    if (type == fingerprint) return name;
  }
  std::array<char, 20> text{};
  std::snprintf(text.data(), text.size(), "0x%016llx", static_cast<unsigned long long>(fingerprint));
  return text.data();
}

}  // namespace buoyancy
