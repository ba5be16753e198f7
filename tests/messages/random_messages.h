// Random messages for property tests: any bit pattern in every number, NaN and infinities included.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include <rapidcheck.h>

#include "messages/hydrostatics.h"
#include "messages/loads.h"
#include "messages/request.h"
#include "messages/status.h"

namespace buoyancy {

template <typename Integer>
Integer random_integer() {
  using Limits = std::numeric_limits<Integer>;
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<Integer>(Limits::min(), Limits::max()));
}

inline double random_double() {
  return std::bit_cast<double>(random_integer<std::uint64_t>());
}

template <std::size_t kSize>
void randomise(std::array<double, kSize>& values) {
  for (double& value : values) value = random_double();
}

inline RequestId random_request_id() {
  return {.utime = random_integer<std::int64_t>(),
          .session_id = random_integer<std::int64_t>(),
          .seq = random_integer<std::int64_t>()};
}

inline WrenchRequest random_request() {
  WrenchRequest request{.id = random_request_id(), .lead_time = random_double(), .bodies = {}};
  request.bodies.resize(*rc::gen::inRange<std::size_t>(0, 6));
  for (BodyState& body : request.bodies) {
    body.body_id = random_integer<std::int32_t>();
    randomise(body.position);
    randomise(body.quaternion_wxyz);
    randomise(body.linear_velocity);
    randomise(body.angular_velocity);
  }
  return request;
}

inline WrenchResponse random_response() {
  WrenchResponse response{.id = random_request_id(), .bodies = {}};
  response.bodies.resize(*rc::gen::inRange<std::size_t>(0, 6));
  for (BodyWrench& body : response.bodies) {
    body.body_id = random_integer<std::int32_t>();
    body.status = static_cast<BodyStatus>(random_integer<std::int32_t>());
    randomise(body.force);
    randomise(body.torque);
    body.submerged_volume = random_double();
    randomise(body.center_of_buoyancy);
    body.force_error_bound = random_double();
    body.torque_error_bound = random_double();
  }
  return response;
}

inline BodiesHydrostatics random_hydrostatics() {
  BodiesHydrostatics hydrostatics{.id = random_request_id(), .bodies = {}};
  hydrostatics.bodies.resize(*rc::gen::inRange<std::size_t>(0, 6));
  for (BodyHydrostatics& body : hydrostatics.bodies) {
    body.body_id = random_integer<std::int32_t>();
    body.status = static_cast<BodyStatus>(random_integer<std::int32_t>());
    for (double* value : {&body.submerged_volume, &body.wetted_area, &body.waterplane_area}) {
      *value = random_double();
    }
    randomise(body.center_of_buoyancy);
    randomise(body.waterplane_centroid);
    randomise(body.waterplane_second_moments);
    for (auto& axis : body.waterplane_axes) randomise(axis);
    randomise(body.metacentric_radii);
    for (auto& metacenter : body.metacenters) randomise(metacenter);
    randomise(body.metacentric_heights);
    for (auto& row : body.stiffness) randomise(row);
  }
  return hydrostatics;
}

inline BodiesLoads random_loads() {
  BodiesLoads loads{.id = random_request_id(), .bodies = {}};
  loads.bodies.resize(*rc::gen::inRange<std::size_t>(0, 6));
  for (BodyLoads& body : loads.bodies) {
    body.body_id = random_integer<std::int32_t>();
    body.status = static_cast<BodyStatus>(random_integer<std::int32_t>());
    body.immersion = random_double();
    for (auto* vector : {&body.buoyancy_force, &body.buoyancy_torque, &body.drag_force, &body.drag_torque,
                         &body.added_mass_force, &body.added_mass_torque, &body.water_velocity}) {
      randomise(*vector);
    }
    for (auto& row : body.added_mass) randomise(row);
    for (auto& row : body.damping) randomise(row);
  }
  return loads;
}

}  // namespace buoyancy
