// An LCM client that shares no code with the project or with liblcm: LCM's UDP packets and message encoding,
// implemented from their definitions (the wire protocol of LCM's udpm provider; the fields of
// lcmtypes/*.lcm).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/unique_fd.h"

namespace buoyancy {

using RawBytes = std::vector<std::uint8_t>;

struct RawMessage {
  std::string channel;
  RawBytes payload;
};

// Sends to and receives from 239.255.76.67:7667 with ttl 0.
class RawLcmSocket {
 public:
  RawLcmSocket();

  // Sends one packet, or fragments if the payload is too long for one. payload: LCM-encoded bytes.
  void send(const std::string& channel, const RawBytes& payload);
  void send_packet(const RawBytes& packet);  // any bytes

  // The next message on the channel; messages on others are dropped. nullopt: none within `seconds`.
  std::optional<RawBytes> receive(const std::string& channel, double seconds);

  // The next message on any channel that has already arrived, or arrives within `seconds`.
  std::optional<RawMessage> receive_any(double seconds);

 private:
  struct Fragments {
    std::string channel;
    RawBytes payload;
    std::size_t received = 0;
  };
  std::optional<RawMessage> push_packet(const RawBytes& packet, std::uint64_t sender);

  UniqueFd sender_;
  UniqueFd receiver_;
  std::uint32_t sequence_ = 0;
  std::map<std::pair<std::uint64_t, std::uint32_t>, Fragments> incomplete_;
};

// Encodes numbers in big-endian order, as LCM does.
class RawWriter {
 public:
  RawWriter& int16(std::int16_t value) { return unsigned_number(static_cast<std::uint16_t>(value), 2); }
  RawWriter& int32(std::int32_t value) { return unsigned_number(static_cast<std::uint32_t>(value), 4); }
  RawWriter& int64(std::int64_t value) { return unsigned_number(static_cast<std::uint64_t>(value), 8); }
  RawWriter& real(double value);
  template <std::size_t kSize>
  RawWriter& reals(const std::array<double, kSize>& values) {
    for (const double value : values) real(value);
    return *this;
  }
  RawBytes bytes;

 private:
  RawWriter& unsigned_number(std::uint64_t value, int size);
};

class RawReader {
 public:
  explicit RawReader(const RawBytes& bytes) : bytes_(bytes) {}
  std::int32_t int32() { return static_cast<std::int32_t>(unsigned_number(4)); }
  std::int64_t int64() { return static_cast<std::int64_t>(unsigned_number(8)); }
  double real();
  std::size_t left() const { return bytes_.size() - position_; }

 private:
  std::uint64_t unsigned_number(std::size_t size);  // throws if bytes are missing

  const RawBytes& bytes_;
  std::size_t position_ = 0;
};

// body_states_t.lcm
struct RawState {
  std::int32_t body_id = 1;
  std::array<double, 3> position{};
  std::array<double, 4> quaternion_wxyz{1.0, 0.0, 0.0, 0.0};
  std::array<double, 3> linear_velocity{};
  std::array<double, 3> angular_velocity{};
};
struct RawStates {
  std::int64_t utime = 0;
  std::int64_t session_id = 1;
  std::int64_t seq = 0;
  double lead_time = 0.0;
  std::vector<RawState> bodies;
};
std::int64_t raw_states_fingerprint();
RawBytes encode_states(const RawStates& states);

// What all responses have in common.
template <typename Body>
struct RawResponse {
  std::int64_t utime = 0;
  std::int64_t session_id = 0;
  std::int64_t seq = 0;
  std::int32_t num_bodies = 0;
  std::vector<Body> bodies;
};

// body_wrenches_t.lcm
struct RawWrench {
  std::int32_t body_id = 0;
  std::int32_t status = 0;
  std::array<double, 3> force{};
  std::array<double, 3> torque{};
  double submerged_volume = 0.0;
  std::array<double, 3> center_of_buoyancy{};
  double force_error_bound = 0.0;
  double torque_error_bound = 0.0;
};
using RawWrenches = RawResponse<RawWrench>;
RawWrenches decode_wrenches(const RawBytes& bytes);  // throws if bytes are not such a message

// body_hydrostatics_t.lcm
struct RawBodyHydrostatics {
  std::int32_t body_id = 0;
  std::int32_t status = 0;
  double submerged_volume = 0.0;
  std::array<double, 3> center_of_buoyancy{};
  double wetted_area = 0.0;
  double waterplane_area = 0.0;
  std::array<double, 3> waterplane_centroid{};
  std::array<double, 2> waterplane_second_moments{};
  std::array<std::array<double, 3>, 2> waterplane_axes{};
  std::array<double, 2> metacentric_radii{};
  std::array<std::array<double, 3>, 2> metacenters{};
  std::array<double, 2> metacentric_heights{};
  std::array<std::array<double, 6>, 6> stiffness{};
};
using RawHydrostatics = RawResponse<RawBodyHydrostatics>;
RawHydrostatics decode_hydrostatics(const RawBytes& bytes);  // throws if bytes are not such a message

// body_loads_t.lcm
struct RawBodyLoads {
  std::int32_t body_id = 0;
  std::int32_t status = 0;
  double immersion = 0.0;
  std::array<double, 3> buoyancy_force{};
  std::array<double, 3> buoyancy_torque{};
  std::array<double, 3> drag_force{};
  std::array<double, 3> drag_torque{};
  std::array<double, 3> added_mass_force{};
  std::array<double, 3> added_mass_torque{};
  std::array<std::array<double, 6>, 6> added_mass{};
  std::array<std::array<double, 6>, 6> damping{};
  std::array<double, 3> water_velocity{};
};
using RawLoads = RawResponse<RawBodyLoads>;
RawLoads decode_loads(const RawBytes& bytes);  // throws if bytes are not such a message

}  // namespace buoyancy
