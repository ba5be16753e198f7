#include "geometry/import_process.h"

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "geometry/mesh_import.h"
#include "tests/geometry/import_checks.h"
#include "tests/geometry/mesh_files.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

namespace fs = std::filesystem;

using ImportProcess = ImportTest;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kShadowMemory = true;
#elif defined(__has_feature)
constexpr bool kShadowMemory = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kShadowMemory = false;
#endif

// assimp compares the name of each object with those of all before it, so that this file keeps it busy for
// minutes.
std::string endless_obj() {
  constexpr int kObjects = 500'000;
  std::string text;
  for (int i = 0; i < kObjects; ++i) text += "o object_number_" + std::to_string(i) + "\n";
  return text + tetrahedron::obj();
}

// assimp calls itself for every level of nodes, and runs out of stack.
std::string crashing_dae() {
  constexpr int kLevels = 300'000;
  std::string nodes;
  for (int i = 0; i < kLevels; ++i) nodes += "<node>";
  for (int i = 0; i < kLevels; ++i) nodes += "</node>";
  return tetrahedron::collada("", nodes);
}

// Limits for imports that are not timed: the timeout suffices on a busy machine.
ImportLimits long_timeout() {
  ImportLimits limits;
  limits.import_seconds = kRunTimeout;
  return limits;
}

TEST_F(ImportProcess, StopsHangingImporter) {
  ImportLimits limits;
  limits.import_seconds = 0.5;
  const std::string message = import_error(directory_.write("endless.obj", endless_obj()), limits);
  EXPECT_TRUE(contains(message, "had not finished after 0.5 s"));
  EXPECT_TRUE(contains(message, "'import_seconds'"));
}

TEST_F(ImportProcess, SurvivesCrashOfImporter) {
  EXPECT_TRUE(contains(import_error(directory_.write("crash.dae", crashing_dae()), long_timeout()),
                       kShadowMemory ? "the importer " : "the importer crashed (signal "));
}

TEST_F(ImportProcess, StopsImporterAtMemoryLimit) {
  // The importer's limit is RLIMIT_AS, and these sanitizers reserve terabytes of addresses before main().
  if (kShadowMemory) {
    GTEST_SKIP() << "address space cannot be limited under this sanitizer; use a preset without it, such as "
                    "release or ubsan";
  }
  ImportLimits limits = long_timeout();
  limits.memory_bytes = 200'000'000;
  const std::string header = "OFF\n50000000 50000000 0\n";
  const std::string message = import_error(directory_.write("greedy.off", header + "0 0 0\n"), limits);
  EXPECT_TRUE(contains(message, "needed more than 0.2 GB"));
}

TEST_F(ImportProcess, SupportsConcurrentImports) {
  const fs::path good = directory_.write("good.off", tetrahedron::off());
  const fs::path crash = directory_.write("crash.dae", crashing_dae());
  const fs::path endless = directory_.write("endless.obj", endless_obj());
  ImportLimits short_timeout;
  short_timeout.import_seconds = 1.0;
  std::vector<std::future<bool>> imports;
  for (const fs::path& file : {endless, good, crash, good, crash, good}) {
    const ImportLimits limits = file == endless ? short_timeout : long_timeout();
    imports.push_back(std::async(std::launch::async, [=] { return import_mesh(file, limits).has_value(); }));
  }
  for (std::size_t i = 0; i < imports.size(); ++i) EXPECT_EQ(imports[i].get(), i % 2 == 1) << i;
}

TEST_F(ImportProcess, WorksIfProgramIgnoresSigchld) {
  struct sigaction before {};
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;  // the kernel then reaps every child at once
  ASSERT_EQ(::sigaction(SIGCHLD, &ignore, &before), 0);
  EXPECT_TRUE(import_mesh(directory_.write("good.off", tetrahedron::off()), long_timeout()));
  import_error(directory_.write("crash.dae", crashing_dae()), long_timeout());
  ASSERT_EQ(::sigaction(SIGCHLD, &before, nullptr), 0);
}

TEST_F(ImportProcess, ToleratesSignalsToProgram) {
  struct sigaction before {};
  struct sigaction handle {};
  handle.sa_handler = [](int) {};  // without SA_RESTART: every system call is interrupted
  ASSERT_EQ(::sigaction(SIGALRM, &handle, &before), 0);
  const itimerval every_millisecond{{0, 1000}, {0, 1000}};
  const itimerval never{};
  ::setitimer(ITIMER_REAL, &every_millisecond, nullptr);
  ImportLimits limits;
  limits.import_seconds = 0.3;
  EXPECT_TRUE(
      contains(import_error(directory_.write("endless.obj", endless_obj()), limits), "had not finished"));
  EXPECT_TRUE(import_mesh(directory_.write("good.off", tetrahedron::off()), long_timeout()));
  ::setitimer(ITIMER_REAL, &never, nullptr);
  ASSERT_EQ(::sigaction(SIGALRM, &before, nullptr), 0);
}

// Returns the state letter of /proc/<pid>/stat; nullopt if there is no such process.
std::optional<char> process_state(pid_t pid) {
  const std::string stat = read_file("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t name_end = stat.rfind(") ");
  if (name_end == std::string::npos) return std::nullopt;
  return stat[name_end + 2];
}

template <typename Condition>
bool wait_until(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

// Returns the importer that the given thread has started, once its set-up is complete; 0 on timeout.
pid_t importer_of(pid_t process, pid_t thread) {
  const std::string children =
      "/proc/" + std::to_string(process) + "/task/" + std::to_string(thread) + "/children";
  pid_t importer = 0;
  const bool started =
      wait_until([&] { return static_cast<bool>(std::ifstream(children) >> importer) && importer > 0; });
  const std::string score = "/proc/" + std::to_string(importer) + "/oom_score_adj";
  return started && wait_until([&] { return read_file(score) == "1000\n"; }) ? importer : 0;
}

TEST_F(ImportProcess, EndsImporterWhenProgramIsKilled) {
  const fs::path endless = directory_.write("endless.obj", endless_obj());
  const pid_t program = ::fork();
  ASSERT_GE(program, 0);
  if (program == 0) {
    (void)import_mesh(endless, long_timeout());
    ::_exit(0);
  }
  const pid_t importer = importer_of(program, program);
  ::kill(program, SIGKILL);
  ASSERT_EQ(::waitpid(program, nullptr, 0), program);
  ASSERT_GT(importer, 0);
  EXPECT_TRUE(wait_until([&] { return process_state(importer).value_or('Z') == 'Z'; }));
}

TEST_F(ImportProcess, ClosesInheritedDescriptors) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  std::promise<pid_t> thread;
  const fs::path endless = directory_.write("endless.obj", endless_obj());
  auto import = std::async(std::launch::async, [&] {
    thread.set_value(::gettid());
    return import_mesh(endless, long_timeout());
  });
  const pid_t importer = importer_of(::getpid(), thread.get_future().get());
  ::close(ends[1]);
  pollfd end{ends[0], POLLIN, 0};  // it ends when the other end is closed everywhere
  EXPECT_EQ(::poll(&end, 1, to_milliseconds(kWaitTimeout)), 1);
  ::close(ends[0]);
  ASSERT_GT(importer, 0);
  ::kill(importer, SIGKILL);
  const Expected<ImportedMesh> result = import.get();
  ASSERT_FALSE(result);
  EXPECT_TRUE(contains(result.error().message(), "was killed while reading the file (signal 9)"));
}

// Returns the value in a line "Name:<tab>value" of /proc/<pid>/status.
std::string status_of(pid_t pid, const std::string& name) {
  const std::string status = "\n" + read_file("/proc/" + std::to_string(pid) + "/status");
  const std::size_t start = status.find("\n" + name + ":\t");
  if (start == std::string::npos) return "";
  const std::size_t value = start + name.size() + 3;
  return status.substr(value, status.find('\n', value) - value);
}

TEST_F(ImportProcess, LeavesImporterNoRights) {
  std::promise<pid_t> thread;
  const fs::path endless = directory_.write("endless.obj", endless_obj());
  auto import = std::async(std::launch::async, [&] {
    thread.set_value(::gettid());
    return import_mesh(endless, long_timeout());
  });
  const pid_t importer = importer_of(::getpid(), thread.get_future().get());
  ASSERT_GT(importer, 0);
  EXPECT_TRUE(wait_until([&] { return status_of(importer, "Seccomp") == "2"; }));  // a filter
  EXPECT_EQ(status_of(importer, "NoNewPrivs"), "1");
  EXPECT_EQ(status_of(importer, "CapEff"), "0000000000000000");
  const std::string process = "/proc/" + std::to_string(importer);
  EXPECT_EQ(read_file(process + "/environ"), "");
  if (::geteuid() == 0) {
    EXPECT_EQ(status_of(importer, "Uid"), "65534\t65534\t65534\t65534");
    EXPECT_EQ(status_of(importer, "Gid"), "65534\t65534\t65534\t65534");
    EXPECT_EQ(status_of(importer, "Groups"), " ");
    for (const auto& descriptor : fs::directory_iterator(process + "/fd")) {
      const std::string file = fs::read_symlink(descriptor).string();
      EXPECT_TRUE(file == "/dev/null" || file == endless || file.starts_with("socket:")) << file;
    }
  }
  ::kill(importer, SIGKILL);
  EXPECT_FALSE(import.get());
}

}  // namespace
}  // namespace buoyancy
