#include "tests/support/child_process.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/build_paths.h"
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

// Returns the inherited environment, in which given entries replace those of the same name.
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

int exit_code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Not pidfd_open(): the header of glibc 2.36 declares it without extern "C".
int open_process(pid_t pid) {
  return static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
}

// The data that the child of fork() needs. Between fork and exec the child of a threaded test may not
// allocate.
struct Program {
  const ChildCommand& command;
  const std::vector<char*>& argv;
  const std::vector<char*>& envp;
  int output_fd;
  int error_fd;
};

[[noreturn]] void execute(const Program& program, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  const int input = open(program.command.standard_input.c_str(), O_RDONLY);
  const int output = program.command.standard_output.empty()
                         ? program.output_fd
                         : open(program.command.standard_output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const bool ready = input >= 0 && output >= 0 && dup2(input, STDIN_FILENO) >= 0 &&
                     dup2(output, STDOUT_FILENO) >= 0 && dup2(program.error_fd, STDERR_FILENO) >= 0 &&
                     (program.command.directory.empty() || chdir(program.command.directory.c_str()) == 0);
  if (ready) execvpe(program.argv[0], program.argv.data(), program.envp.data());
  dprintf(STDERR_FILENO, "child process: cannot start %s\n", program.argv[0]);
  _exit(127);
}

void kill_children() {
  const int list = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
  std::array<char, 4096> text{};
  const ssize_t size = read(list, text.data(), text.size() - 1);
  close(list);
  if (size < 0) _exit(126);
  // "PID PID ", with the last one truncated if the list is too long; the rest is killed in the next round.
  pid_t pid = 0;
  for (ssize_t i = 0; i < size; ++i) {
    const char c = text[static_cast<std::size_t>(i)];
    if (c != ' ') {
      pid = 10 * pid + (c - '0');
      continue;
    }
    kill(pid, SIGKILL);
    pid = 0;
  }
}

// The supervisor's main program. It kills its children only: the children of a killed child become its own. A
// process id cannot refer to another process, since the kernel does not reuse it before the child is reaped.
[[noreturn]] void supervise(const Program& program, int commands) {
  // In a session of its own the supervisor does not get the terminal's SIGINT; it observes the end of the
  // test as end-of-file on `commands`.
  setsid();
  prctl(PR_SET_PDEATHSIG, 0);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t self = getpid();
  const pid_t pid = fork();
  if (pid < 0) _exit(126);
  if (pid == 0) execute(program, self);
  const int process = open_process(pid);
  if (process < 0) _exit(126);
  // Close all other inherited descriptors, such as other supervisors' `commands`, which must end with the
  // test.
  const int keep[] = {commands, process};
  const int nothing = open("/dev/null", O_RDWR);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, fd);
  const auto low = static_cast<unsigned>(keep[0] < keep[1] ? keep[0] : keep[1]);
  const auto high = static_cast<unsigned>(keep[0] < keep[1] ? keep[1] : keep[0]);
  if (low > 3) close_range(3, low - 1, 0);
  if (high > low + 1) close_range(low + 1, high - 1, 0);
  close_range(high + 1, ~0U, 0);

  std::array<pollfd, 2> sources{{{commands, POLLIN, 0}, {process, POLLIN, 0}}};
  while (sources[1].revents == 0) {
    poll(sources.data(), sources.size(), -1);
    if (sources[0].revents == 0) continue;
    char signal = SIGKILL;
    if (read(commands, &signal, 1) != 1 || signal == SIGKILL) break;
    kill(pid, signal);
  }
  int exit_code = 128 + SIGKILL;
  while (true) {
    kill_children();
    int status = 0;
    pid_t ended = 0;
    while ((ended = waitpid(-1, &status, WNOHANG)) > 0) {
      if (ended == pid) exit_code = exit_code_of(status);
    }
    if (ended < 0 && errno == ECHILD) _exit(exit_code);
    poll(nullptr, 0, 1);  // some children are still terminating
  }
}

}  // namespace

ChildProcess::ChildProcess(const ChildCommand& command) {
  // Everything is allocated before fork: between fork and exec the child of a threaded test may not allocate.
  std::vector<std::string> arguments = command.arguments;
  std::vector<std::string> environment = merged_environment(command.environment);
  const std::vector<char*> argv = pointers(arguments);
  const std::vector<char*> envp = pointers(environment);
  output_fd_ = memfd_create("child's standard output", MFD_CLOEXEC);
  error_fd_ = memfd_create("child's standard error", MFD_CLOEXEC);
  if (output_fd_ < 0 || error_fd_ < 0) fail("memfd_create");
  const Program program{command, argv, envp, output_fd_, error_fd_};
  std::array<int, 2> commands{-1, -1};
  if (command.with_descendants && socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, commands.data()) != 0) {
    fail("socketpair");
  }
  const pid_t parent = getpid();

  pid_ = fork();
  if (pid_ < 0) fail("fork");
  if (pid_ == 0) {
    if (!command.with_descendants) execute(program, parent);
    supervise(program, commands[0]);
  }
  if (command.with_descendants) {
    close(commands[0]);
    supervisor_fd_ = commands[1];
  }
  process_fd_ = open_process(pid_);
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
  if (supervisor_fd_ >= 0) close(supervisor_fd_);
}

void ChildProcess::send_signal(int signal) const {
  if (exit_code_) return;
  if (supervisor_fd_ < 0) {
    kill(pid_, signal);
    return;
  }
  const auto byte = static_cast<char>(signal);
  send(supervisor_fd_, &byte, 1, MSG_NOSIGNAL);  // fails if the supervisor has just ended
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
  exit_code_ = exit_code_of(status);
  return exit_code_;
}

bool ChildProcess::wait_for_text(const std::string& text, double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const auto written = [&] {
    return standard_output().find(text) != std::string::npos ||
           standard_error().find(text) != std::string::npos;
  };
  while (!written()) {
    // Check once more after the end: the last output may have been written in between.
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

FinishedProcess run_program(const std::string& name, std::vector<std::string> arguments, double seconds) {
  arguments.insert(arguments.begin(), built_program(name));
  return run_to_end(command_of(std::move(arguments)), seconds);
}

}  // namespace buoyancy
