// Makes a fuzzer's bytes more often a message that decodes, and its numbers more often usual ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "tests/support/byte_vector.h"

namespace buoyancy {

// Gives the packet the fingerprint of `valid`, a message of the wanted type.
inline void write_fingerprint(const ByteVector& valid, ByteVector& packet) {
  std::copy_n(valid.begin(), std::min(packet.size(), sizeof(std::int64_t)), packet.begin());
}

// Truncates the packet after the last complete item and writes the number of items.
// fixed_size: of a message without items, which ends with their number.
inline void write_count(std::size_t fixed_size, std::size_t item_size, ByteVector& packet) {
  if (packet.size() < fixed_size) return;
  const std::size_t items = (packet.size() - fixed_size) / item_size;
  packet.resize(fixed_size + items * item_size);
  for (std::size_t i = 0; i < 4; ++i) {
    packet[fixed_size - 1 - i] = static_cast<std::uint8_t>(items >> (8 * i));
  }
}

// Maps any number into a range, most numbers to another one; inside the range, to itself.
inline double folded(double value, double min, double max) {
  if (value >= min && value <= max) return value;
  const double fraction = std::isfinite(value) ? std::abs(std::remainder(value, 1.0)) : 0.25;
  return min + (max - min) * fraction;
}

}  // namespace buoyancy
