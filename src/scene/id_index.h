// Finds the position of a body in its scene by its id.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace buoyancy {

class IdIndex {
 public:
  IdIndex() = default;
  // Positions are those in ids. Precondition: no id occurs twice. O(ids).
  explicit IdIndex(std::vector<std::int32_t> ids);

  // The position of this id, or nullopt. likely: a position that is tried first; any number. O(1), and
  // without a hash where it is at the likely position or where the ids are dense.
  std::optional<std::size_t> find(std::int32_t id, std::size_t likely = 0) const {
    if (likely < ids_.size() && ids_[likely] == id) return likely;
    return is_dense() ? find_dense(id) : find_sparse(id);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  bool is_dense() const { return !dense_.empty(); }
  std::optional<std::size_t> find_dense(std::int32_t id) const {
    const std::int64_t offset = std::int64_t{id} - first_;
    if (offset < 0 || offset >= static_cast<std::int64_t>(dense_.size())) return std::nullopt;
    const std::uint32_t position = dense_[static_cast<std::size_t>(offset)];
    return position == kNone ? std::nullopt : std::optional<std::size_t>(position);
  }
  std::optional<std::size_t> find_sparse(std::int32_t id) const;

  std::vector<std::int32_t> ids_;
  std::int64_t first_ = 0;            // the smallest id
  std::vector<std::uint32_t> dense_;  // position by id - first_; empty if the ids are too far apart
  std::unordered_map<std::int32_t, std::uint32_t> sparse_;  // position by id, if dense_ is empty
};

}  // namespace buoyancy
