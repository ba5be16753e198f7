// Over real UDP multicast, in a network namespace of each test's own (see tests/CMakeLists.txt).
#include "transport/lcm_connection.h"

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/allocation_count.h"
#include "tests/support/timeouts.h"
#include "transport/adaptive_spin.h"
#include "transport/udpm_receiver.h"

namespace buoyancy {
namespace {

// While it lives, this thread's network is one with a loopback that is up, and no route.
class NetworkWithoutRoutes {
 public:
  NetworkWithoutRoutes() : outside_(::open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC)) {
    if (outside_ < 0 || ::unshare(CLONE_NEWNET) != 0) return;
    const int control = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ifreq loopback{};
    std::strcpy(loopback.ifr_name, "lo");
    loopback.ifr_flags = IFF_UP | IFF_RUNNING;
    entered_ = control >= 0 && ::ioctl(control, SIOCSIFFLAGS, &loopback) == 0;
    ::close(control);
  }
  NetworkWithoutRoutes(const NetworkWithoutRoutes&) = delete;
  NetworkWithoutRoutes& operator=(const NetworkWithoutRoutes&) = delete;
  ~NetworkWithoutRoutes() {
    ::setns(outside_, CLONE_NEWNET);
    ::close(outside_);
  }
  bool entered() const { return entered_; }

 private:
  int outside_;
  bool entered_ = false;
};

LcmConnection open_or_die(const std::string& url = "", const ConnectionOptions& options = {}) {
  Expected<LcmConnection> connection = LcmConnection::open(url, options);
  if (!connection) {
    ADD_FAILURE() << connection.error().message();
    std::abort();
  }
  return std::move(*connection);
}

bool becomes_readable(int descriptor, double seconds = kWaitTimeout) {
  pollfd waiting{descriptor, POLLIN, 0};
  return ::poll(&waiting, 1, to_milliseconds(seconds)) == 1;
}

// The next message, of which the kernel may deliver one fragment now and the next one later.
bool wait_and_handle(LcmConnection& connection) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (std::chrono::steady_clock::now() < limit && becomes_readable(connection.fileno())) {
    if (connection.handle_one()) return true;
  }
  return false;
}

// How many UDP packets this network namespace has sent; -1 where the kernel does not say.
std::int64_t packets_sent() {
  std::ifstream table("/proc/thread-self/net/snmp");
  std::string line;
  while (std::getline(table, line)) {
    long long sent = -1;
    // The line before this one holds the names: InDatagrams NoPorts InErrors OutDatagrams.
    if (std::sscanf(line.c_str(), "Udp: %*d %*d %*d %lld", &sent) == 1) return sent;
  }
  return -1;
}

std::vector<std::uint8_t> pattern(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 2654435761U >> 13U);
  return bytes;
}

TEST(UdpmReceiver, SendsNothing) {
  const std::int64_t before = packets_sent();
  ASSERT_GE(before, 0);
  const Expected<UdpmReceiver> onlooker = UdpmReceiver::open("");
  ASSERT_TRUE(onlooker) << onlooker.error().message();
  EXPECT_EQ(packets_sent(), before);
  open_or_die();
  EXPECT_GT(packets_sent(), before) << "a connection that means to send tries that first";
  EXPECT_TRUE(becomes_readable(onlooker->fileno()));
}

TEST(UdpmReceiver, SaysThatThereIsNoRoute) {
  const NetworkWithoutRoutes network;
  ASSERT_TRUE(network.entered());
  const Expected<UdpmReceiver> refused = UdpmReceiver::open("");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("no multicast route"), std::string::npos)
      << refused.error().message();
}

TEST(LcmConnection, SendsWhereTheUrlNamesNoPort) {
  LcmConnection sender = open_or_die("udpm://239.255.76.67");
  LcmConnection receiver = open_or_die("udpm://:7667");
  bool heard = false;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes, std::string_view) { heard = true; }));
  const Expected<void> published = sender.publish("A", pattern(10));
  ASSERT_TRUE(published) << published.error().message();
  EXPECT_TRUE(wait_and_handle(receiver));
  EXPECT_TRUE(heard);
}

TEST(LcmConnection, CarriesBytesUnchangedWhateverTheirLength) {
  LcmConnection sender = open_or_die();
  LcmConnection receiver = open_or_die();
  std::vector<std::uint8_t> received;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes bytes, std::string_view channel) {
    EXPECT_EQ(channel, "A");
    received.assign(bytes.begin(), bytes.end());
  }));
  for (const std::size_t size : {0U, 1U, 1'000U, 65'000U, 65'499U, 65'500U, 1'000'000U}) {
    const auto sent = pattern(size);
    ASSERT_TRUE(sender.publish("A", sent)) << size;
    ASSERT_TRUE(wait_and_handle(receiver)) << size;
    EXPECT_EQ(received, sent) << size;
  }
}

TEST(LcmConnection, DeliversEveryMessageOfABurstInOrder) {
  LcmConnection sender = open_or_die();
  LcmConnection receiver = open_or_die();
  std::vector<int> received;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes bytes, std::string_view) { received.push_back(bytes[0]); }));
  std::vector<int> sent;
  for (int i = 0; i < 200; ++i) {
    const std::uint8_t byte = static_cast<std::uint8_t>(i);
    ASSERT_TRUE(sender.publish("A", {&byte, 1}));
    sent.push_back(i);
  }
  while (received.size() < sent.size() && wait_and_handle(receiver)) {
  }
  EXPECT_EQ(received, sent);
  EXPECT_FALSE(receiver.handle_one()) << "nothing is left";
}

TEST(LcmConnection, TakesNothingFromTheHeapForAMessageNoLargerThanTheLargestYet) {
  LcmConnection connection = open_or_die();
  int received = 0;
  ASSERT_TRUE(connection.subscribe("A", [&](Bytes, std::string_view) { ++received; }));
  const std::string channel = "A";
  const auto in_one_packet = pattern(100);
  const auto in_fragments = pattern(200'000);
  const auto round_trip = [&](Bytes sent) {
    return connection.publish(channel, sent) && wait_and_handle(connection);
  };
  ASSERT_TRUE(round_trip(in_fragments));
  const AllocationCount allocations;
  constexpr int kEach = 20;
  int done = 0;
  for (int i = 0; i < kEach; ++i)
    done += (round_trip(in_one_packet) ? 1 : 0) + (round_trip(in_fragments) ? 1 : 0);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(done, 2 * kEach);
}

TEST(LcmConnection, FindsAMessageThatComesSoonWithoutSleeping) {
  LcmConnection sender = open_or_die();
  LcmConnection receiver = open_or_die();
  int received = 0;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes, std::string_view) { ++received; }));
  EXPECT_FALSE(receiver.handle_one_spinning()) << "nothing was sent";
  const std::uint8_t byte = 7;
  ASSERT_TRUE(sender.publish("A", {&byte, 1}));
  // On a busy machine the kernel delivers later than the receiver looks for a message.
  ASSERT_TRUE(becomes_readable(receiver.fileno()));
  EXPECT_TRUE(receiver.handle_one_spinning());
  EXPECT_EQ(received, 1);
}

TEST(LcmConnection, SleepsAtOnceWhereItMustNotSpin) {
  const auto looks_for = [](LcmConnection connection) {
    EXPECT_TRUE(connection.subscribe("A", [](Bytes, std::string_view) {}));
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(connection.handle_one_spinning());
    return std::chrono::steady_clock::now() - start;
  };
  EXPECT_GE(looks_for(open_or_die()), AdaptiveSpin::kProbeTime);
  const auto give_up_at = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  bool slept_at_once = false;
  while (!slept_at_once && std::chrono::steady_clock::now() < give_up_at) {
    slept_at_once = looks_for(open_or_die("", {.spin = false})) < AdaptiveSpin::kProbeTime;
  }
  EXPECT_TRUE(slept_at_once);
}

TEST(LcmConnection, LosesNothingToItsOwnMessages) {
  const char* const small_buffer = "udpm://239.255.76.67:7667?recv_buf_size=106496";
  LcmConnection connection = open_or_die(small_buffer, {.receive_own = false});
  LcmConnection other = open_or_die();
  int of_own = 0;
  std::size_t of_other = 0;
  ASSERT_TRUE(connection.subscribe("OWN", [&](Bytes, std::string_view) { ++of_own; }));
  ASSERT_TRUE(
      connection.subscribe("OTHER", [&](Bytes bytes, std::string_view) { of_other += bytes.size(); }));
  bool other_received = false;
  ASSERT_TRUE(other.subscribe("OWN", [&](Bytes, std::string_view) { other_received = true; }));

  const auto own = pattern(3'000'000);
  ASSERT_TRUE(connection.publish("OWN", {own.data(), 1}));
  ASSERT_TRUE(connection.publish("OWN", own));
  const auto foreign = pattern(30'000);
  ASSERT_TRUE(other.publish("OTHER", foreign));
  while (of_other == 0 && wait_and_handle(connection)) {
  }
  EXPECT_EQ(of_other, foreign.size()) << "there was room for it";
  EXPECT_EQ(of_own, 0);
  EXPECT_EQ(connection.drop_counts().packets, 0);
  EXPECT_TRUE(wait_and_handle(other));
  EXPECT_TRUE(other_received);
}

TEST(LcmConnection, CountsWhatTheKernelHadNoRoomFor) {
  LcmConnection sender = open_or_die();
  LcmConnection receiver = open_or_die("udpm://239.255.76.67:7667?recv_buf_size=20000");
  std::int64_t received = 0;
  std::int64_t newest = -1;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes bytes, std::string_view) {
    ++received;
    std::memcpy(&newest, bytes.data(), sizeof newest);
  }));
  std::int64_t sent = 0;
  const auto send_next = [&] {
    std::vector<std::uint8_t> bytes(100);
    std::memcpy(bytes.data(), &sent, sizeof sent);
    ++sent;
    return sender.publish("A", bytes).has_value();
  };
  constexpr std::int64_t kBurst = 500;
  while (sent < kBurst) ASSERT_TRUE(send_next());
  const auto drain = [&receiver] {
    while (becomes_readable(receiver.fileno(), 0.01)) receiver.handle_one();
  };
  drain();
  EXPECT_LT(received, kBurst);
  EXPECT_GT(received, 0);
  // The kernel says what it dropped with the next packet that it has room for.
  const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  do {
    ASSERT_TRUE(send_next());
    drain();
  } while (newest != sent - 1 && std::chrono::steady_clock::now() < limit);
  ASSERT_EQ(newest, sent - 1);
  EXPECT_EQ(received + receiver.drop_counts().packets, sent);
}

TEST(LcmConnection, HearsNothingThatWasSentToThePortByAnotherAddress) {
  LcmConnection receiver = open_or_die();
  ASSERT_TRUE(receiver.subscribe("A", [](Bytes, std::string_view) { ADD_FAILURE(); }));
  bool later = false;
  ASSERT_TRUE(receiver.subscribe("LATER", [&](Bytes, std::string_view) { later = true; }));
  LcmConnection neighbour = open_or_die("udpm://239.255.76.68:7667");
  bool heard = false;
  ASSERT_TRUE(neighbour.subscribe("A", [&](Bytes, std::string_view) { heard = true; }));
  const std::uint8_t byte = 7;
  ASSERT_TRUE(neighbour.publish("A", {&byte, 1}));
  ASSERT_TRUE(wait_and_handle(neighbour));
  EXPECT_TRUE(heard);
  // Packets arrive in order: one to the other address would come before this one.
  ASSERT_TRUE(receiver.publish("LATER", {&byte, 1}));
  ASSERT_TRUE(wait_and_handle(receiver));
  EXPECT_TRUE(later);
}

TEST(LcmConnection, SubscribesToAChannelOnce) {
  LcmConnection connection = open_or_die();
  const auto ignore = [](Bytes, std::string_view) {};
  EXPECT_TRUE(connection.subscribe("A", ignore));
  EXPECT_FALSE(connection.subscribe("A", ignore));
}

TEST(LcmConnection, TakesChannelNamesLiterally) {
  LcmConnection connection = open_or_die();
  const std::string name = R"(A.*(b|c)[d]^$+?{1}\-)";
  int matching = 0;
  ASSERT_TRUE(connection.subscribe(name, [&](Bytes, std::string_view channel) {
    EXPECT_EQ(channel, name);
    ++matching;
  }));
  int dotted = 0;
  ASSERT_TRUE(connection.subscribe("A.B", [&](Bytes, std::string_view) { ++dotted; }));
  int last = 0;
  ASSERT_TRUE(connection.subscribe("LAST", [&](Bytes, std::string_view) { ++last; }));
  const std::uint8_t byte = 7;
  for (const std::string& channel : {std::string("AxB"), std::string("Axb"), name, std::string("LAST")}) {
    ASSERT_TRUE(connection.publish(channel, {&byte, 1}));
  }
  while (last == 0 && wait_and_handle(connection)) {
  }
  EXPECT_EQ(last, 1);
  EXPECT_EQ(matching, 1);
  EXPECT_EQ(dotted, 0);
}

TEST(LcmConnection, RefusesChannelNamesThatLcmCannotCarry) {
  LcmConnection connection = open_or_die("memq://");
  const auto ignore = [](Bytes, std::string_view) {};
  const std::uint8_t byte = 7;
  for (const std::string& name : {std::string(), std::string(64, 'a')}) {
    EXPECT_FALSE(connection.subscribe(name, ignore));
    EXPECT_FALSE(connection.publish(name, {&byte, 1}));
  }
  EXPECT_TRUE(connection.subscribe(std::string(63, 'a'), ignore));
  EXPECT_TRUE(connection.publish(std::string(63, 'a'), {&byte, 1}));
}

TEST(LcmConnection, WorksWithinOneProcessWithoutANetwork) {
  LcmConnection connection = open_or_die("memq://");
  int received = 0;
  ASSERT_TRUE(connection.subscribe("A", [&](Bytes bytes, std::string_view) { received = bytes[0]; }));
  const std::uint8_t byte = 7;
  ASSERT_TRUE(connection.publish("A", {&byte, 1}));
  ASSERT_TRUE(wait_and_handle(connection));
  EXPECT_EQ(received, 7);
}

TEST(LcmConnection, KeepsItsHandlersWhenMoved) {
  LcmConnection first = open_or_die("memq://");
  int received = 0;
  ASSERT_TRUE(first.subscribe("A", [&](Bytes, std::string_view) { ++received; }));
  LcmConnection second = std::move(first);
  const std::uint8_t byte = 7;
  ASSERT_TRUE(second.publish("A", {&byte, 1}));
  ASSERT_TRUE(wait_and_handle(second));
  EXPECT_EQ(received, 1);
}

TEST(LcmConnection, NamesTheCommandThatMendsAMissingMulticastRoute) {
  const NetworkWithoutRoutes network;
  if (!network.entered()) GTEST_SKIP() << "this machine permits no network namespace";
  const Expected<LcmConnection> connection = LcmConnection::open("");
  ASSERT_FALSE(connection);
  const std::string message = connection.error().message();
  EXPECT_NE(message.find("239.255.76.67:7667"), std::string::npos) << message;
  EXPECT_NE(message.find("ip route add 224.0.0.0/4 dev lo"), std::string::npos) << message;
}

TEST(LcmConnection, RefusesUrlsItDoesNotKnow) {
  for (const char* url : {"nonsense", "tcpq://127.0.0.1:7700", "udpm://1.2.3.4:5"}) {
    const Expected<LcmConnection> connection = LcmConnection::open(url);
    ASSERT_FALSE(connection) << url;
    EXPECT_NE(connection.error().message().find(url), std::string::npos) << connection.error().message();
  }
}

TEST(LcmConnection, TakesItsUrlFromTheEnvironmentAsLcmsOwnToolsDo) {
  // NOLINTBEGIN(concurrency-mt-unsafe): no other thread lives yet, or lives any more
  ASSERT_EQ(::setenv("LCM_DEFAULT_URL", "memq://", 1), 0);
  EXPECT_EQ(resolve_lcm_url(""), "memq://");
  EXPECT_EQ(open_or_die("").url(), "memq://");
  EXPECT_EQ(resolve_lcm_url("udpm://:7700"), "udpm://:7700") << "an explicit URL wins";
  ASSERT_EQ(::unsetenv("LCM_DEFAULT_URL"), 0);
  // NOLINTEND(concurrency-mt-unsafe)
  EXPECT_EQ(resolve_lcm_url(""), "udpm://239.255.76.67:7667?ttl=0");
}

}  // namespace
}  // namespace buoyancy
