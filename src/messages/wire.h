// Converts between wire bytes and core types. A message is decoded only after its fingerprint, its count and
// its exact length have been checked: a 20-byte packet (count -1) can crash LCM's generated decoders, or make
// them allocate gigabytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "messages/hydrostatics.h"
#include "messages/loads.h"
#include "messages/request.h"
#include "messages/water_samples.h"

namespace buoyancy {

inline constexpr std::string_view kStatesChannel = "BUOYANCY_STATES";
inline constexpr std::string_view kWrenchesChannel = "BUOYANCY_WRENCHES";
inline constexpr std::string_view kHydrostaticsChannel = "BUOYANCY_HYDROSTATICS";
inline constexpr std::string_view kLoadsChannel = "BUOYANCY_LOADS";
inline constexpr std::string_view kStatusChannel = "BUOYANCY_STATUS";
inline constexpr std::string_view kSeaChannel = "BUOYANCY_SEA";
inline constexpr std::string_view kSeaGridChannel = "BUOYANCY_SEA_GRID";
inline constexpr std::string_view kWaterPointsChannel = "BUOYANCY_WATER_POINTS";
inline constexpr std::string_view kWaterSamplesChannel = "BUOYANCY_WATER_SAMPLES";
inline constexpr std::string_view kConditionChannel = "BUOYANCY_CONDITION";

using Bytes = std::span<const std::uint8_t>;

// The reasons why bytes are not a message of the expected type. The first one that applies is reported.
enum class DecodeError {
  kTruncated,    // shorter than the fixed fields
  kFingerprint,  // another type, or another version of the type
  kCount,        // the number of bodies, points or wave components is negative or, of the latter, above the
                 // maximum; or rows and columns are out of range; or a string is shorter than its final NUL
  kLength,       // too short or too long for the count, or a string does not end at its stated length
};
const char* to_string(DecodeError error);  // for logs: "shorter than the fixed fields"

// Decode into the second argument, whose vector is reused: no heap allocation once its capacity suffices for
// the largest message. On an error, the second argument is unchanged. Values are not validated: numbers may
// be NaN, and a status may be unknown to this version. O(length).
std::optional<DecodeError> decode(Bytes bytes, WrenchRequest& request);
std::optional<DecodeError> decode(Bytes bytes, WrenchResponse& response);
std::optional<DecodeError> decode(Bytes bytes, BodiesHydrostatics& hydrostatics);
std::optional<DecodeError> decode(Bytes bytes, BodiesLoads& loads);
std::optional<DecodeError> decode(Bytes bytes, WaterPoints& points);
std::optional<DecodeError> decode(Bytes bytes, WaterSamples& samples);

// Makes the same checks and decodes the request's id only. O(1).
tl::expected<RequestId, DecodeError> peek_request_id(Bytes bytes);
// The same for a request of any kind, which its fingerprint tells; of another fingerprint, the error is that
// of a body_states_t.
tl::expected<RequestHeader, DecodeError> peek_request(Bytes bytes);

// Sizes [bytes] of encoded messages with this number of bodies or points.
std::size_t request_size(std::size_t bodies);
std::size_t response_size(std::size_t bodies);
std::size_t hydrostatics_size(std::size_t bodies);
std::size_t loads_size(std::size_t bodies);
std::size_t water_points_size(std::size_t points);
std::size_t water_samples_size(std::size_t points);

// Replace bytes by the encoded message: no heap allocation once its capacity suffices for the largest
// message.
void encode(const BorrowedRequest& request, std::vector<std::uint8_t>& bytes);
void encode(const WrenchResponse& response, std::vector<std::uint8_t>& bytes);
void encode(const BodiesHydrostatics& hydrostatics, std::vector<std::uint8_t>& bytes);
void encode(const BodiesLoads& loads, std::vector<std::uint8_t>& bytes);
void encode(const BorrowedWaterPoints& points, std::vector<std::uint8_t>& bytes);

// Reads the id of an encoded WrenchResponse, BodiesHydrostatics, BodiesLoads or WaterSamples, or changes its
// seq.
// Precondition: bytes hold such a message, or at least kResponseHeaderSize bytes. O(1).
inline constexpr std::size_t kResponseHeaderSize = 32;  // [bytes], fingerprint and id
RequestId response_id(Bytes bytes);
void set_response_seq(std::int64_t seq, std::span<std::uint8_t> bytes);

}  // namespace buoyancy
