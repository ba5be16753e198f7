// Appends fields to a row of CSV: numbers with 17 significant digits, so that reading them back gives the
// same double.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string>

#include "messages/request.h"

namespace buoyancy::service {

// Replaces row by the columns that rows of a body begin with: utime [us], body_id and status.
inline void begin_row(std::int64_t utime, std::int32_t body_id, BodyStatus status, std::string& row) {
  row = std::to_string(utime);
  row += ',';
  row += std::to_string(body_id);
  row += ',';
  row += std::to_string(static_cast<std::int32_t>(status));
}

inline void append_field(double value, std::string& row) {
  constexpr int kSignificantDigits = 17;
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general,
                                 kSignificantDigits);
  row += ',';
  row.append(text.data(), end.ptr);
}

// values: numbers, or arrays of numbers row by row.
template <typename Value, std::size_t kSize>
void append_field(const std::array<Value, kSize>& values, std::string& row) {
  for (const Value& value : values) append_field(value, row);
}

}  // namespace buoyancy::service
