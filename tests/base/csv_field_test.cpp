#include "base/csv_field.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

void expect_as_to_chars_writes(double value) {
  std::array<char, kMaxNumberLength> written{};
  std::array<char, kMaxNumberLength> expected{};
  char* const end = write_number(value, written.data());
  const auto to = std::to_chars(expected.data(), expected.data() + expected.size(), value,
                                std::chars_format::general, 17);
  ASSERT_EQ(std::string(written.data(), end), std::string(expected.data(), to.ptr));
}

TEST(WriteNumber, WritesWhatToCharsDoes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, 1.0, 0.1, 2.5, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308,
                             kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    expect_as_to_chars_writes(value);
    expect_as_to_chars_writes(-value);
  }
  // Powers of ten and their neighbours, and powers of two, of which many end in a tie.
  for (int exponent = -20; exponent <= 20; ++exponent) {
    const double power = std::pow(10.0, exponent);
    for (const double value : {std::nextafter(power, 0.0), power, std::nextafter(power, kInfinity)})
      expect_as_to_chars_writes(value);
  }
  for (int exponent = -80; exponent <= 80; ++exponent) {
    for (int odd = 1; odd < 200; odd += 2) expect_as_to_chars_writes(std::ldexp(odd, exponent));
  }
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-13.0, 18.0);
  for (int i = 0; i < 100'000; ++i) {
    const double value = std::pow(10.0, exponent(random));
    expect_as_to_chars_writes(value);
    expect_as_to_chars_writes(std::floor(value) + 0.5);
    expect_as_to_chars_writes(std::bit_cast<double>(random()));
  }
}

TEST(CsvFields, AreTrimmed) {
  CsvFields fields(" 1\t, b c ,, \r");
  for (const std::string_view expected : {"1", "b c", "", ""}) EXPECT_EQ(fields.next(), expected);
  EXPECT_EQ(fields.next(), std::nullopt);
  EXPECT_EQ(trim(" \t\r"), "");
}

}  // namespace
}  // namespace buoyancy
