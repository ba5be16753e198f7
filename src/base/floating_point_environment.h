// The floating-point environment of the caller, which a library must neither suffer from nor change.
#pragma once

#include <cfenv>
#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace buoyancy {

// For its life, this thread rounds to nearest, keeps subnormal numbers and traps nothing, whatever the
// program around the library has set; the end restores the program's settings and its exception flags.
// Threads that are started meanwhile inherit the defaults.
class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

#if defined(__x86_64__)
  // About 10 ns where the x87 unit, which long double uses, has its defaults: the functions of <cfenv>, which
  // save it as well, take some hundred.
  DefaultFloatingPoint() noexcept : sse_(_mm_getcsr()) {
    std::uint16_t x87 = 0;
    __asm__ volatile("fnstcw %0" : "=m"(x87));
    is_x87_default_ = x87 == kX87Default;
    if (!is_x87_default_) {
      std::fegetenv(&saved_);
      std::fesetenv(FE_DFL_ENV);
    }
    x87_flags_ = x87_flags();
    _mm_setcsr(kSseDefault);
  }
  ~DefaultFloatingPoint() {
    if (!is_x87_default_) {
      std::fesetenv(&saved_);
    } else if (const int raised = x87_flags() & ~x87_flags_; raised != 0) {
      std::feclearexcept(raised);
    }
    _mm_setcsr(sse_);
  }

 private:
  // All exceptions masked, none pending; x87: extended precision.
  static constexpr unsigned kSseDefault = 0x1F80;
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
