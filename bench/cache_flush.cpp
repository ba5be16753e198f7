#include "cache_flush.h"

#include <algorithm>

#include <unistd.h>

namespace buoyancy::bench {
namespace {

std::size_t flushed_bytes() {
  constexpr long kMin = 96L << 20;
  constexpr long kMax = 384L << 20;
  return static_cast<std::size_t>(std::clamp(3 * sysconf(_SC_LEVEL3_CACHE_SIZE), kMin, kMax));
}

// A sink for what is read, so that the compiler cannot omit the reads.
volatile std::uint64_t sink;

}  // namespace

CacheFlush::CacheFlush() : buffer_(flushed_bytes() / sizeof(std::uint64_t)) {}

void CacheFlush::operator()() {
  for (std::uint64_t& word : buffer_) word += 1;
  std::uint64_t combined = 0;
  for (const std::uint64_t word : buffer_) combined ^= word;
  sink = combined;
}

}  // namespace buoyancy::bench
