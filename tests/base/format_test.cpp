#include "base/format.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

std::string as_printf_writes(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

TEST(FormatNumber, WritesWhatPrintfDoes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (int digits = 1; digits <= 17; ++digits) {
    for (const double value : {0.0, -0.0, 1.0, 0.1, 0.5, 2.5, 99.5, 123456789.0, 1e-5, 1e-4, 1e16, 1e17,
                               5e-324, std::numeric_limits<double>::max(), kInfinity, -kInfinity}) {
      EXPECT_EQ(format_number(value, digits), as_printf_writes(value, digits));
    }
  }
  EXPECT_EQ(format_number(std::nan("")), "nan");
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    const auto value = std::bit_cast<double>(std::uint64_t{random()});
    if (!std::isfinite(value)) continue;
    const int digits = static_cast<int>(1 + random() % 17);
    EXPECT_EQ(format_number(value, digits), as_printf_writes(value, digits));
  }
}

}  // namespace
}  // namespace buoyancy
