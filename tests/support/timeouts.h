// How long a test waits for a condition before it fails [s]. Tests never measure these limits: on an idle
// machine every wait ends after milliseconds, and a limit only distinguishes "slow" from "never".
//
// The environment variable BUOYANCY_TEST_TIMEOUT_FACTOR multiplies all of them, for sanitizers, emulators and
// loaded machines. CTest's own limit is the cache variable BUOYANCY_TEST_TIMEOUT (tests/CMakeLists.txt).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace buoyancy {

// At least 1; also 1 if the variable is not a number.
inline double timeout_factor() {
  static const double factor = [] {
    const char* const text = std::getenv("BUOYANCY_TEST_TIMEOUT_FACTOR");  // NOLINT(concurrency-mt-unsafe)
    const double given = text == nullptr ? 1.0 : std::strtod(text, nullptr);
    return std::isfinite(given) ? std::max(given, 1.0) : 1.0;
  }();
  return factor;
}

// For one condition: a process is ready or has ended, a message has arrived, a page shows something.
inline const double kWaitTimeout = 60.0 * timeout_factor();

// For a program to complete its work and end.
inline const double kRunTimeout = 250.0 * timeout_factor();

// Converts to the argument of poll(2).
inline int to_milliseconds(double seconds) {
  return static_cast<int>(std::ceil(seconds * 1e3));
}

}  // namespace buoyancy
