#include "base/format.h"

#include <array>
#include <charconv>

namespace buoyancy {
namespace {

struct ValueFormatter {
  int digits;

  std::string operator()(double value) const { return format_number(value, digits); }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(std::uint64_t value) const { return std::to_string(value); }
  std::string operator()(std::string_view value) const { return std::string(value); }
  std::string operator()(const Vec3& value) const { return format_vector(value, digits); }
};

}  // namespace

std::string format_number(double value, int digits) {
  std::array<char, 32> text{};
  // Formats as printf's %g would, but with a decimal point in every locale.
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

std::string format_values(std::string_view pattern, std::initializer_list<FormatValue> values) {
  std::string text;
  for (const FormatValue& value : values) {
    const std::size_t begin = pattern.find('{');
    const std::size_t end = pattern.find('}', begin);
    int digits = 9;
    if (end > begin + 2) std::from_chars(pattern.data() + begin + 2, pattern.data() + end, digits);
    text += pattern.substr(0, begin);
    text += std::visit(ValueFormatter{digits}, value);
    pattern.remove_prefix(end + 1);
  }
  text += pattern;
  return text;
}

std::string pluralize(std::int64_t count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

}  // namespace buoyancy
