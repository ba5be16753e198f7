// Sums the terms of a long list on several threads, with the bits of PairwiseSum.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/pairwise_sum.h"
#include "geometry/parallel_tasks.h"

namespace buoyancy {

// Returns the PairwiseSum of term(i) for all i below `count`, with the same bits. T: as there. Long sums are
// shared among threads.
template <typename T, typename Term>
T pairwise_total(std::size_t count, const Term& term) {
  constexpr std::size_t kBlock = 256;
  static_assert(kParallelRange % kBlock == 0);
  std::vector<T> blocks(count / kBlock);
  run_parallel_ranges(blocks.size() * kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; i += kBlock) {
      T sum{};
      for (std::size_t n = i; n < i + kBlock; ++n) sum += term(n);
      blocks[i / kBlock] = sum;
    }
  });
  PairwiseSum<T, kBlock> sum;
  for (const T& block : blocks) sum.add_block(block);
  for (std::size_t i = blocks.size() * kBlock; i < count; ++i) sum.add(term(i));
  return sum.total();
}

}  // namespace buoyancy
