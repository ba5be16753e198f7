#include "scene/toml_nesting.h"

#include <algorithm>
#include <vector>

namespace buoyancy {
namespace {

// Returns the place after the string that begins at `at` with a quotation mark. A string that is not closed
// ends with its line, or with the text if it has several: the parser then refuses it.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char mark = text[at];
  const std::string three(3, mark);
  const bool several_lines = text.substr(at, 3) == three;
  for (at += several_lines ? 3 : 1; at < text.size(); ++at) {
    if (text[at] == '\\' && mark == '"') {
      ++at;
    } else if (several_lines && text.substr(at, 3) == three) {
      at += 3;
      for (int inside = 0; inside < 2 && at < text.size() && text[at] == mark; ++inside) ++at;
      return at;
    } else if (!several_lines && (text[at] == mark || text[at] == '\n')) {
      return text[at] == mark ? at + 1 : at;
    }
  }
  return text.size();
}

}  // namespace

std::optional<Error> check_toml_nesting(std::string_view text, const std::string& name) {
  std::vector<std::size_t> around;  // dots before each bracket that is open
  std::size_t levels = 0;           // brackets that are open and the dots before them
  std::size_t dots = 0;             // in the key or header being read
  for (std::size_t at = 0; at < text.size();) {
    switch (text[at]) {
      case '"':
      case '\'':
        at = end_of_string(text, at);
        continue;
      case '#':
        at = std::min(text.find('\n', at), text.size());
        continue;
      case '[':
      case '{':
        around.push_back(dots);
        levels += dots + 1;
        dots = 0;
        break;
      case ']':
      case '}':
        if (!around.empty()) {
          levels -= around.back() + 1;
          around.pop_back();
        }
        dots = 0;
        break;
      case '.':
        ++dots;
        break;
      case ',':
        dots = 0;
        break;
      case '\n':
        if (around.empty()) dots = 0;
        break;
      default:
        break;
    }
    if (levels + dots > kMaxTomlLevels) {
      const std::string_view before = text.substr(0, at);
      const auto line = 1 + std::count(before.begin(), before.end(), '\n');
      return Error{
          name + ":" + std::to_string(line),
          "more than " + std::to_string(kMaxTomlLevels) + " levels of tables and arrays within each other",
          "at most that many dots, brackets and braces around a value",
          "the file is damaged or made to crash its reader", ""};
    }
    ++at;
  }
  return std::nullopt;
}

}  // namespace buoyancy
