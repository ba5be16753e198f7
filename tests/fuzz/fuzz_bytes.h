// Reads a fuzzer's bytes as numbers. Reads past the end return zero, so that every input is valid and a
// shorter input has a similar meaning.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/vec3.h"

namespace buoyancy {

class FuzzBytes {
 public:
  explicit FuzzBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }
  std::span<const std::uint8_t> take(std::size_t count) {
    const auto taken = bytes_.first(count < bytes_.size() ? count : bytes_.size());
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }

  std::uint8_t byte() { return number<std::uint8_t>(); }
  int small() { return static_cast<int>(std::bit_cast<std::int8_t>(byte())); }
  std::uint16_t word() { return number<std::uint16_t>(); }
  double raw_double() { return number<double>(); }
  float raw_float() { return number<float>(); }

  // An integer of eight bits plus 2^-26 times another: a position on a coarse grid or beside it by less than
  // the weld's tolerance.
  double beside_grid() {
    const double on_grid = small();
    return on_grid + std::ldexp(static_cast<double>(small()), -26);
  }

 private:
  template <typename T>
  T number() {
    const auto taken = take(sizeof(T));
    std::array<std::uint8_t, sizeof(T)> stored{};
    std::copy(taken.begin(), taken.end(), stored.begin());
    return std::bit_cast<T>(stored);
  }

  std::span<const std::uint8_t> bytes_;
};

}  // namespace buoyancy
