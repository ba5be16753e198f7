// Counts what a test program takes from the heap through operator new, on all threads: the proof of "no heap
// after warm-up". A program that links buoyancy_allocation_count has its global operator new replaced. What
// calls malloc itself is not seen.
#pragma once

#include <cstdint>

namespace buoyancy {

class AllocationCount {
 public:
  AllocationCount() : before_(total()) {}
  // Calls of operator new since construction.
  std::int64_t count() const { return total() - before_; }

 private:
  static std::int64_t total();

  std::int64_t before_;
};

}  // namespace buoyancy
