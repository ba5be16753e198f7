// Wire bytes <-> core types. Nothing is decoded before its fingerprint, its count and its exact length fit:
// LCM's generated decoders can be killed by a packet of 20 bytes (count -1), or made to allocate gigabytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "messages/question.h"

namespace buoyancy {

inline constexpr std::string_view kStatesChannel = "BUOYANCY_STATES";
inline constexpr std::string_view kWrenchesChannel = "BUOYANCY_WRENCHES";
inline constexpr std::string_view kStatusChannel = "BUOYANCY_STATUS";

using Bytes = std::span<const std::uint8_t>;

// Why bytes are not a message of ours.
enum class Rejection { kTruncated, kFingerprint, kCount, kLength };
const char* describe(Rejection rejection);  // for logs: "shorter than the fixed fields"

// Decodes into question, whose vector is reused: no heap once it is as large as the largest message.
// On rejection question is unchanged.
std::optional<Rejection> decode(Bytes bytes, Question& question);
std::optional<Rejection> decode(Bytes bytes, Answer& answer);

// The key alone, after the same checks; cheap.
std::optional<QuestionKey> peek_key(Bytes bytes);

// Encodes into bytes, which is resized: no heap once it is as large as the largest message.
void encode(const Question& question, std::vector<std::uint8_t>& bytes);
void encode(const Answer& answer, std::vector<std::uint8_t>& bytes);

}  // namespace buoyancy
