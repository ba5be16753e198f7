// Requirements that must hold for every input. A violation is a finding: the process aborts, and libFuzzer
// keeps the input.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace buoyancy {

[[noreturn]] inline void fail_requirement(const char* requirement, const std::string& actual = {}) {
  std::fprintf(stderr, "violated requirement: %s%s%s\n", requirement, actual.empty() ? "" : ": ",
               actual.c_str());
  std::abort();
}

inline void require(bool holds, const char* requirement) {
  if (!holds) fail_requirement(requirement);
}

}  // namespace buoyancy
