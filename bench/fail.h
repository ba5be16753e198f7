// Error handling of the benchmarks: report the error and exit with status 1.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <utility>

#include "base/error.h"

namespace buoyancy::bench {

// Returns the value, or prints the error and exits with status 1.
template <typename T>
T value_or_exit(Expected<T> expected) {
  if (!expected) {
    std::fprintf(stderr, "%s\n", expected.error().message().c_str());
    std::exit(1);  // NOLINT(concurrency-mt-unsafe): one thread only
  }
  if constexpr (!std::is_void_v<T>) return std::move(*expected);
}

// Reports a wrong result and exits with status 1.
[[noreturn]] inline void fail(const std::string& reason) {
  value_or_exit<void>(make_error({"benchmark", reason, "right results", "", ""}));
  std::abort();
}

}  // namespace buoyancy::bench
