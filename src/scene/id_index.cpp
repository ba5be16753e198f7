#include "scene/id_index.h"

#include <algorithm>
#include <utility>

namespace buoyancy {

IdIndex::IdIndex(std::vector<std::int32_t> ids) : ids_(std::move(ids)) {
  constexpr std::int64_t kMaxEntriesPerId = 4;
  if (ids_.empty()) return;
  const auto [smallest, largest] = std::ranges::minmax(ids_);
  first_ = smallest;
  const std::int64_t range = std::int64_t{largest} - smallest + 1;
  const auto count = static_cast<std::int64_t>(ids_.size());
  const bool dense = range <= kMaxEntriesPerId * count;
  if (dense) dense_.assign(static_cast<std::size_t>(range), kNone);
  for (std::uint32_t position = 0; position < ids_.size(); ++position) {
    if (dense) {
      dense_[static_cast<std::size_t>(ids_[position] - first_)] = position;
    } else {
      sparse_.emplace(ids_[position], position);
    }
  }
}

std::optional<std::size_t> IdIndex::find_sparse(std::int32_t id) const {
  const auto entry = sparse_.find(id);
  if (entry == sparse_.end()) return std::nullopt;
  return entry->second;
}

}  // namespace buoyancy
