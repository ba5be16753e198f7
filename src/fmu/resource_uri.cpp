#include "fmu/resource_uri.h"

#include <charconv>
#include <string>

namespace buoyancy::fmu {

std::optional<std::filesystem::path> path_of_uri(std::string_view uri) {
  const auto skip = [&uri](std::string_view prefix) {
    const bool starts = uri.starts_with(prefix);
    if (starts) uri.remove_prefix(prefix.size());
    return starts;
  };
  if (!skip("file:")) return std::nullopt;
  if (skip("//")) skip("localhost");
  if (!uri.starts_with('/')) return std::nullopt;
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      path += uri[i];
      continue;
    }
    const std::string_view digits = uri.substr(i + 1, 2);
    unsigned code = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
    if (digits.size() != 2 || error != std::errc() || end != digits.data() + 2 || code == 0)
      return std::nullopt;
    path += static_cast<char>(code);
    i += 2;
  }
  return path;
}

}  // namespace buoyancy::fmu
