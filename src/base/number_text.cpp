#include "base/number_text.h"

#include <array>
#include <charconv>

namespace buoyancy {

std::string number_text(double value) {
  std::array<char, 32> text{};  // the longest, -1.2345678901234567e-123, has 24
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

}  // namespace buoyancy
