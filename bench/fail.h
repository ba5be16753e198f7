// How a benchmark ends that could not measure.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <utility>

#include "base/error.h"

namespace buoyancy::bench {

// What could not be measured, or was answered wrongly, ends the program.
template <typename T>
T value_or_exit(Expected<T> expected) {
  if (!expected) {
    std::fprintf(stderr, "%s\n", expected.error().message().c_str());
    std::exit(1);  // NOLINT(concurrency-mt-unsafe): one thread of ours
  }
  if constexpr (!std::is_void_v<T>) return std::move(*expected);
}

[[noreturn]] inline void fail(const std::string& reason) {
  value_or_exit<void>(make_error({"benchmark", reason, "right results", "", ""}));
  std::abort();
}

}  // namespace buoyancy::bench
