// Numbers as text that a page turns back into typed arrays without rounding.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace buoyancy {

std::string base64(std::span<const std::uint8_t> bytes);

// Of the numbers' own bytes, which are little-endian on every machine that this runs on.
template <typename T>
std::string base64_of(std::span<const T> numbers) {
  return base64({reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size_bytes()});
}

}  // namespace buoyancy
