// Maps the bodies of messages to columns of CSV files: the fields in the order of the message definition,
// with matrices row by row after all others. Numbers have 17 significant digits, so that reading them back
// gives the same double. A status is its number in the message, 0 for OK.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/csv_field.h"
#include "messages/wire_layout.h"

namespace buoyancy {

// A range of consecutive fields of a message, by their names in its definition.
struct FieldRange {
  std::string_view first, last;
};
inline constexpr FieldRange kAllFields{"body_id", ""};

template <typename Member>
inline constexpr bool kIsMatrix = false;
template <typename Number, std::size_t kRows, std::size_t kColumns>
inline constexpr bool kIsMatrix<std::array<std::array<Number, kColumns>, kRows>> = true;

// Calls visitor(field, member) for the fields of a range in the order of the columns.
template <BodyOfMessage Body, typename Visitor>
void visit_columns(Body& body, const FieldRange& range, Visitor&& visitor) {
  const auto visit_if = [&]<bool kMatrices>(std::bool_constant<kMatrices> /*matrices*/) {
    bool is_inside = false;
    visit_named_fields(body, [&]<typename Member>(const Field& field, Member& member) {
      is_inside = is_inside || field.name == range.first;
      if constexpr (kIsMatrix<std::remove_const_t<Member>> == kMatrices) {
        if (is_inside) visitor(field, member);
      }
      is_inside = is_inside && field.name != range.last;
    });
  };
  visit_if(std::false_type{});
  visit_if(std::true_type{});
}

template <typename Number, typename Visitor>
void visit_numbers_of(Number& number, const Visitor& visitor) {
  visitor(number);
}
template <typename Element, std::size_t kSize, typename Visitor>
void visit_numbers_of(std::array<Element, kSize>& elements, const Visitor& visitor) {
  for (Element& element : elements) visit_numbers_of(element, visitor);
}
template <typename Element, std::size_t kSize, typename Visitor>
void visit_numbers_of(const std::array<Element, kSize>& elements, const Visitor& visitor) {
  for (const Element& element : elements) visit_numbers_of(element, visitor);
}

// Calls visitor(number) for each column of a range: a double, an std::int32_t or a BodyStatus.
template <BodyOfMessage Body, typename Visitor>
void visit_numbers(Body& body, const FieldRange& range, const Visitor& visitor) {
  visit_columns(body, range,
                [&visitor](const Field& /*field*/, auto& member) { visit_numbers_of(member, visitor); });
}

// The names of the columns, such as "body_id,status,fx".
template <BodyOfMessage Body>
std::string csv_columns(const FieldRange& range = kAllFields) {
  std::string columns;
  const Body body;
  visit_columns(body, range, [&columns]<typename Member>(const Field& field, const Member& member) {
    const auto add = [&columns](std::string_view name) {
      if (!columns.empty()) columns += ',';
      columns += name;
    };
    if constexpr (kIsMatrix<Member>) {
      for (std::size_t row = 1; row <= member.size(); ++row) {
        for (std::size_t column = 1; column <= member.front().size(); ++column) {
          add(field.name);
          ((columns += '_') += std::to_string(row)) += std::to_string(column);
        }
      }
    } else {
      add(field.csv.empty() ? field.name : field.csv);
    }
  });
  return columns;
}

// The header of a file of bodies without its newline: utime [us] and the columns.
template <BodyOfMessage Body>
std::string csv_header(const FieldRange& range = kAllFields) {
  return "utime," + csv_columns<Body>(range);
}

// Writes a comma and the number, and returns their end.
inline char* write_csv(double value, char* to) {
  *to++ = ',';
  return write_number(value, to);
}
inline char* write_csv(std::int32_t value, char* to) {
  *to++ = ',';
  return std::to_chars(to, to + kMaxNumberLength, value).ptr;
}
inline char* write_csv(BodyStatus status, char* to) {
  return write_csv(static_cast<std::int32_t>(status), to);
}

// Appends a comma and the number.
inline void append_csv(double value, std::string& row) {
  std::array<char, kMaxNumberLength + 1> text;
  row.append(text.data(), write_csv(value, text.data()));
}

// Appends a comma and the number for each column. No heap allocation once the capacity of row suffices.
template <BodyOfMessage Body>
void append_csv(const Body& body, std::string& row, const FieldRange& range = kAllFields) {
  constexpr std::size_t kMaxColumns = sizeof(Body) / sizeof(std::int32_t);
  std::array<char, kMaxColumns*(kMaxNumberLength + 1)> text;
  char* end = text.data();
  visit_numbers(body, range, [&end](const auto& number) { end = write_csv(number, end); });
  row.append(text.data(), end);
}

// Appends the line of a body below csv_header(), including its newline.
template <BodyOfMessage Body>
void append_csv_row(std::int64_t utime, const Body& body, std::string& rows) {
  std::array<char, kMaxNumberLength> text;
  rows.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), utime).ptr);
  append_csv(body, rows);
  rows += '\n';
}

}  // namespace buoyancy
