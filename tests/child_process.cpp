#include "tests/child_process.h"

#include <array>
#include <chrono>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  result.reserve(strings.size() + 1);
  for (std::string& string : strings) result.push_back(string.data());
  result.push_back(nullptr);
  return result;
}

// An entry that is given replaces an inherited one of the same name.
std::vector<std::string> merged_environment(const std::vector<std::string>& given) {
  std::vector<std::string> merged = given;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string inherited = *entry;
    const std::string name = inherited.substr(0, inherited.find('=') + 1);
    bool replaced = false;
    for (const std::string& own : given) replaced = replaced || own.compare(0, name.size(), name) == 0;
    if (!replaced) merged.push_back(inherited);
  }
  return merged;
}

std::string contents(int fd) {
  std::string text;
  std::array<char, 65536> buffer{};
  while (true) {
    // pread: the file offset is shared with the child, which appends there.
    const ssize_t n = pread(fd, buffer.data(), buffer.size(), static_cast<off_t>(text.size()));
    if (n <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

int milliseconds(double seconds) {
  return static_cast<int>(seconds * 1e3) + 1;
}

}  // namespace

ChildProcess::ChildProcess(const ChildCommand& command) {
  // All that allocates happens before fork: between fork and exec the child of a threaded test may not.
  std::vector<std::string> arguments = command.arguments;
  std::vector<std::string> environment = merged_environment(command.environment);
  const std::vector<char*> argv = pointers(arguments);
  const std::vector<char*> envp = pointers(environment);
  output_fd_ = memfd_create("child's standard output", MFD_CLOEXEC);
  error_fd_ = memfd_create("child's standard error", MFD_CLOEXEC);
  if (output_fd_ < 0 || error_fd_ < 0) fail("memfd_create");
  const pid_t parent = getpid();

  pid_ = fork();
  if (pid_ < 0) fail("fork");
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    const int input = open(command.standard_input.c_str(), O_RDONLY);
    const int output = command.standard_output.empty()
                           ? output_fd_
                           : open(command.standard_output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const bool ready = input >= 0 && output >= 0 && dup2(input, STDIN_FILENO) >= 0 &&
                       dup2(output, STDOUT_FILENO) >= 0 && dup2(error_fd_, STDERR_FILENO) >= 0 &&
                       (command.directory.empty() || chdir(command.directory.c_str()) == 0);
    if (ready) execvpe(argv[0], argv.data(), envp.data());
    dprintf(STDERR_FILENO, "child process: cannot start %s\n", argv[0]);
    _exit(127);
  }

  // Not pidfd_open(): the header of glibc 2.36 declares it without extern "C".
  process_fd_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
  if (process_fd_ < 0) fail("pidfd_open");
}

ChildProcess::~ChildProcess() {
  if (!exit_code_) {
    send_signal(SIGKILL);
    wait(kWaitTimeout);
  }
  close(process_fd_);
  close(output_fd_);
  close(error_fd_);
}

void ChildProcess::send_signal(int signal) const {
  if (!exit_code_) kill(pid_, signal);
}

std::optional<int> ChildProcess::wait(double seconds) {
  if (exit_code_) return exit_code_;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  pollfd ended{process_fd_, POLLIN, 0};
  while (poll(&ended, 1, milliseconds(seconds)) <= 0) {
    seconds = std::chrono::duration<double>(deadline - std::chrono::steady_clock::now()).count();
    if (seconds <= 0.0) return std::nullopt;
  }
  int status = 0;
  if (waitpid(pid_, &status, 0) != pid_) fail("waitpid");
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return exit_code_;
}

bool ChildProcess::wait_for_text(const std::string& text, double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const auto written = [&] {
    return standard_output().find(text) != std::string::npos ||
           standard_error().find(text) != std::string::npos;
  };
  while (!written()) {
    // Looks once more after the end: the last words may have come in between.
    if (wait(0.002)) return written();
    if (std::chrono::steady_clock::now() >= deadline) return false;
  }
  return true;
}

std::string ChildProcess::standard_output() const {
  return contents(output_fd_);
}

std::string ChildProcess::standard_error() const {
  return contents(error_fd_);
}

FinishedProcess run_to_end(const ChildCommand& command, double seconds) {
  ChildProcess child(command);
  FinishedProcess finished;
  finished.exit_code = child.wait(seconds);
  if (!finished.exit_code) {
    child.send_signal(SIGKILL);
    child.wait(kWaitTimeout);
  }
  finished.standard_output = child.standard_output();
  finished.standard_error = child.standard_error();
  return finished;
}

}  // namespace buoyancy
