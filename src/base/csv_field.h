// Fields of CSV files and of arguments: numbers, and quotations for messages.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace buoyancy {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // that some programs write first

// Removes spaces, tabs and carriage returns at both ends.
std::string_view trim(std::string_view text);

// The fields of a line, trimmed, one after another: at least one.
class CsvFields {
 public:
  explicit CsvFields(std::string_view line) : rest_(line) {}
  std::optional<std::string_view> next();  // nullopt: there are no more

 private:
  std::optional<std::string_view> rest_;
};

// The parts between separators, trimmed: at least one.
std::vector<std::string_view> split(std::string_view text, char separator);

// Quotes a text for a message, shortened and without control characters.
std::string quote(std::string_view text);

// Parses the whole text as a decimal number; false if it is none or out of the type's range. Accepts a
// leading '+', and nan and inf where the type has them.
template <typename Number>
bool parse_number(std::string_view text, Number& number) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

inline bool parse_finite(std::string_view text, double& value) {
  return parse_number(text, value) && std::isfinite(value);
}

}  // namespace buoyancy
