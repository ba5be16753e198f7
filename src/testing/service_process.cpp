#include "testing/service_process.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <future>
#include <random>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/format.h"
#include "base/unique_fd.h"
#include "testing/private_network.h"

namespace buoyancy::testing {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kStopTimeout = 10.0;  // [s]
constexpr std::chrono::milliseconds kPollInterval{2};

std::string message_of(int code) {
  return std::generic_category().message(code);
}

// A port that no other test has. The lock is an abstract socket, which the kernel removes with its owner, and
// which is per network namespace like the port itself.
struct Port {
  int number = 0;
  UniqueFd lock;
};

bool is_free(int number) {
  const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(number));
  sockaddr generic{};
  std::memcpy(&generic, &address, sizeof generic);
  return bind(socket.value(), &generic, sizeof generic) == 0;
}

UniqueFd lock(int number) {
  UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "buoyancy-testing-" + std::to_string(number);
  std::memcpy(address.sun_path + 1, name.data(), name.size());  // a leading zero makes it abstract
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  sockaddr_storage generic{};
  std::memcpy(&generic, &address, sizeof address);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): as the sockets API requires
  const bool owned = bind(socket.value(), reinterpret_cast<const sockaddr*>(&generic), size) == 0;
  return owned ? std::move(socket) : UniqueFd();
}

Expected<Port> take_port() {
  constexpr int kFirst = 20'000;  // below the ports that the kernel gives to senders
  constexpr int kCount = 10'000;
  std::random_device random;
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const int number = kFirst + static_cast<int>(random() % kCount);
    Port port{number, lock(number)};
    if (port.lock.valid() && is_free(number)) return port;
  }
  return make_error(
      {"a port for buoyancyd", "1,000 ports are in use", "a free one from 20000 to 29999", "", ""});
}

std::filesystem::path program_of(const ServiceOptions& options) {
  if (!options.program.empty()) return options.program;
  const char* const given = std::getenv("BUOYANCYD");  // NOLINT(concurrency-mt-unsafe)
  return given == nullptr || *given == '\0' ? "buoyancyd" : given;
}

std::string contents(int fd) {
  std::string text;
  std::array<char, 65536> buffer{};
  while (true) {
    const ssize_t n = pread(fd, buffer.data(), buffer.size(), static_cast<off_t>(text.size()));
    if (n <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

// Runs in the child of fork(): no memory may be allocated between fork and exec.
[[noreturn]] void execute(char* const* arguments, int log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  const int input = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (input >= 0 && dup2(input, STDIN_FILENO) >= 0 && dup2(log, STDOUT_FILENO) >= 0 &&
      dup2(log, STDERR_FILENO) >= 0) {
    execvp(arguments[0], arguments);
  }
  dprintf(STDERR_FILENO, "%s: %s\n", arguments[0], std::strerror(errno));  // NOLINT(concurrency-mt-unsafe)
  _exit(127);
}

}  // namespace

struct ServiceProcess::Impl {
  Port port;
  std::string lcm_url;
  std::filesystem::path folder;  // of scene_text; empty: there is none
  UniqueFd log;
  pid_t pid = -1;
  std::thread parent;           // starts the service, and waits for its end
  std::atomic<int> status{-1};  // of wait(2), once the service has ended; -1: it runs
  std::optional<int> exit_code;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    stop();
    if (parent.joinable()) parent.join();
    std::error_code ignored;
    if (!folder.empty()) std::filesystem::remove_all(folder, ignored);
  }

  Expected<void> write_scene(const std::string& text) {
    std::string path = (std::filesystem::temp_directory_path() / "buoyancy-testing-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr) {
      return make_error({path, message_of(errno), "a folder that can be made", "", ""});
    }
    folder = path;
    std::ofstream file(folder / "scene.toml");
    file << text << std::flush;
    if (!file) return make_error({folder.string(), "scene.toml cannot be written", "space for it", "", ""});
    return {};
  }

  // Starts a program. The kernel ends it when the thread that forked it ends. That is therefore a thread of
  // its own, which outlives the program even if the calling thread ends. Returns 0 or an error of fork().
  int start(char* const* arguments) {
    std::promise<int> started;
    std::future<int> result = started.get_future();
    parent = std::thread([this, arguments, started = std::move(started)]() mutable {
      const pid_t test = getpid();
      const pid_t child = fork();
      if (child == 0) execute(arguments, log.value(), test);
      pid = child;
      started.set_value(child < 0 ? errno : 0);
      int ended = 0;
      while (child > 0 && waitpid(child, &ended, 0) < 0 && errno == EINTR) {
      }
      if (child > 0) status = ended;
    });
    return result.get();
  }

  bool has_ended() {
    const int ended = status;
    if (!exit_code && ended != -1) exit_code = WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended);
    return exit_code.has_value();
  }

  // Waits until condition() holds; false: not within `seconds`.
  template <typename Condition>
  bool wait(double seconds, const Condition& condition) {
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    while (!condition()) {
      if (Clock::now() >= end) return false;
      std::this_thread::sleep_for(kPollInterval);
    }
    return true;
  }

  bool wait_for_log(const std::string& text, double seconds) {
    bool found = false;
    wait(seconds, [&] {
      const bool ended = has_ended();  // checked first: after the end the log is complete
      found = contents(log.value()).find(text) != std::string::npos;
      return found || ended;
    });
    return found;
  }

  int stop() {
    if (pid < 0) return 0;
    if (!has_ended()) kill(pid, SIGTERM);
    if (!wait(kStopTimeout, [this] { return has_ended(); })) {
      kill(pid, SIGKILL);
      wait(kStopTimeout, [this] { return has_ended(); });
    }
    return exit_code.value_or(128 + SIGKILL);
  }
};

ServiceProcess::ServiceProcess(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ServiceProcess::ServiceProcess(ServiceProcess&&) noexcept = default;
ServiceProcess& ServiceProcess::operator=(ServiceProcess&&) noexcept = default;
ServiceProcess::~ServiceProcess() = default;

Expected<ServiceProcess> ServiceProcess::start(const ServiceOptions& options) {
  if (options.scene.empty() == options.scene_text.empty()) {
    return make_error({"buoyancyd for a test",
                       options.scene.empty() ? "no scene" : "a scene file and a scene's text",
                       "one of scene and scene_text", "", ""});
  }
  if (const Expected<void> ready = ensure_multicast(); !ready) return make_error(ready.error());
  Expected<Port> port = take_port();
  if (!port) return make_error(port.error());

  auto impl = std::make_unique<Impl>();
  impl->port = *std::move(port);
  impl->lcm_url = "udpm://239.255.76.67:" + std::to_string(impl->port.number) + "?ttl=0";
  impl->log = UniqueFd(memfd_create("buoyancyd's log", MFD_CLOEXEC));
  std::filesystem::path scene = options.scene;
  if (!options.scene_text.empty()) {
    if (const Expected<void> written = impl->write_scene(options.scene_text); !written) {
      return make_error(written.error());
    }
    scene = impl->folder / "scene.toml";
  }

  std::vector<std::string> arguments{program_of(options).string(), "--scene", scene.string(), "--lcm-url",
                                     impl->lcm_url};
  arguments.insert(arguments.end(), options.arguments.begin(), options.arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  if (const int failed = impl->start(pointers.data()); failed != 0) {
    return make_error({arguments[0], message_of(failed), "a process", "", ""});
  }

  if (impl->wait_for_log("ready:", options.ready_timeout)) return ServiceProcess(std::move(impl));
  const bool ended = impl->has_ended();
  const int exit_code = impl->stop();
  std::string actual = ended ? "exit code " + std::to_string(exit_code)
                             : "not ready after " + format_shortest(options.ready_timeout) + " s";
  return make_error(
      {arguments[0], std::move(actual), "a service that is ready",
       exit_code == 127 ? "the program is not in $PATH; install the package buoyancy, or set $BUOYANCYD" : "",
       "Its log:\n" + contents(impl->log.value())});
}

const std::string& ServiceProcess::lcm_url() const {
  return impl_->lcm_url;
}

int ServiceProcess::pid() const {
  return impl_->pid;
}

std::string ServiceProcess::log() const {
  return contents(impl_->log.value());
}

bool ServiceProcess::is_running() {
  return !impl_->has_ended();
}

bool ServiceProcess::wait_for_log(const std::string& text, double seconds) {
  return impl_->wait_for_log(text, seconds);
}

int ServiceProcess::stop() {
  return impl_->stop();
}

}  // namespace buoyancy::testing
