#include "geometry/import_process.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/format.h"
#include "base/unique_fd.h"
#include "geometry/assimp_reader.h"
#include "geometry/import_pipe.h"

namespace buoyancy {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kShadowMemory = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kShadowMemory = true;
#else
constexpr bool kShadowMemory = false;
#endif
#else
constexpr bool kShadowMemory = false;
#endif

constexpr int kOutOfMemoryExit = 71;

// ---- child process ----------------------------------------------------------------------------------------

void limit_resource(__rlimit_resource resource, std::uint64_t max) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(max, limit.rlim_max);
  ::setrlimit(resource, &limit);
}

std::uint64_t address_space_in_use() {
  unsigned long pages = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(statm, "%lu", &pages) != 1) pages = 0;  // NOLINT(cert-err34-c): written by the kernel
    std::fclose(statm);
  }
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

// Makes the kernel's out-of-memory killer prefer the child to its parent.
void prefer_for_oom_kill() {
  if (std::FILE* score = std::fopen("/proc/self/oom_score_adj", "we")) {
    std::fputs("1000", score);
    std::fclose(score);
  }
}

// Restores default handlers, so that a crash ends the child instead of running a handler of the parent.
void restore_signals() {
  struct sigaction by_default {};
  by_default.sa_handler = SIG_DFL;
  for (int signal = 1; signal < NSIG; ++signal) ::sigaction(signal, &by_default, nullptr);
  sigset_t none;
  ::sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
}

// Redirects standard input and outputs to /dev/null (assimp prints) and moves the pipe to descriptor 3.
// Closes all other descriptors, since sockets and pipes of concurrent imports would stay open in the child.
int keep_only_pipe(int pipe) {
  constexpr int kPipe = 3;
  if (pipe != kPipe) ::dup2(pipe, kPipe);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int standard = 0; standard < kPipe; ++standard) {
    if (null >= 0) ::dup2(null, standard);
  }
  ::close_range(kPipe + 1, ~0U, 0);
  return kPipe;
}

[[noreturn]] void run_child(int pipe, pid_t parent, const std::filesystem::path& path, MeshFormat format,
                            const ImportLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(EXIT_FAILURE);  // the parent died before the line above
  restore_signals();
  if (!kShadowMemory) limit_resource(RLIMIT_AS, address_space_in_use() + limits.memory_bytes);
  limit_resource(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(limits.import_seconds)) + 1);
  limit_resource(RLIMIT_CORE, 0);
  prefer_for_oom_kill();
  ::prctl(PR_SET_DUMPABLE, 0);  // no core dump through a core_pattern pipe
  pipe = keep_only_pipe(pipe);
  std::set_new_handler([] { ::_exit(kOutOfMemoryExit); });
  try {
    const Expected<ImportedMesh> result = read_with_assimp(path, format, limits);
    ::_exit(send_import(pipe, result) ? EXIT_SUCCESS : EXIT_FAILURE);
  } catch (const std::bad_alloc&) {
    ::_exit(kOutOfMemoryExit);
  } catch (...) {
    ::_exit(EXIT_FAILURE);
  }
}

// ---- parent process ---------------------------------------------------------------------------------------

// Kills and reaps the child on destruction if it still runs.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Returns the wait status of a child that ends by itself before `deadline`; nullopt if it had to be killed
  // or if other code of this process has reaped it.
  std::optional<int> wait_until(ImportDeadline deadline) {
    while (pid_ > 0) {
      int status = 0;
      const pid_t reaped = ::waitpid(pid_, &status, WNOHANG);
      if (reaped == pid_) {
        pid_ = 0;
        return status;
      }
      if (reaped < 0 && errno != EINTR) pid_ = 0;
      if (ImportDeadline::clock::now() >= deadline) end();
      if (pid_ > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return std::nullopt;
  }

  void end() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
  }

 private:
  pid_t pid_;
};

Error timed_out(const ImportLimits& limits) {
  return {"", "the importer had not finished after " + format_shortest(limits.import_seconds) + " s",
          "an import within that time (limit 'import_seconds')",
          "the file is damaged and the importer does not terminate on it, or it is very large",
          "Export the file again, or raise 'import_seconds' under [limits]"};
}

Error out_of_memory(const ImportLimits& limits) {
  return {"",
          "the importer needed more than " + format_shortest(static_cast<double>(limits.memory_bytes) / 1e9) +
              " GB",
          "a file that can be read within that memory",
          "the file is damaged and claims more data than it holds, or it is very large",
          "Export the file again, or simplify the mesh"};
}

Error killed() {
  return {"", "the importer was killed while reading the file (signal 9)",
          "a file that can be read in the available memory",
          "the machine ran out of memory and the kernel killed the importer",
          "Simplify the mesh, or use a larger machine"};
}

Error crashed(const std::string& how) {
  return {"", "the importer " + how, "a file that can be read",
          "the file is cut short, damaged or of another format",
          "Open it in a mesh editor and export it again"};
}

Error system_failure(const char* call) {
  return {"", std::string(call) + " failed: " + std::generic_category().message(errno),
          "a child process that reads the file",
          "a resource limit of this process or of the machine is reached", "Try again; see ulimit -a"};
}

Error explain(std::optional<int> status, const ImportLimits& limits) {
  if (!status) return crashed("ended without a result");
  if (WIFSIGNALED(*status)) {
    const int signal = WTERMSIG(*status);
    if (signal == SIGXCPU) return timed_out(limits);
    if (signal == SIGKILL) return killed();
    const char* name = ::sigdescr_np(signal);
    return crashed("crashed (signal " + std::to_string(signal) + (name ? std::string(", ") + name : "") +
                   ")");
  }
  if (WEXITSTATUS(*status) == kOutOfMemoryExit) return out_of_memory(limits);
  return crashed("failed (exit status " + std::to_string(WEXITSTATUS(*status)) + ")");
}

}  // namespace

Expected<ImportedMesh> import_in_child_process(const std::filesystem::path& path, MeshFormat format,
                                               const ImportLimits& limits) {
  assert(limits.import_seconds > 0.0);
  constexpr double kMaxSeconds = 1e8;  // three years, within the range of the clock's ticks
  const std::chrono::duration<double> timeout(std::min(limits.import_seconds, kMaxSeconds));
  const ImportDeadline deadline =
      ImportDeadline::clock::now() + std::chrono::duration_cast<ImportDeadline::clock::duration>(timeout);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return make_error(system_failure("pipe"));
  const UniqueFd read_end(ends[0]);
  UniqueFd write_end(ends[1]);

  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) return make_error(system_failure("fork"));
  if (pid == 0) run_child(write_end.value(), parent, path, format, limits);
  Child child(pid);
  write_end.close();  // the pipe then ends when the child ends

  auto outcome = receive_import(read_end.value(), limits, deadline);
  if (auto* result = std::get_if<Expected<ImportedMesh>>(&outcome)) return std::move(*result);
  if (std::get<ImportFailure>(outcome) == ImportFailure::kTimedOut) return make_error(timed_out(limits));
  // The pipe has ended, so the child is about to end, unless it has only closed the pipe.
  return make_error(explain(
      child.wait_until(std::min(deadline, ImportDeadline::clock::now() + std::chrono::seconds(5))), limits));
}

}  // namespace buoyancy
