// A vector whose memory is placed on large pages if it is large: programs that read few and distant parts of
// much memory then have fewer TLB misses, each of which costs as much as the read itself once other work has
// displaced the page tables from the caches.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include <sys/mman.h>

namespace buoyancy {

// Allocates small blocks as operator new does. Blocks of at least kLargePage start on a large page's
// boundary, and the kernel is asked to use such pages; where it cannot, nothing else changes.
template <typename T>
class LargePageAllocator {
 public:
  using value_type = T;
  static constexpr std::size_t kLargePage = std::size_t{1} << 21U;  // [B]

  LargePageAllocator() = default;
  template <typename U>
  LargePageAllocator(const LargePageAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kLargePage) return static_cast<T*>(::operator new (bytes, std::align_val_t{alignof(T)}));
    const std::size_t rounded = (bytes + kLargePage - 1) / kLargePage * kLargePage;
    void* const memory = std::aligned_alloc(kLargePage, rounded);
    if (memory == nullptr) throw std::bad_alloc();
    madvise(memory, rounded, MADV_HUGEPAGE);  // a request that may be refused
    return static_cast<T*>(memory);
  }

  void deallocate(T* memory, std::size_t count) {
    if (count * sizeof(T) < kLargePage) {
      ::operator delete (memory, std::align_val_t{alignof(T)});
    } else {
      std::free(memory);  // NOLINT(cppcoreguidelines-no-malloc): the counterpart of aligned_alloc
    }
  }

  friend bool operator==(const LargePageAllocator& /*a*/, const LargePageAllocator& /*b*/) { return true; }
};

template <typename T>
using LargePageArray = std::vector<T, LargePageAllocator<T>>;

}  // namespace buoyancy
