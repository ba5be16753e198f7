// Wire bytes <-> core types. Nothing is decoded before its fingerprint, its count and its exact length fit:
// LCM's generated decoders can be killed by a packet of 20 bytes (count -1), or made to allocate gigabytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "messages/hydrostatics.h"
#include "messages/request.h"

namespace buoyancy {

inline constexpr std::string_view kStatesChannel = "BUOYANCY_STATES";
inline constexpr std::string_view kWrenchesChannel = "BUOYANCY_WRENCHES";
inline constexpr std::string_view kHydrostaticsChannel = "BUOYANCY_HYDROSTATICS";
inline constexpr std::string_view kStatusChannel = "BUOYANCY_STATUS";

using Bytes = std::span<const std::uint8_t>;

// Why bytes are not a message of ours: the first of these that holds.
enum class DecodeError {
  kTruncated,    // shorter than the fixed fields
  kFingerprint,  // of another type, or of another version of the type
  kCount,        // the number of bodies is negative, or a string is shorter than its final NUL
  kLength,       // too short or too long for the count, or a string that ends elsewhere than its length says
};
const char* to_string(DecodeError rejection);  // for logs: "shorter than the fixed fields"

// Decodes into request, whose vector is reused: no heap once it is as large as the largest message.
// On rejection request is unchanged. The same of the others. Values are not judged: numbers may be NaN, an
// answer's status may be one that this version does not know. O(length).
std::optional<DecodeError> decode(Bytes bytes, WrenchRequest& request);
std::optional<DecodeError> decode(Bytes bytes, WrenchResponse& response);
std::optional<DecodeError> decode(Bytes bytes, BodiesHydrostatics& hydrostatics);

// A request's key alone, after the same checks; O(1).
tl::expected<RequestId, DecodeError> peek_request_id(Bytes bytes);

// Encodes into bytes, which is resized: no heap once it is as large as the largest message.
void encode(const WrenchRequest& request, std::vector<std::uint8_t>& bytes);
void encode(const WrenchResponse& response, std::vector<std::uint8_t>& bytes);
void encode(const BodiesHydrostatics& hydrostatics, std::vector<std::uint8_t>& bytes);

}  // namespace buoyancy
