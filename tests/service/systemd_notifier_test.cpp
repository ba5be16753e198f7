// The notifications of buoyancyd to its service manager, received on a socket like that of systemd.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "tests/service/leased_file.h"
#include "tests/service/running_service.h"
#include "tests/support/build_paths.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

class NotifySocket {
 public:
  NotifySocket() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path().c_str(), sizeof address.sun_path - 1);
    if (::bind(socket_.value(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("cannot bind the socket " + path());
    }
  }
  std::string path() const { return directory_.path("notify"); }

  // The next datagram; nullopt: none within `seconds`.
  std::optional<std::string> receive(double seconds) {
    pollfd waiting{socket_.value(), POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(seconds * 1e3)) != 1) return std::nullopt;
    std::array<char, 4096> text{};
    const ssize_t size = ::recv(socket_.value(), text.data(), text.size(), 0);
    return std::string(text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  }

  // The datagrams up to the one that starts with `text`, which is missing after kWaitTimeout.
  std::vector<std::string> receive_until(const std::string& text) {
    std::vector<std::string> received;
    const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
    while (std::chrono::steady_clock::now() < limit) {
      const std::optional<std::string> next = receive(kWaitTimeout);
      if (!next) break;
      received.push_back(*next);
      if (next->starts_with(text)) break;
    }
    return received;
  }

  bool has_received(const std::string& text) {
    const std::vector<std::string> received = receive_until(text);
    return !received.empty() && received.back().starts_with(text);
  }

 private:
  TempDir directory_;
  UniqueFd socket_;
};

class SystemdNotifierTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!BUOYANCY_EXPECT_SYSTEMD) {
      GTEST_SKIP() << "built without libsystemd; install libsystemd-dev and configure again";
    }
  }
  std::vector<std::string> environment(const std::string& watchdog_usec = "") const {
    std::vector<std::string> entries{"NOTIFY_SOCKET=" + systemd_.path()};
    if (!watchdog_usec.empty()) entries.push_back("WATCHDOG_USEC=" + watchdog_usec);
    return entries;
  }

  NotifySocket systemd_;
  RawLcmSocket socket_;
};

TEST_F(SystemdNotifierTest, ReportsReadyOnceRequestsAreHandled) {
  const RunningService service({}, kBoxScene, environment());
  ASSERT_TRUE(systemd_.has_received("READY=1"));
  send_request(socket_, one_body(1, 1, 0.0));
  EXPECT_EQ(receive(socket_).id.seq, 1);
  EXPECT_TRUE(systemd_.has_received("STATUS=2 bodies, 1 request answered"));
}

TEST_F(SystemdNotifierTest, ReportsReadyOnlyAfterSceneIsLoaded) {
  const TempDir directory;
  LeasedFile scene(directory.write("scene.toml", kBoxScene));
  if (!scene.held()) GTEST_SKIP() << no_lease_on(directory.path(""));
  ChildCommand command = command_of({built_program("buoyancyd"), "--scene", directory.path("scene.toml")});
  command.environment = environment();
  ChildProcess child(command);
  while (!scene.awaited()) ASSERT_FALSE(child.wait(0.002)) << child.standard_error();
  EXPECT_EQ(systemd_.receive(0.1), std::nullopt);
  scene.release();
  EXPECT_TRUE(systemd_.has_received("READY=1"));
}

TEST_F(SystemdNotifierTest, ReportsStartEndAndFailureOfReload) {
  RunningService service({}, kBoxScene, environment());
  ASSERT_TRUE(systemd_.has_received("READY=1"));
  service.child().send_signal(SIGHUP);
  const std::vector<std::string> begin = systemd_.receive_until("RELOADING=1");
  ASSERT_FALSE(begin.empty());
  long long microseconds = 0;
  ASSERT_EQ(std::sscanf(begin.back().c_str(), "RELOADING=1\nMONOTONIC_USEC=%lld", &microseconds), 1)
      << begin.back();
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  EXPECT_LE(microseconds, std::chrono::duration_cast<std::chrono::microseconds>(now).count());
  EXPECT_GT(microseconds, 0);
  EXPECT_TRUE(systemd_.has_received("READY=1"));

  service.write("scene.toml", "nothing");
  service.child().send_signal(SIGHUP);
  EXPECT_TRUE(systemd_.has_received("RELOADING=1"));
  EXPECT_TRUE(systemd_.has_received("READY=1"));
  EXPECT_TRUE(systemd_.has_received("STATUS=2 bodies, 0 requests answered; the last reload failed"));
}

TEST_F(SystemdNotifierTest, ReportsStoppingBeforeExit) {
  RunningService service({}, kBoxScene, environment());
  ASSERT_TRUE(systemd_.has_received("READY=1"));
  service.child().send_signal(SIGTERM);
  EXPECT_TRUE(systemd_.has_received("STOPPING=1"));
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0);
}

TEST_F(SystemdNotifierTest, PingsWatchdogOnlyWhileLoopRuns) {
  RunningService service({}, kBoxScene, environment("100000"));
  for (int ping = 0; ping < 5; ++ping) ASSERT_TRUE(systemd_.has_received("WATCHDOG=1"));
  service.stop();
  while (systemd_.receive(0.0)) {  // sent before the stop
  }
  EXPECT_EQ(systemd_.receive(0.5), std::nullopt) << "ten intervals";
  service.child().send_signal(SIGCONT);
  EXPECT_TRUE(systemd_.has_received("WATCHDOG=1"));
}

TEST_F(SystemdNotifierTest, PingsWatchdogDuringLoad) {
  RunningService service({}, kBoxScene, environment("100000"));
  LeasedFile scene(service.path("scene.toml"));
  if (!scene.held()) GTEST_SKIP() << no_lease_on(service.path(""));
  service.child().send_signal(SIGHUP);
  ASSERT_TRUE(systemd_.has_received("RELOADING=1"));
  for (int ping = 0; ping < 10; ++ping) {
    const std::vector<std::string> received = systemd_.receive_until("WATCHDOG=1");
    ASSERT_FALSE(received.empty());
    EXPECT_EQ(std::ranges::count(received, "READY=1"), 0);
  }
  scene.release();
  EXPECT_TRUE(systemd_.has_received("READY=1"));
}

TEST_F(SystemdNotifierTest, SendsNoPingWithoutWatchdog) {
  const RunningService service({}, kBoxScene, environment());
  const std::vector<std::string> received = systemd_.receive_until("STATUS=2 bodies, 0");
  ASSERT_TRUE(systemd_.has_received("READY=1"));
  std::optional<std::string> more = systemd_.receive(1.5);
  EXPECT_EQ(more, std::nullopt) << "no ping, and an unchanged status is not sent again";
}

TEST(Buoyancyd, HandlesRequestsAfterNotifySocketIsGone) {
  std::string gone;
  {
    const NotifySocket manager;
    gone = manager.path();
  }
  const RunningService service({}, kBoxScene, {"NOTIFY_SOCKET=" + gone, "WATCHDOG_USEC=100000"});
  RawLcmSocket socket;
  for (int status = 0; status < 3; ++status) ASSERT_TRUE(socket.receive("BUOYANCY_STATUS", kWaitTimeout));
  send_request(socket, one_body(1, 1, 0.0));
  EXPECT_EQ(receive(socket).id.seq, 1);
}

}  // namespace
}  // namespace buoyancy
