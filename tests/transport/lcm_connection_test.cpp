// Runs over real UDP multicast; every test has its own network namespace (see tests/CMakeLists.txt).
#include "transport/lcm_connection.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
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

using testing::AllOf;
using testing::HasSubstr;

// While it lives, this thread is in a network namespace whose loopback is up and which has no routes.
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

LcmConnection open_or_abort(const std::string& url = "", const ConnectionOptions& options = {}) {
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

// Handles the next message, whose fragments the kernel may deliver at different times.
bool wait_and_handle(LcmConnection& connection) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (std::chrono::steady_clock::now() < deadline && becomes_readable(connection.fileno())) {
    if (connection.handle_one()) return true;
  }
  return false;
}

// Returns how many UDP packets this network namespace has sent; -1 if the kernel does not report it.
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

const std::vector<std::uint8_t> kByte{7};

std::vector<std::uint8_t> pattern(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 2654435761U >> 13U);
  return bytes;
}

TEST(UdpmReceiver, SendsNothing) {
  const std::int64_t before = packets_sent();
  ASSERT_GE(before, 0);
  const Expected<UdpmReceiver> receiver = UdpmReceiver::open("");
  ASSERT_TRUE(receiver) << receiver.error().message();
  EXPECT_EQ(packets_sent(), before);
  open_or_abort();
  EXPECT_GT(packets_sent(), before) << "a connection that can send probes the network first";
  EXPECT_TRUE(becomes_readable(receiver->fileno()));
}

TEST(LcmConnection, SendsIfUrlHasNoPort) {
  LcmConnection sender = open_or_abort("udpm://239.255.76.67");
  LcmConnection receiver = open_or_abort("udpm://:7667");
  bool received = false;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes, std::string_view) { received = true; }));
  const Expected<void> published = sender.publish("A", pattern(10));
  ASSERT_TRUE(published) << published.error().message();
  EXPECT_TRUE(wait_and_handle(receiver));
  EXPECT_TRUE(received);
}

TEST(LcmConnection, TransmitsMessagesOfAnyLengthUnchanged) {
  LcmConnection sender = open_or_abort();
  LcmConnection receiver = open_or_abort();
  std::vector<std::uint8_t> received;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes bytes, std::string_view channel) {
    EXPECT_EQ(channel, "A");
    received.assign(bytes.begin(), bytes.end());
  }));
  // Users other than root may get a smaller receive buffer than they ask for.
  const std::size_t largest =
      std::min<std::size_t>(receiver.reserve_receive_buffer(0)->max_message, 1'000'000);
  for (const std::size_t size : {0UL, 1UL, 1'000UL, 65'000UL, 65'499UL, 65'500UL, largest}) {
    const auto sent = pattern(size);
    ASSERT_TRUE(sender.publish("A", sent)) << size;
    ASSERT_TRUE(wait_and_handle(receiver)) << size;
    EXPECT_EQ(received, sent) << size;
  }
}

TEST(LcmConnection, SendsAsManyPacketsAsCounted) {
  LcmConnection sender = open_or_abort();
  for (const std::string& channel : {std::string("A"), std::string(63, 'x')}) {
    const std::size_t name = channel.size() + 1;
    for (const std::size_t size : {std::size_t{0}, 65'499 - name, 65'500 - name, 2 * 65'487 - name,
                                   2 * 65'487 + 1 - name, std::size_t{1'000'000}}) {
      const std::int64_t before = packets_sent();
      ASSERT_TRUE(sender.publish(channel, pattern(size)));
      EXPECT_EQ(packets_sent() - before, static_cast<std::int64_t>(packet_count(size, channel))) << size;
    }
  }
}

TEST(LcmConnection, KeepsMessageThatFillsReceiveBufferUntilItIsRead) {
  LcmConnection sender = open_or_abort();
  LcmConnection receiver = open_or_abort();
  std::size_t received = 0;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes bytes, std::string_view) { received = bytes.size(); }));
  const std::optional<ReceiveBuffer> buffer = receiver.reserve_receive_buffer(11'000'000);
  ASSERT_TRUE(buffer);
  EXPECT_FALSE(buffer->fixed_by_url);
  // Users other than root may get less than they ask for; the promise holds for what they get.
  const auto sent = pattern(std::min<std::size_t>(buffer->max_message, kMaxMessageBytes));
  ASSERT_TRUE(sender.publish("A", sent));
  ASSERT_TRUE(wait_and_handle(receiver));
  EXPECT_EQ(received, sent.size());
  EXPECT_EQ(receiver.drop_counts().packets, 0);
  EXPECT_EQ(receiver.reserve_receive_buffer(1)->max_message, buffer->max_message) << "it never shrinks";
}

TEST(LcmConnection, WarnsBeforeAndCountsAfterReceiveBufferOverflow) {
  LcmConnection sender = open_or_abort();
  LcmConnection receiver = open_or_abort("udpm://239.255.76.67:7667?recv_buf_size=100000");
  std::size_t received = 0;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes bytes, std::string_view) { received = bytes.size(); }));
  const auto large = pattern(1'000'000);
  const std::optional<ReceiveBuffer> buffer = receiver.reserve_receive_buffer(large.size());
  ASSERT_TRUE(buffer);
  EXPECT_TRUE(buffer->fixed_by_url);
  EXPECT_EQ(buffer->requested, 100'000U) << "the size in the URL is kept";
  EXPECT_EQ(buffer->max_message, 100'000U);
  EXPECT_TRUE(receive_buffer_warning("message", large.size(), "A", *buffer));

  ASSERT_TRUE(sender.publish("A", large));
  while (receiver.handle_one() || becomes_readable(receiver.fileno(), 0.01)) {
  }
  EXPECT_EQ(received, 0U);
  // The kernel reports what it dropped with the next packet.
  ASSERT_TRUE(sender.publish("A", pattern(10)));
  ASSERT_TRUE(wait_and_handle(receiver));
  EXPECT_EQ(received, 10U);
  const auto lost = receiver.drop_counts().packets;
  EXPECT_GT(lost, 0);
  EXPECT_LT(lost, static_cast<std::int64_t>(packet_count(large.size(), "A")));
}

TEST(LcmConnection, RefusesToSendWhatReceiversDrop) {
  LcmConnection connection = open_or_abort();
  const std::vector<std::uint8_t> largest(kMaxMessageBytes);
  const std::vector<std::uint8_t> larger(kMaxMessageBytes + 1);
  EXPECT_TRUE(connection.publish("A", largest));
  const std::int64_t before = packets_sent();
  const Expected<void> refused = connection.publish("A", larger);
  EXPECT_EQ(packets_sent(), before);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("16777217 bytes"));
  LcmConnection in_process = open_or_abort("memq://");
  EXPECT_TRUE(in_process.publish("A", larger)) << "no packets, no limit";
  EXPECT_FALSE(in_process.is_network());
  EXPECT_FALSE(in_process.reserve_receive_buffer(larger.size()));
}

TEST(LcmConnection, DeliversEveryMessageOfABurstInOrder) {
  LcmConnection sender = open_or_abort();
  LcmConnection receiver = open_or_abort();
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

TEST(LcmConnection, DoesNotAllocateForMessagesNoLargerThanEarlierOnes) {
  LcmConnection connection = open_or_abort();
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

TEST(LcmConnection, HandlesQuickMessageWithoutBlocking) {
  LcmConnection sender = open_or_abort();
  LcmConnection receiver = open_or_abort();
  int received = 0;
  ASSERT_TRUE(receiver.subscribe("A", [&](Bytes, std::string_view) { ++received; }));
  EXPECT_FALSE(receiver.handle_one_spinning()) << "nothing was sent";
  ASSERT_TRUE(sender.publish("A", kByte));
  // On a busy machine the kernel may deliver the message after the spin has ended.
  ASSERT_TRUE(becomes_readable(receiver.fileno()));
  EXPECT_TRUE(receiver.handle_one_spinning());
  EXPECT_EQ(received, 1);
}

TEST(LcmConnection, DoesNotSpinIfDisabled) {
  const auto spin_time = [](LcmConnection connection) {
    EXPECT_TRUE(connection.subscribe("A", [](Bytes, std::string_view) {}));
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(connection.handle_one_spinning());
    return std::chrono::steady_clock::now() - start;
  };
  EXPECT_GE(spin_time(open_or_abort()), AdaptiveSpin::kProbeTime);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  bool returned_at_once = false;
  while (!returned_at_once && std::chrono::steady_clock::now() < deadline) {
    returned_at_once = spin_time(open_or_abort("", {.spin = false})) < AdaptiveSpin::kProbeTime;
  }
  EXPECT_TRUE(returned_at_once);
}

TEST(LcmConnection, KeepsReceiveBufferFreeOfOwnMessages) {
  const char* const small_buffer = "udpm://239.255.76.67:7667?recv_buf_size=106496";
  LcmConnection connection = open_or_abort(small_buffer, {.receive_own = false});
  LcmConnection other = open_or_abort();
  int own_messages = 0;
  std::size_t other_bytes = 0;
  ASSERT_TRUE(connection.subscribe("OWN", [&](Bytes, std::string_view) { ++own_messages; }));
  ASSERT_TRUE(
      connection.subscribe("OTHER", [&](Bytes bytes, std::string_view) { other_bytes += bytes.size(); }));
  bool other_received = false;
  ASSERT_TRUE(other.subscribe("OWN", [&](Bytes, std::string_view) { other_received = true; }));

  const auto own = pattern(3'000'000);
  ASSERT_TRUE(connection.publish("OWN", {own.data(), 1}));
  ASSERT_TRUE(connection.publish("OWN", own));
  const auto foreign = pattern(30'000);
  ASSERT_TRUE(other.publish("OTHER", foreign));
  while (other_bytes == 0 && wait_and_handle(connection)) {
  }
  EXPECT_EQ(other_bytes, foreign.size()) << "the receive buffer had no space for it";
  EXPECT_EQ(own_messages, 0);
  EXPECT_EQ(connection.drop_counts().packets, 0);
  EXPECT_TRUE(wait_and_handle(other));
  EXPECT_TRUE(other_received);
}

TEST(LcmConnection, CountsPacketsDroppedByKernel) {
  LcmConnection sender = open_or_abort();
  LcmConnection receiver = open_or_abort("udpm://239.255.76.67:7667?recv_buf_size=20000");
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
  // The kernel reports drops with the next packet that it has space for.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  do {
    ASSERT_TRUE(send_next());
    drain();
  } while (newest != sent - 1 && std::chrono::steady_clock::now() < deadline);
  ASSERT_EQ(newest, sent - 1);
  EXPECT_EQ(received + receiver.drop_counts().packets, sent);
}

TEST(LcmConnection, IgnoresPacketsToSamePortAtAnotherAddress) {
  LcmConnection receiver = open_or_abort();
  ASSERT_TRUE(receiver.subscribe("A", [](Bytes, std::string_view) { ADD_FAILURE(); }));
  bool later = false;
  ASSERT_TRUE(receiver.subscribe("LATER", [&](Bytes, std::string_view) { later = true; }));
  LcmConnection neighbour = open_or_abort("udpm://239.255.76.68:7667");
  bool received = false;
  ASSERT_TRUE(neighbour.subscribe("A", [&](Bytes, std::string_view) { received = true; }));
  ASSERT_TRUE(neighbour.publish("A", kByte));
  ASSERT_TRUE(wait_and_handle(neighbour));
  EXPECT_TRUE(received);
  // Packets arrive in order: one to the other address would precede this one.
  ASSERT_TRUE(receiver.publish("LATER", kByte));
  ASSERT_TRUE(wait_and_handle(receiver));
  EXPECT_TRUE(later);
}

TEST(LcmConnection, TreatsChannelNamesLiterally) {
  LcmConnection connection = open_or_abort();
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
  for (const std::string& channel : {std::string("AxB"), std::string("Axb"), name, std::string("LAST")}) {
    ASSERT_TRUE(connection.publish(channel, kByte));
  }
  while (last == 0 && wait_and_handle(connection)) {
  }
  EXPECT_EQ(last, 1);
  EXPECT_EQ(matching, 1);
  EXPECT_EQ(dotted, 0);
}

TEST(LcmConnection, RejectsInvalidAndRepeatedChannelNames) {
  LcmConnection connection = open_or_abort();
  const auto ignore = [](Bytes, std::string_view) {};
  for (const std::string& name : {std::string(), std::string(64, 'a')}) {
    EXPECT_FALSE(connection.subscribe(name, ignore));
    EXPECT_FALSE(connection.publish(name, kByte));
  }
  EXPECT_TRUE(connection.subscribe(std::string(63, 'a'), ignore));
  EXPECT_FALSE(connection.subscribe(std::string(63, 'a'), ignore));
  EXPECT_TRUE(connection.publish(std::string(63, 'a'), kByte));
}

TEST(LcmConnection, DeliversWithinProcessWithMemqAndWhenMoved) {
  LcmConnection first = open_or_abort("memq://");
  int received = 0;
  ASSERT_TRUE(first.subscribe("A", [&](Bytes bytes, std::string_view) { received += bytes[0]; }));
  ASSERT_TRUE(first.publish("A", kByte));
  ASSERT_TRUE(wait_and_handle(first));
  EXPECT_EQ(received, 7);
  LcmConnection second = std::move(first);
  ASSERT_TRUE(second.publish("A", kByte));
  ASSERT_TRUE(wait_and_handle(second));
  EXPECT_EQ(received, 14);
}

TEST(LcmConnection, NamesCommandThatAddsMissingMulticastRoute) {
  const NetworkWithoutRoutes network;
  if (!network.entered()) {
    GTEST_SKIP() << "no permission to create a network namespace; run the test with ctest or with "
                    "scripts/in_network_namespace";
  }
  const Expected<LcmConnection> connection = LcmConnection::open("");
  ASSERT_FALSE(connection);
  EXPECT_THAT(connection.error().message(),
              AllOf(HasSubstr("239.255.76.67:7667"), HasSubstr("ip route add 224.0.0.0/4 dev lo")));
  const Expected<UdpmReceiver> receiver = UdpmReceiver::open("");
  ASSERT_FALSE(receiver);
  EXPECT_THAT(receiver.error().message(), HasSubstr("no multicast route"));
}

TEST(LcmConnection, RejectsUnsupportedUrls) {
  for (const char* url : {"nonsense", "tcpq://127.0.0.1:7700", "udpm://1.2.3.4:5"}) {
    const Expected<LcmConnection> connection = LcmConnection::open(url);
    ASSERT_FALSE(connection) << url;
    EXPECT_THAT(connection.error().message(), HasSubstr(url));
  }
}

TEST(LcmConnection, ReadsDefaultUrlFromEnvironment) {
  // NOLINTBEGIN(concurrency-mt-unsafe): no other thread lives yet, or lives any more
  ASSERT_EQ(::setenv("LCM_DEFAULT_URL", "memq://", 1), 0);
  EXPECT_EQ(resolve_lcm_url(""), "memq://");
  EXPECT_EQ(open_or_abort("").url(), "memq://");
  EXPECT_EQ(resolve_lcm_url("udpm://:7700"), "udpm://:7700") << "an explicit URL has precedence";
  ASSERT_EQ(::unsetenv("LCM_DEFAULT_URL"), 0);
  // NOLINTEND(concurrency-mt-unsafe)
  EXPECT_EQ(resolve_lcm_url(""), "udpm://239.255.76.67:7667?ttl=0");
}

}  // namespace
}  // namespace buoyancy
