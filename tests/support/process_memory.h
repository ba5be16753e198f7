// The memory of a process as the kernel reports it.
#pragma once

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

#include <sys/types.h>

namespace buoyancy {

// Returns VmRSS [kB]. Throws if there is no such process.
inline std::int64_t resident_kb(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  std::string word;
  while (status >> word) {
    if (word != "VmRSS:") continue;
    std::int64_t kilobytes = 0;
    status >> kilobytes;
    return kilobytes;
  }
  throw std::runtime_error("process " + std::to_string(process) + " is gone");
}

}  // namespace buoyancy
