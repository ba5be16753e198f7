#include "view/live/page_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <iterator>
#include <list>
#include <mutex>
#include <span>
#include <string_view>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>

#include <arpa/inet.h>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http/chunk_encode.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "base/unique_fd.h"

namespace buoyancy::view {
namespace {

namespace http = boost::beast::http;
using Request = http::request<http::empty_body>;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::size_t kMaxChunkBytes = 65'536;  // of a resource's body
constexpr std::size_t kReceivedPartBytes = 4'096;
constexpr Seconds kLingerTime{0.2};

constexpr const char* kHeaders =  // of every response
    "Connection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n"
    "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
    "connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n";

// Size of a connection's send buffer. By default the kernel grows it to megabytes of outdated snapshots, for
// each of many connections.
constexpr int kSendBufferBytes = 131'072;

Clock::time_point deadline_after(Seconds timeout) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
}

// What a connection does. A connection with a stream is kept; others may have to make room.
enum class Phase { kHeader, kResponse, kStream };

// A connection of listen_on().
struct Connection {
  explicit Connection(UniqueFd client) : socket(std::move(client)) {}

  // Receives what arrives by the deadline. Returns its size [bytes]; 0: the peer has closed the connection,
  // or it is shut down; -1: nothing has arrived.
  ssize_t receive(std::span<char> part, Clock::time_point deadline) const {
    while (true) {
      const auto remaining = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
      if (remaining.count() <= 0) return -1;
      pollfd readable{socket.value(), POLLIN, 0};
      if (::poll(&readable, 1, static_cast<int>(remaining.count())) > 0) {
        return std::max<ssize_t>(::recv(socket.value(), part.data(), part.size(), 0), 0);
      }
    }
  }

  // Waits for the write time-out at most. False: the peer has gone or does not read; the response cannot be
  // continued.
  bool write(std::string_view bytes) {
    has_written = true;
    const ssize_t sent = ::send(socket.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return sent == static_cast<ssize_t>(bytes.size());
  }

  // Ends the response and lets the peer read the rest of it before the socket is closed.
  void finish() const {
    // Closing a socket that holds unread bytes resets the connection, and the peer may lose the response.
    ::shutdown(socket.value(), SHUT_WR);
    const auto deadline = deadline_after(kLingerTime);
    std::array<char, kReceivedPartBytes> ignored{};
    while (receive(ignored, deadline) > 0) {
    }
  }

  UniqueFd socket;
  bool has_written = false;
  // Kept by Connections, under its lock.
  Phase phase = Phase::kHeader;
  bool stopping = false;
  std::jthread thread;
};

// The open connections, in order of arrival, each served by a thread of its own.
class Connections {
 public:
  // max_connections: more than there can be streams. serve: must not throw.
  Connections(int max_connections, std::function<void(Connection&)> serve)
      : max_connections_(static_cast<std::size_t>(max_connections)), serve_(std::move(serve)) {}
  ~Connections() {  // after stop_all()
    std::unique_lock lock(mutex_);
    closed_.wait(lock, [this] { return open_.empty(); });
  }

  // If all places are taken, evicts a connection and waits for its thread, which ends immediately. Throws
  // std::system_error if there is no thread for the connection, which is then closed.
  void add(UniqueFd socket) {
    std::list<Connection> ended;  // joined without the lock
    std::unique_lock lock(mutex_);
    if (open_.size() >= max_connections_) evict_one();
    closed_.wait(lock, [this] { return open_.size() < max_connections_; });
    ended.swap(ended_);
    std::list<Connection> added;
    Connection& connection = added.emplace_back(std::move(socket));
    if (stopping_) stop(connection);
    connection.thread = std::jthread([this, self = added.begin()] {
      serve_(*self);
      close(self);
    });
    open_.splice(open_.end(), added);
  }

  // False: the connection is being closed.
  bool set_phase(Connection& connection, Phase phase) {
    const std::lock_guard lock(mutex_);
    connection.phase = phase;
    return !connection.stopping;
  }

  // Stops all connections, including those added later.
  void stop_all() {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    for (Connection& connection : open_) stop(connection);
  }

 private:
  static void stop(Connection& connection) {
    connection.stopping = true;
    ::shutdown(connection.socket.value(), SHUT_RDWR);  // ends every wait of the connection's thread
  }

  void close(std::list<Connection>::iterator connection) {
    // The lock is held, so that evict_one() cannot shut down a reused file descriptor.
    const std::lock_guard lock(mutex_);
    connection->socket.close();
    ended_.splice(ended_.end(), open_, connection);
    closed_.notify_all();
  }

  // Evicts the oldest connection that still waits for its request; if there is none, the oldest that is
  // sending a response. Streams are never evicted.
  void evict_one() {
    for (const Phase phase : {Phase::kHeader, Phase::kResponse}) {
      const auto oldest = std::ranges::find_if(
          open_, [phase](const Connection& other) { return other.phase == phase && !other.stopping; });
      if (oldest == open_.end()) continue;
      return stop(*oldest);
    }
  }

  const std::size_t max_connections_;
  const std::function<void(Connection&)> serve_;
  std::mutex mutex_;
  std::condition_variable closed_;
  bool stopping_ = false;
  std::list<Connection> open_;
  std::list<Connection> ended_;  // their threads are at their end
};

bool is_ipv6(const std::string& address) {
  return address.find(':') != std::string::npos;
}

// True for 127.0.0.0/8, also as an IPv4-mapped IPv6 address, and for ::1 in any notation.
bool is_loopback(const std::string& address) {
  in_addr ipv4{};
  if (::inet_pton(AF_INET, address.c_str(), &ipv4) == 1) return ntohl(ipv4.s_addr) >> 24 == 127;
  in6_addr ipv6{};
  if (::inet_pton(AF_INET6, address.c_str(), &ipv6) != 1) return false;
  return IN6_IS_ADDR_LOOPBACK(&ipv6) || (IN6_IS_ADDR_V4MAPPED(&ipv6) && ipv6.s6_addr[12] == 127);
}

std::string url_host(const std::string& address) {
  return is_ipv6(address) ? "[" + address + "]" : address;
}

// Removes the port: "127.0.0.1:8667" -> "127.0.0.1".
std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const std::size_t bracket = host.rfind(']');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || bracket < colon);
  return has_port ? host.substr(0, colon) : host;
}

// Returns the address in a Host header without its port; empty: a name. IPv6 addresses have brackets there.
std::string address_of(std::string_view host) {
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  std::string address(bracketed ? host.substr(1, host.size() - 2) : host);
  return bracketed == is_ipv6(address) && check_listen_address(address) ? address : "";
}

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c; });
  return text;
}

// Returns the names of this machine as people type them; none if its name is unknown.
std::vector<std::string> machine_names() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return {};
  return {name.data(), std::string(name.data()) + ".local"};
}

// Returns an invalid descriptor with errno set if it fails. address: numeric. port: if 0, set to a free one.
UniqueFd listen_on(const std::string& address, int& port, const PageLimits& limits) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  errno = EADDRNOTAVAIL;
  if (::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) return {};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned(found, ::freeaddrinfo);
  UniqueFd listening(::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto set = [&listening](int level, int option, auto value) {
    ::setsockopt(listening.value(), level, option, &value, sizeof value);
  };
  // Not SO_REUSEPORT, which would share the port with another view instead of reporting that it is taken.
  set(SOL_SOCKET, SO_REUSEADDR, 1);
  if (found->ai_family == AF_INET6) set(IPPROTO_IPV6, IPV6_V6ONLY, 0);
  // Connections inherit these. The first time-out ends a send that blocks; by the second the kernel drops a
  // peer that acknowledges nothing of what is buffered, even while there is room to buffer more.
  const auto write_timeout = std::chrono::round<std::chrono::microseconds>(Seconds(limits.write_timeout));
  set(SOL_SOCKET, SO_SNDTIMEO, timeval{write_timeout.count() / 1'000'000, write_timeout.count() % 1'000'000});
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<unsigned>(write_timeout.count() / 1'000));
  set(SOL_SOCKET, SO_SNDBUF, kSendBufferBytes);
  set(IPPROTO_TCP, TCP_NODELAY, 1);
  if (::bind(listening.value(), found->ai_addr, found->ai_addrlen) != 0) return {};
  if (::listen(listening.value(), limits.connections) != 0) return {};
  sockaddr_in6 bound{};  // the port of a sockaddr_in is at the same place
  socklen_t size = sizeof bound;
  if (::getsockname(listening.value(), reinterpret_cast<sockaddr*>(&bound), &size) != 0) return {};
  port = ntohs(bound.sin6_port);
  return listening;
}

bool is_complete(const std::string& header, std::size_t from) {
  from -= std::min<std::size_t>(from, 3);
  return header.find("\r\n\r\n", from) != std::string::npos || header.find("\n\n", from) != std::string::npos;
}

// headers: further ones, each with its line end.
std::string head(const std::string& status, const std::string& headers) {
  return "HTTP/1.1 " + status + "\r\n" + kHeaders + headers + "\r\n";
}

std::string text_response(const std::string& status, const std::string& text,
                          const std::string& headers = "") {
  return head(status, headers + "Content-Type: text/plain; charset=utf-8\r\nContent-Length: " +
                          std::to_string(text.size() + 1) + "\r\n") +
         text + "\n";
}

}  // namespace

Expected<void> check_listen_address(const std::string& address) {
  in6_addr parsed{};
  if (::inet_pton(is_ipv6(address) ? AF_INET6 : AF_INET, address.c_str(), &parsed) == 1) return {};
  return make_error({"--listen " + address, "not an IP address",
                     "a numeric address, such as 127.0.0.1, ::1 or 0.0.0.0", "a host name",
                     "Specify the address of the interface to listen on"});
}

class PageServer::Http {
 public:
  // Serves from now on.
  Http(UniqueFd listening, const std::string& address, std::vector<StaticResource> resources,
       SnapshotBroadcaster& broadcaster, const PageLimits& limits, std::vector<std::string> host_names,
       const Metrics* metrics)
      : listening_(std::move(listening)),
        address_(address),
        host_names_(std::move(host_names)),
        broadcaster_(broadcaster),
        metrics_(metrics),
        limits_(limits),
        connections_(limits.connections, [this](Connection& client) { serve(client); }) {
    host_names_.emplace_back("localhost");
    if (!is_loopback(address_)) std::ranges::copy(machine_names(), std::back_inserter(host_names_));
    for (std::string& name : host_names_) name = in_lower_case(std::move(name));
    for (StaticResource& resource : resources) {
      resources_.emplace(std::string(resource.path), std::move(resource));
    }
    thread_ = std::jthread([this](const std::stop_token& stop) { accept_connections(stop); });
  }
  ~Http() {
    thread_.request_stop();
    ::shutdown(listening_.value(), SHUT_RDWR);  // wakes the thread
    broadcaster_.close();
    connections_.stop_all();
    thread_.join();
  }

  bool serving() const { return serving_; }

 private:
  void accept_connections(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      UniqueFd client(::accept4(listening_.value(), nullptr, nullptr, SOCK_CLOEXEC));
      if (client.valid()) {
        try {
          connections_.add(std::move(client));
        } catch (const std::exception&) {
          // Without a thread or memory for it, this client is dropped; others may end and make room.
        }
      } else if (errno == EMFILE) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));  // until a connection ends
      } else if (errno != EINTR && errno != ECONNABORTED) {
        break;
      }
    }
    serving_ = false;
  }

  void serve(Connection& client) {
    try {
      respond(client);
    } catch (const std::exception&) {
      if (!client.has_written) client.write(failure_);
    }
    connections_.set_phase(client, Phase::kResponse);  // may be evicted again after a stream
    client.finish();
  }

  void respond(Connection& client) {
    std::string header;
    const std::string refusal = read_header(client, header);
    if (!connections_.set_phase(client, Phase::kResponse) || header.empty()) return;
    if (!refusal.empty()) {
      client.write(refusal);
      return;
    }
    http::request_parser<http::empty_body> parser;
    parser.header_limit(UINT32_MAX);  // limited already
    boost::system::error_code error;
    parser.put(boost::asio::buffer(header), error);
    if (parser.is_header_done()) return respond(client, parser.get());
    client.write(text_response("400 Bad Request", "This is no complete HTTP/1.1 request."));
  }

  // Reads the header of a request, with what follows it so far; less if the peer closes before its end.
  // Returns the response to one that is too large or too slow; otherwise empty.
  std::string read_header(const Connection& client, std::string& header) const {
    const auto deadline = deadline_after(Seconds(limits_.header_timeout));
    std::array<char, kReceivedPartBytes> part{};
    while (true) {
      const ssize_t size = client.receive(part, deadline);
      if (size < 0) return text_response("408 Request Timeout", "The request did not arrive in time.");
      if (size == 0) return "";
      const std::size_t before = header.size();
      header.append(part.data(), static_cast<std::size_t>(size));
      if (is_complete(header, before)) return "";
      if (header.size() > limits_.max_header_bytes) {
        return text_response(
            "431 Request Header Fields Too Large",
            "The header of a request is limited to " + std::to_string(limits_.max_header_bytes) + " bytes.");
      }
    }
  }

  bool is_host_allowed(const Request& request) const {
    if (request.count(http::field::host) != 1) return false;
    const std::string value(request[http::field::host]);
    const std::string_view host = without_port(value);
    if (std::ranges::find(host_names_, in_lower_case(std::string(host))) != host_names_.end()) return true;
    // DNS rebinding needs a name, since nobody else can point an address here. Any address is accepted:
    // clients may use any that this machine has, or that of a router in front of it.
    const std::string address = address_of(host);
    return !address.empty() && (!is_loopback(address_) || is_loopback(address));
  }

  void respond(Connection& client, const Request& request) {
    if (!is_host_allowed(request)) {
      return refuse(client, request, "403 Forbidden",
                    "The Host of this request is no name of this view. Open http://" + url_host(address_) +
                        " with the port, or start buoyancy-view with --host and the name.");
    }
    if (request.method() != http::verb::get) {
      return refuse(client, request, "405 Method Not Allowed", "Only GET is supported.", "Allow: GET\r\n");
    }
    const std::string target(request.target());
    const std::string path = target.substr(0, target.find('?'));
    if (path == "/events") return stream_events(client, request);
    if (path == "/metrics" && metrics_ != nullptr) {
      return send(client, "text/plain; version=0.0.4; charset=utf-8", metrics_->text());
    }
    const auto found = resources_.find(path);
    if (found == resources_.end())
      return refuse(client, request, "404 Not Found", "Not found; the page is at /.");
    send(client, found->second.content_type, found->second.body);
  }

  static void send(Connection& client, const std::string& content_type, std::string_view body) {
    bool reads = client.write(head("200 OK", "Content-Type: " + content_type + "\r\nContent-Length: " +
                                                 std::to_string(body.size()) + "\r\n"));
    for (std::size_t sent = 0; reads && sent < body.size(); sent += kMaxChunkBytes)
      reads = client.write(body.substr(sent, kMaxChunkBytes));
  }

  // A response to HEAD has no body.
  static void refuse(Connection& client, const Request& request, const std::string& status,
                     const std::string& text, const std::string& headers = "") {
    const std::string response = text_response(status, text, headers);
    const bool head_only = request.method() == http::verb::head;
    client.write(std::string_view(response).substr(0, response.size() - (head_only ? text.size() + 1 : 0)));
  }

  void stream_events(Connection& client, const Request& request) {
    SnapshotBroadcaster::Listener listener(broadcaster_, limits_.streams);
    if (!listener.admitted()) {
      return refuse(client, request, "503 Service Unavailable",
                    std::to_string(limits_.streams) + " pages are already connected to this view; close one.",
                    "Retry-After: 5\r\n");
    }
    if (!connections_.set_phase(client, Phase::kStream)) return;
    const bool chunked = request.version() >= 11;  // without chunks, a stream ends with its connection
    bool reads = client.write(head("200 OK", std::string("Content-Type: text/event-stream\r\n") +
                                                 (chunked ? "Transfer-Encoding: chunked\r\n" : "")));
    bool first = true;
    SnapshotBroadcaster::Text sea;
    while (reads) {
      const SnapshotBroadcaster::Published published = listener.next();
      if (published.number == 0) {
        if (chunked) client.write(boost::beast::buffers_to_string(http::make_chunk_last()));
        return;
      }
      std::string events;
      if (std::exchange(first, false))
        events = "retry: 1000\nevent: history\ndata: " + *published.history + "\n\n";
      if (published.sea && published.sea != sea) {
        sea = published.sea;
        events += "event: sea\ndata: " + *sea + "\n\n";
      }
      events += "data: " + *published.snapshot + "\n\n";
      if (chunked) events = boost::beast::buffers_to_string(http::make_chunk(boost::asio::buffer(events)));
      reads = client.write(events);
    }
  }

  const UniqueFd listening_;
  // This text is made in advance: there may be no memory for it when it is needed.
  const std::string failure_ =
      text_response("500 Internal Server Error", "The request could not be processed.");
  const std::string address_;
  std::vector<std::string> host_names_;  // in lower case
  SnapshotBroadcaster& broadcaster_;
  const Metrics* const metrics_;
  const PageLimits limits_;
  std::unordered_map<std::string, StaticResource> resources_;
  Connections connections_;
  std::atomic<bool> serving_{true};
  std::jthread thread_;
};

PageServer::PageServer(std::unique_ptr<Http> http, std::string url)
    : http_(std::move(http)), url_(std::move(url)) {}

PageServer::~PageServer() = default;

Expected<std::unique_ptr<PageServer>> PageServer::start(const std::string& address, int port,
                                                        std::vector<StaticResource> resources,
                                                        SnapshotBroadcaster& broadcaster,
                                                        const PageLimits& limits,
                                                        std::vector<std::string> host_names,
                                                        const Metrics* metrics) {
  if (Expected<void> checked = check_listen_address(address); !checked)
    return tl::unexpected(checked.error());
  UniqueFd listening = listen_on(address, port, limits);
  if (!listening.valid()) {
    return make_error(
        {"port " + std::to_string(port) + " of " + address, std::generic_category().message(errno),
         "a free port of this machine",
         "another program, such as another view, uses it, or the address is not one of this machine",
         "Choose another --port, or 0 for a free one"});
  }
  const std::string url = "http://" + url_host(address) + ":" + std::to_string(port) + "/";
  auto http = std::make_unique<Http>(std::move(listening), address, std::move(resources), broadcaster, limits,
                                     std::move(host_names), metrics);
  return std::unique_ptr<PageServer>(new PageServer(std::move(http), url));
}

bool PageServer::serving() const {
  return http_->serving();
}

}  // namespace buoyancy::view
