// Encodes a message with the encoder that lcm-gen generated for it.
#pragma once

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy {

template <typename Generated>
std::vector<std::uint8_t> encoded_by_lcm(const Generated& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace buoyancy
