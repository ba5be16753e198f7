#include "geometry/import_process.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/format.h"
#include "base/unique_fd.h"
#include "geometry/import_channel.h"
#include "geometry/importer_program.h"
#include "geometry/mesh_folder.h"

namespace buoyancy {
namespace {

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

Error system_failure(const std::string& call, int error) {
  return {"", call + " failed: " + std::generic_category().message(error),
          "a child process that reads the file",
          "a resource limit of this process or of the machine is reached", "Try again; see ulimit -a"};
}

Error other_release() {
  return {"", "buoyancy-import-mesh is of another release",
          "the one that was built with this program or library", "one of them was upgraded without the other",
          "Install both from the same release"};
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
  if (WEXITSTATUS(*status) == kOtherProtocolExit) return other_release();
  return crashed("failed (exit status " + std::to_string(WEXITSTATUS(*status)) + ")");
}

// The importer starts with its socket and no other descriptor, environment or signal handler.
class SpawnSettings {
 public:
  explicit SpawnSettings(int socket) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, socket, kImporterSocket);
    for (int standard = 0; standard < kImporterSocket; ++standard) {
      ::posix_spawn_file_actions_addclose(&actions_,
                                          standard);  // the importer opens /dev/null, if there is one
    }
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, kImporterSocket + 1);
    ::posix_spawnattr_init(&attributes_);
    sigset_t signals;
    ::sigfillset(&signals);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
    ::sigemptyset(&signals);
    ::posix_spawnattr_setsigmask(&attributes_, &signals);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnSettings() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  // Returns 0 or the number of the error.
  int start(std::string program, pid_t& pid) const {
    std::string protocol = kImportProtocol;
    std::array<char*, 3> arguments{program.data(), protocol.data(), nullptr};
    std::array<char*, 1> environment{nullptr};
    return ::posix_spawn(&pid, program.c_str(), &actions_, &attributes_, arguments.data(),
                         environment.data());
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

Error named_outside(Error error, const std::string& name) {
  error.cause = "it refers to '" + printable_ascii(name) +
                "', which leads out of its folder, and nothing is read from there";
  error.hint = "Put the files that the mesh needs into its folder";
  return error;
}

}  // namespace

Expected<StoredMesh> import_in_child_process(const std::filesystem::path& path, MeshFormat format,
                                             const ImportLimits& limits) {
  assert(limits.import_seconds > 0.0);
  constexpr double kMaxSeconds = 1e8;  // three years, within the range of the clock's ticks
  const std::chrono::duration<double> timeout(std::min(limits.import_seconds, kMaxSeconds));
  const ImportDeadline deadline =
      ImportDeadline::clock::now() + std::chrono::duration_cast<ImportDeadline::clock::duration>(timeout);
  const Expected<std::string> program = importer_program();
  if (!program) return make_error(program.error());
  MeshFolder folder(path, limits.mesh_bytes);
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return make_error(system_failure("socketpair", errno));
  }
  const UniqueFd socket(ends[0]);
  UniqueFd importers_end(ends[1]);
  pid_t pid = 0;
  if (const int failed = SpawnSettings(importers_end.value()).start(*program, pid); failed != 0) {
    return make_error(system_failure("starting " + *program, failed));
  }
  Child child(pid);
  importers_end.close();  // the channel then ends when the importer ends

  send_request(socket.value(), {path.filename().string(), format, limits});
  auto outcome = receive_import(socket.value(), limits, deadline,
                                [&folder](const std::string& name) { return folder.open(name); });
  if (auto* result = std::get_if<Expected<StoredMesh>>(&outcome)) {
    if (!*result && !folder.outside().empty()) {
      return make_error(named_outside(std::move(result->error()), folder.outside()));
    }
    return std::move(*result);
  }
  if (std::get<ImportFailure>(outcome) == ImportFailure::kTimedOut) return make_error(timed_out(limits));
  // The channel has ended, so the child is about to end, unless it has only closed its socket.
  return make_error(explain(
      child.wait_until(std::min(deadline, ImportDeadline::clock::now() + std::chrono::seconds(5))), limits));
}

}  // namespace buoyancy
