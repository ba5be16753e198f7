// Runs a program as a child process of a test, captures its output and guarantees that it does not outlive
// the test.
//
// The child's standard output and error go into memory files, so that a child never blocks on a full pipe and
// its output can be read while it runs and after it ended. The destructor kills and reaps a child that still
// runs; the kernel kills it if the thread that started it dies first. Linux only. Use from one thread at a
// time.
//
// with_descendants is for programs that start others, such as a browser. It puts a supervisor process between
// the test and the program, which inherits every descendant that loses its parent, in any session or group.
// When the program ends or the test dies, even by SIGKILL, the supervisor kills all descendants, and it ends
// when none is left; wait() and the destructor return then.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "tests/support/timeouts.h"

namespace buoyancy {

struct ChildCommand {
  std::vector<std::string> arguments;    // the program's path first; searched for in $PATH
  std::vector<std::string> environment;  // "NAME=value", added to the test's own
  std::string standard_input = "/dev/null";
  std::string standard_output;  // a path such as "/dev/full"; empty: captured
  std::string directory;        // to run in; empty: the test's own
  bool with_descendants = false;
};

inline ChildCommand command_of(std::vector<std::string> arguments) {
  ChildCommand command;
  command.arguments = std::move(arguments);
  return command;
}

class ChildProcess {
 public:
  // A program that cannot be started exits with 127 and reports that on its standard error.
  explicit ChildProcess(const ChildCommand& command);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  pid_t pid() const { return pid_; }   // with descendants: the supervisor's
  void send_signal(int signal) const;  // no effect after the child has been reaped

  // Returns the exit code, or 128 + the signal that ended it; nullopt: still running after `seconds`.
  std::optional<int> wait(double seconds);

  // Waits until standard output or standard error contains `text`. Returns false if that does not happen
  // within `seconds` or before the child ends.
  bool wait_for_text(const std::string& text, double seconds);

  std::string standard_output() const;  // so far
  std::string standard_error() const;   // so far

 private:
  pid_t pid_ = -1;
  int process_fd_ = -1;  // readable when the child has ended
  int output_fd_ = -1;
  int error_fd_ = -1;
  int supervisor_fd_ = -1;  // receives one byte per signal; -1 without a supervisor
  std::optional<int> exit_code_;
};

struct FinishedProcess {
  std::optional<int> exit_code;  // nullopt: killed because it did not end in time
  std::string standard_output;
  std::string standard_error;
};

// Starts a program, waits at most `seconds` for its end and kills it otherwise.
FinishedProcess run_to_end(const ChildCommand& command, double seconds);
// The same with a program of this build, such as "buoyancyd".
FinishedProcess run_program(const std::string& name, std::vector<std::string> arguments,
                            double seconds = kWaitTimeout);

}  // namespace buoyancy
