// Fuzz target: bytes as TOML. Text that the check of its nesting lets pass must be shallow for toml++: what
// it makes of the text has no more levels than a header and a value may have together.
#include <algorithm>
#include <cstdint>
#include <exception>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "scene/toml_nesting.h"
#include "tests/fuzz/fuzz_check.h"

namespace buoyancy {
namespace {

std::size_t levels(const toml::node& root) {
  struct Level {
    const toml::node* node;
    std::size_t depth;
  };
  std::size_t deepest = 0;
  std::vector<Level> open{{&root, 0}};
  while (!open.empty()) {
    const Level level = open.back();
    open.pop_back();
    deepest = std::max(deepest, level.depth);
    if (const toml::table* table = level.node->as_table()) {
      for (const auto& [key, value] : *table) open.push_back({&value, level.depth + 1});
    } else if (const toml::array* array = level.node->as_array()) {
      for (const toml::node& element : *array) open.push_back({&element, level.depth + 1});
    }
  }
  return deepest;
}

void check(std::string_view text) {
  if (check_toml_nesting(text, "fuzz.toml")) return;
  try {
    // Every part of a header may be an array of tables, of two levels.
    require(levels(toml::parse(text)) <= 3 * (kMaxTomlLevels + 1), "text that passes has few levels");
  } catch (const toml::parse_error&) {
    return;
  }
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
