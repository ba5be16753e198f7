// Disjoint sets over 0 .. n - 1 (union-find with path halving). The representative of a set is its smallest
// element, so that results do not depend on the order of the unions. Complexity: amortised O(log n) each.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace buoyancy {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }

  std::int32_t representative(std::int32_t i) {
    while (parent(i) != i) {
      parent(i) = parent(parent(i));
      i = parent(i);
    }
    return i;
  }

  void unite(std::int32_t i, std::int32_t j) {
    const std::int32_t a = representative(i);
    const std::int32_t b = representative(j);
    parent(std::max(a, b)) = std::min(a, b);
  }

 private:
  std::int32_t& parent(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<std::int32_t> parent_;
};

}  // namespace buoyancy
