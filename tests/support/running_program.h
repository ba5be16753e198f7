// A program that prints "ready:" once it can be used, as a child process of a test.
#pragma once

#include <stdexcept>

#include "tests/support/child_process.h"
#include "tests/support/timeouts.h"

namespace buoyancy {

class RunningProgram : public ChildProcess {
 public:
  // Returns once the program is ready. Throws std::runtime_error with the program's standard error if it ends
  // before or is not ready within kWaitTimeout.
  explicit RunningProgram(const ChildCommand& command) : ChildProcess(command) {
    if (!wait_for_text("ready:", kWaitTimeout)) {
      throw std::runtime_error(command.arguments.front() + " did not become ready: " + standard_error());
    }
  }
};

}  // namespace buoyancy
