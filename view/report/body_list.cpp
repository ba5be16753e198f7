#include "view/report/body_list.h"

#include <charconv>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

#include "view/report/run_builder.h"

namespace buoyancy::view {
namespace {

struct IdRange {
  std::int32_t first = 0;
  std::int32_t last = 0;
};

// "7", "1-50", "-3--1"
std::optional<IdRange> parse_range(std::string_view text) {
  const char* const end = text.data() + text.size();
  IdRange range;
  const auto [after_first, error] = std::from_chars(text.data(), end, range.first);
  if (error != std::errc()) return std::nullopt;
  range.last = range.first;
  if (after_first == end) return range;
  const auto [after_last, last_error] = std::from_chars(after_first + 1, end, range.last);
  const bool valid = *after_first == '-' && last_error == std::errc() && after_last == end;
  return valid && range.first <= range.last ? std::optional(range) : std::nullopt;
}

}  // namespace

Expected<std::vector<std::size_t>> body_list(const std::string& list, const Scene& scene) {
  const std::string subject = "--bodies " + list;
  std::set<std::size_t> indices;
  std::string_view rest = list;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string part(rest.substr(0, comma));
    const std::optional<IdRange> range = parse_range(part);
    if (!range) {
      return make_error({subject, "'" + part + "'", "ids and ranges of ids, such as 1-50,900",
                         "a space, another separator, or a range whose first id exceeds its last", ""});
    }
    bool found = false;
    for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
      const std::int32_t id = scene.bodies()[i].id;
      if (id < range->first || id > range->last) continue;
      indices.insert(i);
      found = true;
    }
    if (!found) {
      return make_error({subject, "no body has the id " + part, "ids of " + scene.name(),
                         "the list is for another scene", "Run buoyancyd --check to list the scene's ids"});
    }
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (indices.size() > kMaxBodies) {
    return make_error({subject, std::to_string(indices.size()) + " bodies",
                       "at most " + std::to_string(kMaxBodies) + ", a page of about 10 MB", "",
                       "Write several pages"});
  }
  return std::vector<std::size_t>(indices.begin(), indices.end());
}

}  // namespace buoyancy::view
