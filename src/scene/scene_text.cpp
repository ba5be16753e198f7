#include "scene/scene_text.h"

#include <algorithm>
#include <vector>

#include <toml++/toml.h>

namespace buoyancy {
namespace {

struct FileName {
  toml::source_region place;
  std::string name;
  bool is_mesh;
};

// Collects the names of files: the strings with the keys 'mesh' and 'file', which name nothing else.
void collect(const toml::node& node, bool is_mesh, std::vector<FileName>& names) {
  if (const toml::array* const array = node.as_array()) {
    for (const toml::node& element : *array) collect(element, is_mesh, names);
  }
  const toml::table* const table = node.as_table();
  if (table == nullptr) return;
  for (const auto& [key, value] : *table) {
    const auto name = value.value<std::string>();
    if (name && (key == "mesh" || key == "file")) {
      names.push_back({value.source(), *name, is_mesh});
    }
    collect(value, is_mesh, names);
  }
}

// Returns the byte at a position, whose line and column count from 1, and columns in code points.
std::size_t offset_of(std::string_view text, const toml::source_position& position) {
  std::size_t at = 0;
  for (toml::source_index line = 1; line < position.line; ++line) at = text.find('\n', at) + 1;
  const auto is_continuation = [&text](std::size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  for (toml::source_index column = 1; column < position.column && at < text.size(); ++column) {
    do {
      ++at;
    } while (is_continuation(at));
  }
  return at;
}

}  // namespace

std::string rename_files(std::string_view text,
                         const std::function<std::string(const std::string& name, bool is_mesh)>& new_name) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const toml::table scene = toml::parse(text);
  std::vector<FileName> names;
  for (const auto& [key, value] : scene) collect(value, key != "water", names);
  std::ranges::sort(names,
                    [](const FileName& a, const FileName& b) { return a.place.begin < b.place.begin; });
  std::string changed;
  std::size_t copied = 0;
  for (const FileName& file : names) {
    changed.append(text, copied, offset_of(text, file.place.begin) - copied);
    changed += '"' + new_name(file.name, file.is_mesh) + '"';
    copied = offset_of(text, file.place.end);
  }
  return changed.append(text, copied);
}

}  // namespace buoyancy
