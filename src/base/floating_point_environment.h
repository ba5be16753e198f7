// The floating-point environment of the caller, which a library must neither suffer from nor change.
#pragma once

#include <cfenv>
#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace buoyancy {

// While an object lives, its thread rounds to nearest, keeps subnormal numbers and traps nothing, whatever
// the program around the library has set. The destructor restores the program's settings and exception flags.
// Threads started meanwhile inherit the defaults.
class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

#if defined(__x86_64__)
  // This takes some 5 ns if both units have their default settings; the x87 unit computes with long double.
  // The functions of <cfenv>, which always save that unit, take some 100 ns.
  DefaultFloatingPoint() noexcept : sse_(_mm_getcsr()) {
    std::uint16_t x87 = 0;
    __asm__ volatile("fnstcw %0" : "=m"(x87));
    is_x87_default_ = x87 == kX87Default;
    if (!is_x87_default_) {
      std::fegetenv(&saved_);
      std::fesetenv(FE_DFL_ENV);
    }
    x87_flags_ = x87_flags();
    if ((sse_ & ~kSseFlags) != kSseDefault) _mm_setcsr(kSseDefault);
  }
  ~DefaultFloatingPoint() {
    if (!is_x87_default_) {
      std::fesetenv(&saved_);
    } else if (const int raised = x87_flags() & ~x87_flags_; raised != 0) {
      std::feclearexcept(raised);
    }
    if (_mm_getcsr() != sse_) _mm_setcsr(sse_);
  }

 private:
  // Both mask all exceptions and have none pending; the x87 unit computes in extended precision.
  static constexpr unsigned kSseDefault = 0x1F80;
  static constexpr unsigned kSseFlags = 0x3F;  // of exceptions so far
  static constexpr std::uint16_t kX87Default = 0x037F;

  static int x87_flags() {
    std::uint16_t status = 0;
    __asm__ volatile("fnstsw %0" : "=am"(status));
    return status & FE_ALL_EXCEPT;
  }

  unsigned sse_;
  int x87_flags_ = 0;
  bool is_x87_default_ = true;
#else
  DefaultFloatingPoint() noexcept {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatingPoint() {
    std::fesetenv(&saved_);
  }

 private:
#endif
  std::fenv_t saved_;
};

}  // namespace buoyancy
