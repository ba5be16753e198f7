#include "base/csv_field.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace buoyancy {
namespace {

constexpr int kDigits = 17;
constexpr std::uint64_t kTooManyDigits = 100'000'000'000'000'000;  // 10^kDigits
// Numbers within this range are their 17 digits times a power of ten that kPowersOfFive can scale.
constexpr double kMinExact = 0x1p-36;
constexpr double kMaxExact = 1e17;

constexpr std::array<std::uint64_t, 28> kPowersOfFive = [] {  // all that 63 bits hold
  std::array<std::uint64_t, 28> powers{1};
  for (std::size_t k = 1; k < powers.size(); ++k) powers[k] = 5 * powers[k - 1];
  return powers;
}();

// Returns m 2^e 10^k, rounded to the nearest number, of two the even one: m 5^k is exact in 128 bits.
// Preconditions: m < 2^53, and the result is below 2^64.
std::uint64_t scaled(std::uint64_t m, int e, int k) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = Wide{m} * kPowersOfFive[static_cast<std::size_t>(k)];
  const int shift = -(e + k);
  if (shift <= 0) return static_cast<std::uint64_t>(product << static_cast<unsigned>(-shift));
  const auto whole = static_cast<std::uint64_t>(product >> static_cast<unsigned>(shift));
  const Wide half = Wide{1} << static_cast<unsigned>(shift - 1);
  const Wide rest = product & (2 * half - 1);
  return whole + static_cast<std::uint64_t>(rest > half || (rest == half && whole % 2 == 1));
}

// The digits and the exponent of the first one, of a number in the range above.
std::pair<std::uint64_t, int> decimal(double magnitude) {
  constexpr int kMantissaBits = 52;
  constexpr std::uint64_t kHidden = std::uint64_t{1} << kMantissaBits;
  const auto bits = std::bit_cast<std::uint64_t>(magnitude);
  const std::uint64_t m = (bits & (kHidden - 1)) | kHidden;
  const int e = static_cast<int>(bits >> kMantissaBits) - 1023;  // of the first binary digit
  // log10(2) = 0.30103; the result is the exponent or one less.
  int exponent = (e * 1233) >> 12;
  std::uint64_t digits = scaled(m, e - kMantissaBits, kDigits - 1 - exponent);
  if (digits >= kTooManyDigits) {
    ++exponent;
    digits = scaled(m, e - kMantissaBits, kDigits - 1 - exponent);
  }
  return {digits, exponent};
}

// Writes a number below 10^8 with eight digits.
void write_eight(std::uint32_t value, char* to) {
  static constexpr std::array<char, 200> kPairs = [] {
    std::array<char, 200> pairs{};
    for (std::size_t i = 0; i < 100; ++i) {
      pairs[2 * i] = static_cast<char>('0' + i / 10);
      pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
  }();
  const auto copy_pair = [](std::uint32_t number, char* out) {
    std::copy_n(kPairs.begin() + 2 * std::ptrdiff_t{number}, 2, out);
  };
  const std::uint32_t high = value / 10'000, low = value % 10'000;
  copy_pair(high / 100, to);
  copy_pair(high % 100, to + 2);
  copy_pair(low / 100, to + 4);
  copy_pair(low % 100, to + 6);
}

}  // namespace

std::optional<std::string_view> CsvFields::next() {
  if (!rest_) return std::nullopt;
  const std::size_t end = separator_ == ' ' ? rest_->find_first_of(" \t") : rest_->find(separator_);
  const std::string_view field = trim(rest_->substr(0, end));
  if (end == std::string_view::npos) {
    rest_.reset();
  } else {
    rest_->remove_prefix(end + 1);
    if (separator_ == ' ') rest_ = trim(*rest_);
  }
  return field;
}

char* write_number(double value, char* to) {
  const double magnitude = std::abs(value);
  if (!(magnitude >= kMinExact && magnitude < kMaxExact)) {
    return std::to_chars(to, to + kMaxNumberLength, value, std::chars_format::general, kDigits).ptr;
  }
  const auto [number, exponent] = decimal(magnitude);
  std::array<char, kDigits> digits;
  digits[0] = static_cast<char>('0' + number / 10'000'000'000'000'000);
  write_eight(static_cast<std::uint32_t>(number / 100'000'000 % 100'000'000), digits.data() + 1);
  write_eight(static_cast<std::uint32_t>(number % 100'000'000), digits.data() + 9);
  int count = kDigits;
  while (digits[static_cast<std::size_t>(count) - 1] == '0') --count;

  if (value < 0.0) *to++ = '-';
  const auto append = [&](int begin, int end) {
    to = std::copy(digits.data() + begin, digits.data() + end, to);
  };
  if (exponent >= 0) {
    append(0, exponent + 1);
    if (count <= exponent + 1) return to;
    *to++ = '.';
    append(exponent + 1, count);
  } else if (exponent >= -4) {
    *to++ = '0';
    *to++ = '.';
    to = std::fill_n(to, -exponent - 1, '0');
    append(0, count);
  } else {
    append(0, 1);
    if (count > 1) *to++ = '.';
    append(1, count);
    *to++ = 'e';
    *to++ = '-';
    *to++ = static_cast<char>('0' - exponent / 10);
    *to++ = static_cast<char>('0' - exponent % 10);
  }
  return to;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(trim(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string quote(std::string_view text) {
  constexpr std::size_t kMaxShownLength = 60;
  std::string copy(text.substr(0, kMaxShownLength));
  for (char& c : copy) {
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) >= 0x7F) c = '?';
  }
  return "'" + copy + (text.size() > kMaxShownLength ? "...'" : "'");
}

}  // namespace buoyancy
