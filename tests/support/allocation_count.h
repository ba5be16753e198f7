// Counts the heap allocations of a test program through operator new, on all threads, to verify that code
// does not allocate after warm-up. Linking buoyancy_allocation_count replaces the global operator new. Direct
// calls of malloc are not counted.
#pragma once

#include <cstdint>

namespace buoyancy {

class AllocationCount {
 public:
  AllocationCount() : before_(total()) {}
  // The number of calls of operator new since construction.
  std::int64_t count() const { return total() - before_; }

 private:
  static std::int64_t total();

  std::int64_t before_;
};

}  // namespace buoyancy
