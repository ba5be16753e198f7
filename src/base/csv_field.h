// Splits CSV lines and command-line arguments into fields, parses and writes numbers, and quotes text for
// messages.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace buoyancy {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // some programs begin text files with it

// Removes spaces, tabs and carriage returns at both ends.
inline std::string_view trim(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// Iterates over the fields of a line, trimmed. Each line has at least one.
class CsvFields {
 public:
  // separator: ' ' stands for any number of spaces and tabs.
  explicit CsvFields(std::string_view line, char separator = ',')
      : rest_(separator == ' ' ? trim(line) : line), separator_(separator) {}
  std::optional<std::string_view> next();  // nullopt after the last field

 private:
  std::optional<std::string_view> rest_;
  char separator_;
};

// Returns the parts of a text between separators, trimmed: at least one.
std::vector<std::string_view> split(std::string_view text, char separator);

// Quotes the first 60 bytes of a text for a message, with '?' for each that is not printable ASCII.
std::string quote(std::string_view text);

// Parses the whole text as a decimal number; returns false if it is none or out of the type's range. Accepts
// a leading '+', and nan and inf where the type has them.
template <typename Number>
bool parse_number(std::string_view text, Number& number) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

// Writes a number with 17 significant digits, as std::to_chars() does in its general format: at most
// kMaxNumberLength characters. Returns their end. Numbers from 2e-11 to 1e17 take a third of its time.
inline constexpr std::size_t kMaxNumberLength = 24;  // -1.2345678901234567e-308
char* write_number(double value, char* to);

inline bool parse_finite(std::string_view text, double& value) {
  return parse_number(text, value) && std::isfinite(value);
}

}  // namespace buoyancy
