#include "view/page/base64.h"

#include <algorithm>
#include <bit>
#include <string_view>

static_assert(std::endian::native == std::endian::little, "pages decode little-endian numbers");

namespace buoyancy::view {

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr unsigned kDigitBits = 6;
  constexpr unsigned kDigitMask = (1U << kDigitBits) - 1;
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned bits = 0;
    for (std::size_t j = 0; j < 3; ++j) bits = bits << 8U | (j < count ? bytes[i + j] : 0U);
    for (unsigned digit = 0; digit < 4; ++digit) {
      text += digit <= count ? kDigits[bits >> (3 - digit) * kDigitBits & kDigitMask] : '=';
    }
  }
  return text;
}

}  // namespace buoyancy::view
