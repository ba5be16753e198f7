#include "scene/toml_table.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "base/format.h"
#include "base/spelling_suggestion.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxQuotationLength = 60;

bool is_printable(char c) {
  return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
}

std::string quoted(std::string_view word) {
  return format_text("'{}'", word);
}

// Formats a value as TOML.
std::string to_toml(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) {
    const std::string text = format_shortest(number->get());
    // 1.0 keeps its decimal point: it is not an integer.
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
  }
  if (const auto* text = node.as_string()) {
    std::ostringstream quoted_text;
    quoted_text << std::quoted(text->get());
    return quoted_text.str();
  }
  if (const auto* array = node.as_array()) {
    std::string text = "[";
    for (const toml::node& element : *array) {
      if (text.size() > 1) text += ", ";
      text += to_toml(element);
    }
    return text += "]";
  }
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  return text.str();
}

// Formats a value as TOML, truncated to kMaxQuotationLength.
std::string quotation(const toml::node& node) {
  std::string line = to_toml(node);
  if (line.size() > kMaxQuotationLength) line = line.substr(0, kMaxQuotationLength) + "...";
  return line;
}

// Returns the value of an integer or floating-point node, else nullopt.
std::optional<double> number_of(const toml::node& node) {
  if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
  if (const auto* number = node.as_floating_point()) return number->get();
  return std::nullopt;
}

// Returns an array's numbers; nullopt unless all elements are finite numbers.
std::optional<std::vector<double>> numbers_of(const toml::node& node) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return std::nullopt;
  std::vector<double> numbers;
  for (const toml::node& element : *array) {
    const std::optional<double> number = number_of(element);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::string list(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += ", ";
    text += word;
  }
  return text;
}

}  // namespace

std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return !is_printable(c); }, '?');
  return text;
}

std::string SceneParseContext::location(const toml::source_region& region) const {
  return file + ":" + std::to_string(region.begin.line);
}

const toml::node* TomlTable::node(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return table_->get(key);
}

bool TomlTable::has(std::string_view key) {
  return node(key) != nullptr;
}

void TomlTable::read(std::string_view key, double& value, const NumberRange& range) {
  const toml::node* found = node(key);
  if (found == nullptr) return;
  const std::optional<double> number = number_of(*found);
  if (number && range.contains(*number)) {
    value = *number;
  } else {
    fail_at(key, range.describe());
  }
}

void TomlTable::read(std::string_view key, std::optional<double>& value, const NumberRange& range) {
  double number = 0.0;
  read(key, number, range);
  if (table_->contains(key)) value = number;
}

std::vector<double> TomlTable::numbers(std::string_view key, std::span<const std::size_t> counts,
                                       std::string_view unit) {
  const toml::node* found = node(key);
  if (found == nullptr) return {};
  std::optional<std::vector<double>> numbers = numbers_of(*found);
  if (numbers && std::find(counts.begin(), counts.end(), numbers->size()) != counts.end()) {
    return *std::move(numbers);
  }
  std::string expected = "an array of ";
  for (std::size_t i = 0; i < counts.size(); ++i) {
    expected += (i == 0 ? "" : " or ") + std::to_string(counts[i]);
  }
  fail_at(key, expected + " finite numbers" + in_unit(unit));
  return {};
}

void TomlTable::read(std::string_view key, std::span<double> values, std::string_view unit) {
  const std::array counts{values.size()};
  const std::vector<double> found = numbers(key, counts, unit);
  std::copy(found.begin(), found.end(), values.begin());
}

void TomlTable::read(std::string_view key, Vec3& value, std::string_view unit) {
  read(key, std::span<double>(value.data(), 3), unit);
}

void TomlTable::read(std::string_view key, std::span<std::int32_t> values) {
  const toml::node* found = node(key);
  if (found == nullptr) return;
  const toml::array* array = found->as_array();
  bool valid = array != nullptr && array->size() == values.size();
  for (std::size_t i = 0; valid && i < values.size(); ++i) {
    const auto* whole = array->get(i)->as_integer();
    valid = whole != nullptr && std::in_range<std::int32_t>(whole->get());
    if (valid) values[i] = static_cast<std::int32_t>(whole->get());
  }
  if (!valid) fail_at(key, "an array of " + std::to_string(values.size()) + " whole numbers");
}

void TomlTable::read(std::string_view key, std::int32_t& value) {
  const toml::node* found = node(key);
  if (found == nullptr) return;
  const auto* whole = found->as_integer();
  if (whole != nullptr && std::in_range<std::int32_t>(whole->get())) {
    value = static_cast<std::int32_t>(whole->get());
  } else {
    fail_at(key, "a whole number of 32 bits");
  }
}

void TomlTable::read(std::string_view key, std::int32_t& value, const NumberRange& range) {
  const toml::node* found = node(key);
  if (found == nullptr) return;
  const auto* whole = found->as_integer();
  if (whole != nullptr && range.contains(static_cast<double>(whole->get()))) {
    value = static_cast<std::int32_t>(whole->get());
  } else {
    fail_at(key, "a whole number from " + format_shortest(range.min) + " to " + format_shortest(range.max));
  }
}

void TomlTable::read(std::string_view key, std::int64_t& value, std::string_view unit) {
  const toml::node* found = node(key);
  if (found == nullptr) return;
  if (const auto* whole = found->as_integer()) {
    value = whole->get();
  } else {
    fail_at(key, "a whole number" + in_unit(unit));
  }
}

void TomlTable::read(std::string_view key, std::uint64_t& value, std::uint64_t min) {
  const toml::node* found = node(key);
  if (found == nullptr) return;
  const auto* whole = found->as_integer();
  if (whole != nullptr && std::cmp_greater_equal(whole->get(), min)) {
    value = static_cast<std::uint64_t>(whole->get());
  } else {
    fail_at(key, "a whole number of at least " + std::to_string(min));
  }
}

void TomlTable::read(std::string_view key, std::string& value) {
  const toml::node* found = node(key);
  if (found == nullptr) return;
  const auto* text = found->as_string();
  if (text != nullptr && !text->get().empty() &&
      std::all_of(text->get().begin(), text->get().end(), is_printable)) {
    value = text->get();
  } else {
    fail_at(key, "a string in quotation marks, not empty and without control characters");
  }
}

std::optional<std::size_t> TomlTable::choice(std::string_view key, std::span<const std::string_view> words) {
  const toml::node* found = node(key);
  if (found == nullptr) return std::nullopt;
  const auto* text = found->as_string();
  if (text == nullptr) {
    fail_at(key, "one of " + list(words));
    return std::nullopt;
  }
  const auto word = std::find(words.begin(), words.end(), text->get());
  if (word == words.end()) {
    fail_at(key, "one of " + list(words), {}, "The nearest is " + quoted(nearest_word(text->get(), words)));
    return std::nullopt;
  }
  return static_cast<std::size_t>(word - words.begin());
}

const toml::table* TomlTable::table(std::string_view key) {
  const toml::node* found = node(key);
  if (found == nullptr) return nullptr;
  if (found->as_table() == nullptr) fail_at(key, "a table");
  return found->as_table();
}

void TomlTable::finish() {
  for (const auto& [key, value] : *table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    set_error(key.source(), "unknown key " + quoted(key.str()), "one of " + list(known_), {},
              "The nearest known key is " + quoted(nearest_word(key.str(), known_)));
    return;
  }
}

void TomlTable::fail(std::string actual, std::string expected, std::string cause, std::string hint) {
  set_error(table_->source(), std::move(actual), std::move(expected), std::move(cause), std::move(hint));
}

void TomlTable::fail_at(std::string_view key, std::string expected, std::string cause, std::string hint) {
  const toml::node* found = table_->get(key);
  set_error(found->source(), std::string(key) + " = " + quotation(*found), std::move(expected),
            std::move(cause), std::move(hint));
}

void TomlTable::fail_in(std::string_view key, Error error) {
  if (context_->error) return;
  error.subject = context_->location(table_->get(key)->source()) + ": " + name_ + ", " + error.subject;
  context_->error = std::move(error);
}

void TomlTable::fail_missing(std::string_view key, std::string expected) {
  fail("no key " + quoted(key), std::move(expected));
}

void TomlTable::set_error(const toml::source_region& source, std::string actual, std::string expected,
                          std::string cause, std::string hint) {
  if (context_->error) return;
  context_->error = Error{context_->location(source) + ": " + name_, printable(std::move(actual)),
                          std::move(expected), std::move(cause), printable(std::move(hint))};
}

}  // namespace buoyancy
