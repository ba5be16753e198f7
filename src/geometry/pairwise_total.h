// Sums the terms of a long list on several threads, with the bits of PairwiseSum.
#pragma once

#include <algorithm>
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
  constexpr std::size_t kBlocksPerTask = 32;
  std::vector<T> blocks(count / kBlock);
  const std::size_t tasks = (blocks.size() + kBlocksPerTask - 1) / kBlocksPerTask;
  run_parallel_tasks(tasks, tasks > 2 ? max_parallel_tasks() : 1, [&](std::size_t task) {
    const std::size_t end = std::min(blocks.size(), (task + 1) * kBlocksPerTask);
    for (std::size_t block = task * kBlocksPerTask; block < end; ++block) {
      T sum{};
      for (std::size_t i = block * kBlock; i < (block + 1) * kBlock; ++i) sum += term(i);
      blocks[block] = sum;
    }
  });
  PairwiseSum<T, kBlock> sum;
  for (const T& block : blocks) sum.add_block(block);
  for (std::size_t i = blocks.size() * kBlock; i < count; ++i) sum.add(term(i));
  return sum.total();
}

}  // namespace buoyancy
