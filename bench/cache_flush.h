// Empties the caches between two measurements, as a process does that needs them itself: a simulator beside
// the service.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace buoyancy::bench {

class CacheFlush {
 public:
  // Allocates three times the last-level cache, but at least 96 MB, which suffices where the size of the
  // cache is unknown, and at most 384 MB, because of the time it takes.
  CacheFlush();

  // Writes and reads the whole buffer.
  void operator()();

  std::size_t bytes() const { return buffer_.size() * sizeof(std::uint64_t); }

 private:
  std::vector<std::uint64_t> buffer_;
};

}  // namespace buoyancy::bench
