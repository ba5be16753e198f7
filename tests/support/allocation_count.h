// Counts the heap allocations of a test program through operator new, on all threads, to verify that code
// does not allocate after warm-up; or makes one fail. Linking buoyancy_allocation_count replaces the global
// operator new. Direct calls of malloc are not counted.
#pragma once

#include <cstdint>

namespace buoyancy {

class AllocationCount {
 public:
  AllocationCount() : before_(total()), bytes_before_(total_bytes()) {}
  // The number of calls of operator new since construction, and the bytes that they asked for.
  std::int64_t count() const { return total() - before_; }
  std::int64_t bytes() const { return total_bytes() - bytes_before_; }

 private:
  static std::int64_t total();
  static std::int64_t total_bytes();

  std::int64_t before_;
  std::int64_t bytes_before_;
};

// While it lives, the n-th call of operator new from its construction on throws std::bad_alloc, n >= 1.
class FailingAllocation {
 public:
  explicit FailingAllocation(std::int64_t n);
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;
  ~FailingAllocation();

  bool has_failed() const;
};

}  // namespace buoyancy
