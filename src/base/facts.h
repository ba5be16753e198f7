// Collects the facts of a report, each stated once, and returns them as a JSON object and as lines of text.
//
//   Facts facts;
//   facts.line("tank").say("'{}'", tank.name);
//   facts.add("volume", volume, "{:6} m^3").add("mesh", index).add("fill", fill, "fill {:6}");
//
//   {"volume": 1.5, "mesh": 0, "fill": 0.25}          json(), with all digits
//     tank          'ballast', 1.5 m^3, fill 0.25     text()
//
// A report whose text has another order than its JSON states the words and the member separately.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/format.h"
#include "base/json.h"

namespace buoyancy {

class Facts {
 public:
  // Begins a line, whose words start in column 16, or after the label where it is longer. label: empty for a
  // line that continues the one before.
  Facts& line(std::string_view label);
  // Begins a line without indentation, or several by line feeds. Takes arguments as say() does.
  template <typename... Values>
  Facts& heading(std::string_view pattern, const Values&... values) {
    return begin(format_text(pattern, values...));
  }

  // Adds words to the line, formatted as by format_text(). Words are separated by ", ", unless the pattern
  // begins with a space, a semicolon or a colon.
  template <typename... Values>
  Facts& say(std::string_view pattern, const Values&... values) {
    return append(separator(pattern), format_text(pattern, values...));
  }
  // Adds the words only if `applies` is true.
  template <typename... Values>
  Facts& say_if(bool applies, std::string_view pattern, const Values&... values) {
    return applies ? say(pattern, values...) : *this;
  }

  // Adds a member of the object, or replaces its value.
  template <typename Value>
  Facts& add(std::string_view key, Value&& value) {
    json_[std::string(key)] = std::forward<Value>(value);
    return *this;
  }
  // Also adds words: the pattern has one place for the value. An empty pattern adds none.
  template <typename Value>
  Facts& add(std::string_view key, const Value& value, std::string_view pattern) {
    if (!pattern.empty()) say(pattern, value);
    return add(key, value);
  }
  // A missing value becomes null and adds no words.
  template <typename Value>
  Facts& add(std::string_view key, const std::optional<Value>& value, std::string_view pattern) {
    return value ? add(key, *value, pattern) : add(key, nullptr);
  }
  // Adds a member, and its words only if the value is true.
  Facts& add_flag(std::string_view key, bool value, std::string_view words);

  // Adds an empty array and returns it. The reference is valid until the next member is added.
  Json& list(std::string_view key);
  // Adds the object of other facts as a member, or to the array of that name, and their lines to the text.
  Facts& include(std::string_view key, Facts other);
  Facts& include_in(std::string_view list, Facts other);

  // Adds the members of other facts, without their text.
  Facts& update(const Facts& other);

  Json& json() { return json_; }
  const std::string& text() const { return text_; }  // without a final newline

 private:
  Facts& begin(std::string_view lines);
  std::string_view separator(std::string_view pattern) const;
  Facts& append(std::string_view separator, std::string_view words);

  Json json_ = Json::object();
  std::string text_;
  bool has_lines_ = false;
  bool has_words_ = false;  // of the current line
};

}  // namespace buoyancy
