// How long a test waits for a condition before it fails, in seconds. A timeout is never what a test measures:
// on an idle machine every wait ends after milliseconds, and the limit only has to tell "slow" from "never".
//
// BUOYANCY_TEST_TIMEOUT_FACTOR in the environment multiplies all of them, for sanitizers, emulators and
// machines that are busy with other things. CTest's own limit is the cache variable BUOYANCY_TEST_TIMEOUT
// (tests/CMakeLists.txt).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace buoyancy {

// At least 1; 1 also where the variable is not a number.
inline double timeout_factor() {
  static const double factor = [] {
    const char* const text = std::getenv("BUOYANCY_TEST_TIMEOUT_FACTOR");  // NOLINT(concurrency-mt-unsafe)
    const double given = text == nullptr ? 1.0 : std::strtod(text, nullptr);
    return std::isfinite(given) ? std::max(given, 1.0) : 1.0;
  }();
  return factor;
}

// For one condition: a process is ready or has ended, a message has come, a page shows something.
inline const double kWaitTimeout = 60.0 * timeout_factor();

// For a program to do all of its work and end.
inline const double kRunTimeout = 250.0 * timeout_factor();

// As poll(2) takes it.
inline int to_milliseconds(double seconds) {
  return static_cast<int>(std::ceil(seconds * 1e3));
}

}  // namespace buoyancy
