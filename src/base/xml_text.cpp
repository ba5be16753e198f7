#include "base/xml_text.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace buoyancy {
namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD

// Length [bytes] of the valid UTF-8 sequence that text begins with; 0: there is none, or it is a character
// that XML 1.0 does not allow.
std::size_t xml_character_size(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80U) return first >= 0x20U || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t size = first < 0xc2U ? 0 : first < 0xe0U ? 2 : first < 0xf0U ? 3 : first < 0xf5U ? 4 : 0;
  if (size == 0 || text.size() < size) return 0;
  std::uint32_t code = first & (0xffU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};  // by size
  const bool surrogate = code >= 0xd800U && code < 0xe000U;
  const bool not_a_character = code == 0xfffeU || code == 0xffffU;
  return code >= kSmallest[size] && code < 0x110000U && !surrogate && !not_a_character ? size : 0;
}

}  // namespace

std::string escape_xml(std::string_view text) {
  std::string escaped;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = xml_character_size(text.substr(i));
    switch (text[i]) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\t':
        escaped += "&#9;";
        break;
      case '\n':
        escaped += "&#10;";
        break;
      case '\r':
        escaped += "&#13;";
        break;
      default:
        escaped += size == 0 ? kReplacement : text.substr(i, size);
    }
    i += size == 0 ? 1 : size;
  }
  return escaped;
}

}  // namespace buoyancy
