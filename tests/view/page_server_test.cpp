#include "view/live/page_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <list>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/contains.h"
#include "tests/support/timeouts.h"
#include "tests/view/http_peer.h"
#include "tests/view/malformed_requests.h"

namespace buoyancy::view {
namespace {

const std::string kModel(2'000'000, 'm');  // exceeds the kernel's buffers
constexpr int kSmallBuffer = 2'048;

std::string status_line(const std::string& response) {
  return response.substr(0, response.find("\r\n"));
}

std::string body(const std::string& response) {
  const std::size_t end = response.find("\r\n\r\n");
  return end == std::string::npos ? "" : response.substr(end + 4);
}

bool is_closed(HttpPeer& peer) {
  return peer.peek() == "";
}

const PageLimits kLimits;

class PageServerTest : public testing::Test {
 protected:
  PageServerTest()
      : PageServerTest(PageLimits{.header_timeout = kWaitTimeout, .write_timeout = kWaitTimeout}) {}
  // port: 0 selects a free one.
  explicit PageServerTest(const PageLimits& limits, const std::string& address = "127.0.0.1", int port = 0,
                          std::vector<std::string> host_names = {}) {
    auto started = PageServer::start(
        address, port,
        {{"/", "text/html; charset=utf-8", "<!doctype html>"}, {"/model", "application/json", kModel}},
        broadcaster_, limits, std::move(host_names));
    if (!started) throw std::runtime_error(started.error().message());
    server_ = std::move(*started);
    port_ = static_cast<std::uint16_t>(std::stoul(server_->url().substr(server_->url().rfind(':') + 1)));
  }

  std::string response_to(const std::string& request) const {
    HttpPeer peer(port_);
    peer.send(request);
    peer.end_sending();
    return peer.receive_all(kWaitTimeout);
  }
  std::string status_of(const std::string& request) const { return status_line(response_to(request)); }

  // The status of a request with these Host headers.
  std::string status_for(const std::string& hosts) const {
    return status_of("GET /model HTTP/1.1\r\n" + hosts + "\r\n");
  }

  // Waits until `count` streams are connected.
  void wait_for_listeners(int count) const {
    if (!becomes_true([&] { return broadcaster_.listeners() == count; })) {
      throw std::runtime_error("expected " + std::to_string(count) + " streams, found " +
                               std::to_string(broadcaster_.listeners()));
    }
  }

  // Polls `condition` every millisecond. Returns false if it is not true within kWaitTimeout.
  template <typename Condition>
  static bool becomes_true(Condition&& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
    while (!condition()) {
      if (std::chrono::steady_clock::now() >= deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

  SnapshotBroadcaster broadcaster_;
  std::unique_ptr<PageServer> server_;
  std::uint16_t port_ = 0;
};

TEST_F(PageServerTest, ServesResourcesWithSecurityHeaders) {
  const std::string page = response_to(get_request("/"));
  EXPECT_EQ(status_line(page), "HTTP/1.1 200 OK");
  EXPECT_EQ(body(page), "<!doctype html>");
  for (const char* header : {"\r\nCache-Control: no-store\r\n", "\r\nX-Content-Type-Options: nosniff\r\n",
                             "\r\nContent-Security-Policy: default-src 'none'; ",
                             "\r\nContent-Type: text/html; charset=utf-8\r\n"}) {
    EXPECT_TRUE(contains(page, header));
  }
  EXPECT_FALSE(contains(page, "Access-Control-Allow-Origin"));
  EXPECT_TRUE(body(response_to(get_request("/model"))) == kModel);
}

TEST_F(PageServerTest, IgnoresRangesAndCompression) {
  for (const char* header :
       {"Range: bytes=0-1\r\n", "Range: bytes=0-,0-,0-,0-,0-\r\n", "Accept-Encoding: gzip, br\r\n"}) {
    EXPECT_TRUE(body(response_to(get_request("/model", header))) == kModel) << header;
  }
}

TEST_F(PageServerTest, ReturnsNotFoundForOtherPaths) {
  for (const char* path : {"/events/", "/model/", "//", "/index.html", "/../etc/passwd", "/%2e%2e/etc/passwd",
                           "/%2e%2e%2fetc%2fpasswd", "/..%5c..%5cetc", "//etc/passwd", "/etc/passwd",
                           "/proc/self/environ", "/model/../../etc/passwd", "/%00", "/model%00", "/./model",
                           "/MODEL", "http://127.0.0.1/model/../etc/passwd", "file:///etc/passwd"}) {
    EXPECT_EQ(status_of(get_request(path)), "HTTP/1.1 404 Not Found") << path;
  }
}

TEST_F(PageServerTest, RejectsMethodsOtherThanGet) {
  for (const char* method : {"HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH", "CONNECT", "TRACE"}) {
    const std::string request =
        std::string(method) + " /model HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 3\r\n\r\nabc";
    const std::string status = status_of(request);
    EXPECT_TRUE(status.starts_with("HTTP/1.1 405 ")) << method << ": " << status;
  }
}

TEST_F(PageServerTest, SendsNoBodyInResponseToHead) {
  const std::string response = response_to("HEAD / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  EXPECT_TRUE(contains(response, "\r\nAllow: GET\r\n"));
  EXPECT_TRUE(response.ends_with("\r\n\r\n")) << response;
}

TEST_F(PageServerTest, RejectsWhatIsNoRequest) {
  for (const char* request :
       {"GET /", "GET / HTTP/1.1\r\nHost: 127.0.0.1", "GET / HTTP/1.1\nHost: 127.0.0.1\n\n",
        "GET / HTTP/2.0\r\nHost: 127.0.0.1\r\n\r\n", "GET / HTTP/1.1\r\nHost : 127.0.0.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: -1\r\n\r\n"}) {
    EXPECT_EQ(status_of(request), "HTTP/1.1 400 Bad Request") << request;
  }
}

TEST_F(PageServerTest, IgnoresQuery) {
  EXPECT_EQ(body(response_to(get_request("/?reload=1"))), "<!doctype html>");
}

TEST_F(PageServerTest, RejectsHostsOtherThanLoopback) {
  for (const char* host : {"127.0.0.1", "localhost", "[::1]", "127.0.0.1:8667", "localhost:1", "[::1]:80",
                           "127.0.0.2", "[::ffff:7f00:1]:8667"}) {
    EXPECT_EQ(status_for("Host: " + std::string(host) + "\r\n"), "HTTP/1.1 200 OK") << host;
  }
  for (const char* host : {"evil.example", "127.0.0.1.evil.example", "localhost.evil.example:8667", "",
                           "10.0.0.1", "[::ffff:a00:1]", "[localhost]", "[127.0.0.1]", "::1", "[]", "["}) {
    EXPECT_EQ(status_for("Host: " + std::string(host) + "\r\n"), "HTTP/1.1 403 Forbidden") << host;
  }
  EXPECT_EQ(status_for(""), "HTTP/1.1 403 Forbidden") << "no Host";
  EXPECT_EQ(status_for("Host: 127.0.0.1\r\nHost: evil.example\r\n"), "HTTP/1.1 403 Forbidden") << "two";
}

// On all addresses.
class PageServerAnyAddress : public PageServerTest {
 protected:
  PageServerAnyAddress() : PageServerTest(kLimits, "0.0.0.0", 0, {"Proxy.example"}) {}
};

TEST_F(PageServerAnyAddress, RejectsNamesOfOthers) {
  std::array<char, 256> machine{};
  ASSERT_EQ(::gethostname(machine.data(), machine.size() - 1), 0);
  for (const std::string& host :
       {std::string("127.0.0.1:8667"), std::string("192.0.2.7"), std::string("[2001:db8::7]:8667"),
        std::string("localhost"), std::string(machine.data()), std::string("proxy.EXAMPLE:80")}) {
    EXPECT_EQ(status_for("Host: " + host + "\r\n"), "HTTP/1.1 200 OK") << host;
  }
  for (const char* host : {"evil.example", "192.0.2.7.evil.example", "proxy.example.evil.example:8667", "",
                           "[192.0.2.7]", "2001:db8::7", "[proxy.example]"}) {
    EXPECT_EQ(status_for("Host: " + std::string(host) + "\r\n"), "HTTP/1.1 403 Forbidden") << host;
  }
  EXPECT_EQ(status_for(""), "HTTP/1.1 403 Forbidden") << "no Host";
}

// On 127.0.0.1 as an IPv4-mapped IPv6 address.
class PageServerMappedAddress : public PageServerTest {
 protected:
  PageServerMappedAddress() : PageServerTest(kLimits, "::ffff:127.0.0.1") {}
};

TEST_F(PageServerMappedAddress, RejectsHostsOtherThanLoopback) {
  for (const char* host : {"[::ffff:127.0.0.1]", "[::ffff:7f00:1]:8667", "127.0.0.1", "localhost"}) {
    EXPECT_EQ(status_for("Host: " + std::string(host) + "\r\n"), "HTTP/1.1 200 OK") << host;
  }
  EXPECT_EQ(status_for("Host: evil.example\r\n"), "HTTP/1.1 403 Forbidden");
}

TEST_F(PageServerTest, StreamsHistoryAndSnapshotsToAllListeners) {
  HttpPeer first(port_);
  HttpPeer second(port_);
  for (HttpPeer* peer : {&first, &second}) peer->send(get_request("/events"));
  wait_for_listeners(2);
  broadcaster_.publish("[1]", R"({"n":1})");
  for (HttpPeer* peer : {&first, &second}) {
    std::string text;
    while (text.find("data: {\"n\":1}\n\n") == std::string::npos) {
      const std::optional<std::string> part = peer->receive(kWaitTimeout);
      ASSERT_TRUE(part && !part->empty()) << text;
      text += *part;
    }
    EXPECT_TRUE(contains(text, "Content-Type: text/event-stream\r\n"));
    EXPECT_TRUE(contains(text, "event: history\ndata: [1]\n\n"));
  }
  broadcaster_.publish("[2]", R"({"n":2})");
  std::string more;
  while (more.find("data: {\"n\":2}\n\n") == std::string::npos) {
    const std::optional<std::string> part = first.receive(kWaitTimeout);
    ASSERT_TRUE(part && !part->empty());
    more += *part;
  }
  EXPECT_FALSE(contains(more, "history")) << "sent once per listener";
}

TEST_F(PageServerTest, StreamsInChunksUnlessClientIsOfHttp10) {
  HttpPeer current(port_);
  HttpPeer old(port_);
  current.send("GET /events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  old.send("GET /events HTTP/1.0\r\nHost: 127.0.0.1\r\n\r\n");
  wait_for_listeners(2);
  broadcaster_.publish("[]", "{}");
  const std::string events = "retry: 1000\nevent: history\ndata: []\n\ndata: {}\n\n";
  std::string chunks;
  std::string plain;
  for (const auto& [peer, text] : {std::pair(&current, &chunks), std::pair(&old, &plain)}) {
    while (text->find(events) == std::string::npos) {
      const std::optional<std::string> part = peer->receive(kWaitTimeout);
      ASSERT_TRUE(part && !part->empty()) << *text;
      *text += *part;
    }
  }
  broadcaster_.close();
  chunks += current.receive_all(kWaitTimeout);
  plain += old.receive_all(kWaitTimeout);
  EXPECT_TRUE(contains(chunks, "\r\nTransfer-Encoding: chunked\r\n"));
  EXPECT_EQ(body(chunks), "2f\r\n" + events + "\r\n0\r\n\r\n");
  EXPECT_FALSE(contains(plain, "Transfer-Encoding"));
  EXPECT_EQ(body(plain), events);
}

TEST_F(PageServerTest, RemovesDisconnectedListener) {
  {
    HttpPeer peer(port_);
    peer.send(get_request("/events"));
    wait_for_listeners(1);
  }
  EXPECT_TRUE(becomes_true([&] {
    broadcaster_.publish("[]", "{}");
    return broadcaster_.listeners() == 0;
  }));
  EXPECT_EQ(status_of(get_request("/")), "HTTP/1.1 200 OK");
}

class PageServerWriteTimeout : public PageServerTest {
 protected:
  PageServerWriteTimeout()
      : PageServerTest(PageLimits{.header_timeout = kWaitTimeout, .write_timeout = 0.1}) {}
};

TEST_F(PageServerWriteTimeout, DropsUnreadStreamAndServesOthers) {
  HttpPeer unread(port_);
  unread.send(get_request("/events"));
  wait_for_listeners(1);
  const std::string large = "{\"" + std::string(1'000'000, 'x') + "\":1}";
  EXPECT_TRUE(becomes_true([&] {
    broadcaster_.publish("[]", large);
    return broadcaster_.listeners() == 0;
  }));
  HttpPeer other(port_);
  other.send(get_request("/"));
  EXPECT_TRUE(other.receive_all(kWaitTimeout).starts_with("HTTP/1.1 "));
}

TEST_F(PageServerWriteTimeout, DropsUnreadStreamBeforeKernelBufferIsFull) {
  HttpPeer unread(port_, kSmallBuffer);
  unread.send(get_request("/events"));
  wait_for_listeners(1);
  const std::string small = "{\"" + std::string(100, 'x') + "\":1}";
  // At most 50 kB, a fraction of the kernel's buffers: the first snapshots fill the reader's small buffer,
  // the others follow slowly enough to give the server kWaitTimeout.
  constexpr int kFirst = 100;
  constexpr int kMaxSnapshots = 500;
  int published = 0;
  while (broadcaster_.listeners() > 0 && published < kMaxSnapshots) {
    broadcaster_.publish("[]", small);
    ++published;
    std::this_thread::sleep_for(
        std::chrono::duration<double>(published < kFirst ? 0.002 : kWaitTimeout / (kMaxSnapshots - kFirst)));
  }
  EXPECT_EQ(broadcaster_.listeners(), 0) << published << " snapshots";
}

TEST_F(PageServerWriteTimeout, KeepsReaderDuringPauseOfSnapshots) {
  EventReader reader(port_);
  wait_for_listeners(1);
  for (int i = 0; i < 3; ++i) {
    broadcaster_.publish("[]", "{}");
    ASSERT_TRUE(reader.next(kWaitTimeout));
    std::this_thread::sleep_for(std::chrono::milliseconds(150));  // exceeds write_timeout
  }
  EXPECT_EQ(broadcaster_.listeners(), 1);
}

TEST_F(PageServerTest, StreamsLargeSnapshotsToFastReader) {
  EventReader reader(port_);
  wait_for_listeners(1);
  const std::string large = "{\"" + std::string(25'000, 'x') + "\":1}";  // about 100 bodies
  for (int i = 0; i < 300; ++i) {
    broadcaster_.publish("[]", large);
    ASSERT_EQ(reader.next(kWaitTimeout), large);
  }
}

TEST_F(PageServerTest, RejectsStreamsBeyondLimit) {
  std::list<HttpPeer> peers;
  for (int i = 0; i < kLimits.streams; ++i) {
    peers.emplace_back(port_).send(get_request("/events"));
    wait_for_listeners(i + 1);
  }
  const std::string refused = response_to(get_request("/events"));
  EXPECT_EQ(status_line(refused), "HTTP/1.1 503 Service Unavailable");
  EXPECT_TRUE(contains(body(refused), "close one"));
  EXPECT_EQ(status_of(get_request("/model")), "HTTP/1.1 200 OK") << "other resources are still served";
}

TEST_F(PageServerTest, ServesWhileConnectionLimitIsExceeded) {
  EventReader before(port_);
  wait_for_listeners(1);
  std::list<HttpPeer> held;
  for (int i = 0; i < 300; ++i) {
    held.emplace_back(port_).send(i % 2 == 0 ? "GET /mod" : "");
  }
  EXPECT_EQ(status_of(get_request("/")), "HTTP/1.1 200 OK");
  EventReader after(port_);
  wait_for_listeners(2);
  broadcaster_.publish("[]", "{}");
  EXPECT_TRUE(before.next(kWaitTimeout)) << "streams are not evicted";
  EXPECT_TRUE(after.next(kWaitTimeout));
  EXPECT_TRUE(is_closed(held.front())) << "the longest waiting connection";
  EXPECT_FALSE(is_closed(held.back()));
  EXPECT_GE(std::ranges::count_if(held, [](HttpPeer& peer) { return !is_closed(peer); }),
            kLimits.connections - 3);
}

TEST_F(PageServerTest, ServesWhileConnectionsAreRenewed) {
  std::list<HttpPeer> held;
  for (int i = 0; i < 2'000; ++i) {
    held.emplace_back(port_);
    if (held.size() > 300) held.pop_front();
    if (i % 20 == 0) {
      ASSERT_EQ(status_of(get_request("/")), "HTTP/1.1 200 OK") << i;
    }
  }
}

TEST_F(PageServerTest, ServesWhileResponsesAreNotRead) {
  std::list<HttpPeer> held;
  for (int i = 0; i < 300; ++i) held.emplace_back(port_, kSmallBuffer).send(get_request("/model"));
  EXPECT_EQ(status_of(get_request("/")), "HTTP/1.1 200 OK");
  EventReader reader(port_);
  wait_for_listeners(1);
}

TEST_F(PageServerTest, RejectsEndlessHeader) {
  HttpPeer peer(port_);
  peer.send("GET / HTTP/1.1\r\n");
  const std::string header = "X-Filler: " + std::string(1'000, 'x') + "\r\n";
  for (int i = 0; i < 100 && peer.send(header); ++i) {
  }
  EXPECT_EQ(status_line(peer.receive_all(kWaitTimeout)), "HTTP/1.1 431 Request Header Fields Too Large");
}

class PageServerHeaderTimeout : public PageServerTest {
 protected:
  PageServerHeaderTimeout()
      : PageServerTest(PageLimits{.header_timeout = 0.1, .write_timeout = kWaitTimeout}) {}
};

TEST_F(PageServerHeaderTimeout, TimesOutOnIncompleteHeader) {
  HttpPeer peer(port_);
  peer.send("GET / HT");
  EXPECT_EQ(status_line(peer.receive_all(kWaitTimeout)), "HTTP/1.1 408 Request Timeout");
}

TEST_F(PageServerTest, SurvivesMalformedRequests) {
  MalformedRequests malformed(1);
  for (int i = 0; i < 10'000; ++i) response_to(malformed.next());
  EXPECT_EQ(status_of(get_request("/")), "HTTP/1.1 200 OK");
  EXPECT_TRUE(server_->serving());
}

TEST_F(PageServerTest, ReportsPortInUse) {
  SnapshotBroadcaster other_broadcaster;
  const auto second = PageServer::start("127.0.0.1", port_, {}, other_broadcaster);
  ASSERT_FALSE(second);
  EXPECT_TRUE(contains(second.error().message(), "Address already in use"));
}

// On a port outside the ephemeral range, which no other process gets after the server has stopped.
class PageServerFixedPort : public PageServerTest {
 protected:
  PageServerFixedPort() : PageServerTest(kLimits, "127.0.0.1", 8667) {}
};

TEST_F(PageServerFixedPort, StopsWithOpenStreamsAndIncompleteRequests) {
  HttpPeer stream(port_);
  stream.send(get_request("/events"));
  wait_for_listeners(1);
  HttpPeer half(port_);
  half.send("GET /");
  server_.reset();
  EXPECT_TRUE(contains(stream.receive_all(kWaitTimeout), "HTTP/1.1 200 OK"));
  EXPECT_THROW(HttpPeer{port_}, std::runtime_error);
}

TEST(CheckListenAddress, AcceptsOnlyNumericAddresses) {
  for (const char* address : {"127.0.0.1", "0.0.0.0", "::1", "::", "::ffff:127.0.0.1", "192.168.1.7"}) {
    EXPECT_TRUE(check_listen_address(address)) << address;
  }
  for (const char* address : {"", "localhost", "127.0.0", "1.2.3.4.5", ":::", "example.org"}) {
    EXPECT_FALSE(check_listen_address(address)) << address;
  }
}

}  // namespace
}  // namespace buoyancy::view
