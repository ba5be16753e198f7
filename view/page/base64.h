// Base64 encoding of numbers, which a page decodes into typed arrays without rounding.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace buoyancy::view {

std::string base64(std::span<const std::uint8_t> bytes);

// Encodes the numbers' bytes in memory, which are little-endian (base64.cpp asserts it).
template <typename T>
std::string base64_of(std::span<const T> numbers) {
  return base64({reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size_bytes()});
}

}  // namespace buoyancy::view
