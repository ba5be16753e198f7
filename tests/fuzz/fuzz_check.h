// A law that no input may break. What breaks one is a finding: libFuzzer keeps the input where the process
// aborts.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace buoyancy {

[[noreturn]] inline void fail_requirement(const char* law, const std::string& found = {}) {
  std::fprintf(stderr, "broken law: %s%s%s\n", law, found.empty() ? "" : ": ", found.c_str());
  std::abort();
}

inline void law(bool holds, const char* law) {
  if (!holds) fail_requirement(law);
}

}  // namespace buoyancy
