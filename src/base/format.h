// Formats numbers, vectors and counts for reports and error messages.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>

#include "base/vec3.h"

namespace buoyancy {

// Formats as "0.25", "1e+300" or "nan", with at most `digits` significant digits; digits: 1 to 17.
std::string format_number(double value, int digits = 9);

// Returns the shortest text that parses to the same number: "0.1", "1e-09", "nan".
std::string format_shortest(double value);

// Formats as "0.25, 1, -3".
std::string format_vector(const Vec3& vector, int digits = 9);

using FormatValue = std::variant<double, std::int64_t, std::uint64_t, std::string_view, Vec3>;

// Returns the pattern with a value in place of each {}: numbers and vectors with at most 9 significant
// digits, or as many as {:4} says. Without values it returns the pattern itself, braces included.
std::string format_values(std::string_view pattern, std::initializer_list<FormatValue> values);
template <typename... Values>
std::string format_text(std::string_view pattern, const Values&... values) {
  return format_values(pattern, {FormatValue(values)...});
}

// Appends a line of columns: a printf format and its values, at most 511 characters.
template <typename... Values>
void append_line(std::string& text, const char* format, Values... values) {
  std::array<char, 512> line{};
  std::snprintf(line.data(), line.size(), format, values...);
  text += line.data();
  text += '\n';
}

// Formats as "1 hole" or "5 holes".
std::string pluralize(std::int64_t count, const std::string& singular, const std::string& plural);

}  // namespace buoyancy
