// Blocked pairwise summation: terms are added into blocks of kBlock terms, and full blocks are added
// pairwise, in a fixed order that depends only on the number of terms.
//
// The rounding error of a sum of n terms grows with kBlock + log2(n / kBlock) instead of n: over 1,000,000
// triangles a running sum is off by thousands of epsilon, this sum by tens (docs/mathematics.md,
// "Summation"). It allocates no memory.
#pragma once

#include <array>
#include <cstddef>

namespace buoyancy {

// T: default-constructible to zero, with operator+=.
template <typename T, std::size_t kBlock = 256>
class PairwiseSum {
 public:
  void add(const T& term) {
    block_ += term;
    if (++in_block_ == kBlock) close_block();
  }

  // Adds the sum of one full block; for callers that form blocks themselves.
  void add_block(T sum) {
    // As in a binary counter, block n is merged once per trailing one bit of n.
    std::size_t level = 0;
    for (std::size_t n = blocks_++; (n & 1U) != 0; n >>= 1U) {
      levels_[level] += sum;
      sum = levels_[level++];
    }
    levels_[level] = sum;
  }

  T total() const {
    T sum = block_;
    for (std::size_t level = 0, n = blocks_; n != 0; n >>= 1U, ++level) {
      if ((n & 1U) != 0) sum += levels_[level];
    }
    return sum;
  }

 private:
  void close_block() {
    add_block(block_);
    block_ = T{};
    in_block_ = 0;
  }

  T block_{};
  std::size_t in_block_ = 0;
  std::size_t blocks_ = 0;
  std::array<T, 48> levels_{};  // level i holds the sum of 2^i blocks if bit i of blocks_ is set
};

}  // namespace buoyancy
