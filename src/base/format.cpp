#include "base/format.h"

#include <array>
#include <charconv>

namespace buoyancy {

std::string format_number(double value, int digits) {
  std::array<char, 32> text{};
  // As printf's %g, which writes the decimal point of the program's locale.
  const std::to_chars_result end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

std::string format_shortest(double value) {
  std::array<char, 32> text{};  // the longest text, -1.2345678901234567e-123, has 24 characters
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

std::string format_vector(const Vec3& vector, int digits) {
  return format_number(vector.x(), digits) + ", " + format_number(vector.y(), digits) + ", " +
         format_number(vector.z(), digits);
}

std::string pluralize(std::int64_t count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

}  // namespace buoyancy
