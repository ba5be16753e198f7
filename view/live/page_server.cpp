#include "view/live/page_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <condition_variable>
#include <functional>
#include <iterator>
#include <list>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>

#include <arpa/inet.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "view/live/request_stream.h"

namespace buoyancy::view {
namespace {

constexpr std::size_t kMaxChunkBytes = 65'536;  // of a resource's body

// Size of a connection's send buffer. By default the kernel grows it to megabytes of outdated snapshots, for
// each of many connections.
constexpr int kSendBufferBytes = 131'072;

// The open connections, in order of arrival.
class Connections {
 public:
  enum class Phase { kHeader, kResponse, kStream };
  struct Connection {
    explicit Connection(socket_t socket_of_client) : socket(socket_of_client) {}
    socket_t socket;
    Phase phase = Phase::kHeader;
    std::atomic<bool> stopping{false};
  };

  // max_connections: more than there can be streams.
  explicit Connections(int max_connections) : max_connections_(static_cast<std::size_t>(max_connections)) {}

  // If all places are taken, evicts a connection and waits for its thread, which ends immediately.
  Connection& add(socket_t socket) {
    std::unique_lock lock(mutex_);
    if (open_.size() >= max_connections_) evict_one();
    closed_.wait(lock, [this] { return open_.size() < max_connections_; });
    Connection& added = open_.emplace_back(socket);
    added.stopping = stopping_;
    return added;
  }

  // False: the connection is being closed.
  bool set_phase(Connection& connection, Phase phase) {
    const std::lock_guard lock(mutex_);
    connection.phase = phase;
    return !connection.stopping;
  }

  void close(const Connection& connection) {
    {
      // Under the lock, so that evict_one() cannot shut down a reused file descriptor.
      const std::lock_guard lock(mutex_);
      ::close(connection.socket);
      open_.remove_if([&connection](const Connection& other) { return &other == &connection; });
    }
    closed_.notify_one();
  }

  // Stops all connections, including those added later.
  void stop_all() {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    for (Connection& connection : open_) connection.stopping = true;
  }

 private:
  // Evicts the oldest connection that still waits for its request; if there is none, the oldest that is
  // sending a response. Streams are never evicted.
  void evict_one() {
    for (const Phase phase : {Phase::kHeader, Phase::kResponse}) {
      const auto oldest = std::ranges::find_if(
          open_, [phase](const Connection& other) { return other.phase == phase && !other.stopping; });
      if (oldest == open_.end()) continue;
      oldest->stopping = true;
      ::shutdown(oldest->socket, SHUT_RDWR);  // wakes the connection's thread
      return;
    }
  }

  const std::size_t max_connections_;
  std::mutex mutex_;
  std::condition_variable closed_;
  std::list<Connection> open_;
  bool stopping_ = false;
};

// The connection that the current thread serves.
thread_local Connections::Connection* current_connection = nullptr;

// Runs httplib's tasks on the accepting thread; they only hand the connection to a worker thread.
class InlineTaskQueue : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override { task(); }
  void shutdown() override {}
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

// The address that a Host without its port is; empty if it is none. IPv6 addresses have brackets.
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

// Of this machine, as people type it; none if it is unknown.
std::vector<std::string> machine_names() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return {};
  return {name.data(), std::string(name.data()) + ".local"};
}

void set_text(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", "text/plain; charset=utf-8");
}

std::string raw_response(const std::string& status, const std::string& text) {
  return "HTTP/1.1 " + status +
         "\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: " + std::to_string(text.size() + 1) +
         "\r\nConnection: close\r\n\r\n" + text + "\n";
}

}  // namespace

Expected<void> check_listen_address(const std::string& address) {
  in6_addr parsed{};
  if (::inet_pton(is_ipv6(address) ? AF_INET6 : AF_INET, address.c_str(), &parsed) == 1) return {};
  return make_error({"--listen " + address, "not an IP address",
                     "a numeric address, such as 127.0.0.1, ::1 or 0.0.0.0", "a host name",
                     "Specify the address of the interface to listen on"});
}

class PageServer::Http : public httplib::Server {
 public:
  Http(std::string address, std::vector<StaticResource> resources, SnapshotBroadcaster& broadcaster,
       const PageLimits& limits, std::vector<std::string> host_names)
      : address_(std::move(address)),
        host_names_(std::move(host_names)),
        broadcaster_(broadcaster),
        limits_(limits),
        connections_(limits.connections) {
    host_names_.emplace_back("localhost");
    if (!is_loopback(address_)) std::ranges::copy(machine_names(), std::back_inserter(host_names_));
    for (std::string& name : host_names_) name = in_lower_case(std::move(name));
    for (StaticResource& resource : resources) {
      resources_.emplace(std::move(resource.path),
                         Resource{std::move(resource.content_type),
                                  std::make_shared<const std::string>(std::move(resource.body))});
    }
    new_task_queue = [] { return new InlineTaskQueue; };  // httplib deletes it
    // httplib's default, SO_REUSEPORT, would share the port with another view instead of reporting that it is
    // taken.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBufferBytes,
                   sizeof kSendBufferBytes);  // inherited by connections
    });
    set_tcp_nodelay(true);
    set_default_headers({
        {"Cache-Control", "no-store"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Content-Security-Policy",
         "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; "
         "img-src data:; "
         "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    });
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      respond(request, response);
      return HandlerResponse::Handled;
    });
    set_exception_handler(
        [](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
          set_text(response, 500, "The request could not be processed.");
        });
  }

  // Returns the port; negative: failed, errno has the reason.
  int bind(int port) {
    errno = 0;
    const int bound = port == 0 ? bind_to_any_port(address_) : bind_to_port(address_, port) ? port : -1;
    // httplib's backlog is 5; a client beyond it would retry only after a second.
    if (bound >= 0) ::listen(svr_sock_, limits_.connections);
    return bound;
  }

  void start() {
    serving_ = true;
    threads_ = std::make_unique<httplib::ThreadPool>(static_cast<std::size_t>(limits_.connections));
    thread_ = std::thread([this] {
      listen_after_bind();
      serving_ = false;
    });
    while (serving_ && !is_running()) std::this_thread::yield();  // a stop() before that has no effect
  }
  bool serving() const { return serving_; }

  void end() {
    connections_.stop_all();
    broadcaster_.close();
    stop();
    thread_.join();
    threads_->shutdown();
  }

 private:
  struct Resource {
    std::string content_type;
    std::shared_ptr<const std::string> body;
  };

  bool process_and_close_socket(socket_t socket) override {
    Connections::Connection& connection = connections_.add(socket);
    threads_->enqueue([this, &connection] { serve(connection); });
    return true;
  }

  void serve(Connections::Connection& connection) {
    current_connection = &connection;
    RequestStream stream(
        connection.socket,
        {limits_.max_header_bytes, Seconds(limits_.header_timeout), Seconds(limits_.write_timeout)},
        connection.stopping);
    const RequestStream::HeaderResult header = stream.read_header();
    if (connections_.set_phase(connection, Connections::Phase::kResponse)) respond(stream, header);
    connections_.set_phase(connection, Connections::Phase::kResponse);  // may be evicted again after a stream
    stream.finish();
    connections_.close(connection);
  }

  void respond(RequestStream& stream, RequestStream::HeaderResult header) {
    switch (header) {
      case RequestStream::HeaderResult::kComplete: {
        bool closed = false;
        // Resources are sent completely and uncompressed: ranges and compression only cost time.
        process_request(stream, true, closed, [](httplib::Request& request) {
          request.ranges.clear();
          request.headers.erase("Accept-Encoding");
        });
        break;
      }
      case RequestStream::HeaderResult::kTooLarge:
        stream.write(raw_response(
            "431 Request Header Fields Too Large",
            "The header of a request is limited to " + std::to_string(limits_.max_header_bytes) + " bytes."));
        break;
      case RequestStream::HeaderResult::kTooSlow:
        stream.write(raw_response("408 Request Timeout", "The request did not arrive in time."));
        break;
      case RequestStream::HeaderResult::kEmpty:
        break;
    }
  }

  bool is_host_allowed(const httplib::Request& request) const {
    if (request.get_header_value_count("Host") != 1) return false;
    const std::string value = request.get_header_value("Host");
    const std::string_view host = without_port(value);
    if (std::ranges::find(host_names_, in_lower_case(std::string(host))) != host_names_.end()) return true;
    // An address is no name that someone else could have pointed here; this machine may have any, also that
    // of a router.
    const std::string address = address_of(host);
    return !address.empty() && (!is_loopback(address_) || is_loopback(address));
  }

  void respond(const httplib::Request& request, httplib::Response& response) {
    if (!is_host_allowed(request)) {
      set_text(response, 403,
               "The Host of this request is no name of this view. Open http://" + url_host(address_) +
                   " with the port, or start buoyancy-view with --host and the name.");
      return;
    }
    if (request.method != "GET") {
      response.set_header("Allow", "GET");
      set_text(response, 405, "Only GET is supported.");
      return;
    }
    if (request.path == "/events") {
      stream_events(response);
      return;
    }
    const auto found = resources_.find(request.path);
    if (found == resources_.end()) {
      set_text(response, 404, "Not found; the page is at /.");
      return;
    }
    const Resource& resource = found->second;
    response.status = 200;
    response.set_content_provider(
        resource.body->size(), resource.content_type,
        [body = resource.body](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
          return sink.write(body->data() + offset, std::min(length, kMaxChunkBytes));
        });
  }

  void stream_events(httplib::Response& response) {
    auto listener = std::make_shared<SnapshotBroadcaster::Listener>(broadcaster_, limits_.streams);
    if (!listener->admitted()) {
      response.set_header("Retry-After", "5");
      set_text(response, 503,
               std::to_string(limits_.streams) + " pages are already connected to this view; close one.");
      return;
    }
    if (!connections_.set_phase(*current_connection, Connections::Phase::kStream)) return;
    response.status = 200;
    response.set_chunked_content_provider(
        "text/event-stream", [listener, first = true, sea = SnapshotBroadcaster::Text()](
                                 std::size_t /*offset*/, httplib::DataSink& sink) mutable {
          const SnapshotBroadcaster::Published published = listener->next();
          if (published.number == 0) {
            sink.done();
            return true;
          }
          std::string events;
          if (std::exchange(first, false)) {
            events = "retry: 1000\nevent: history\ndata: " + *published.history + "\n\n";
          }
          if (published.sea && published.sea != sea) {
            sea = published.sea;
            events += "event: sea\ndata: " + *sea + "\n\n";
          }
          events += "data: " + *published.snapshot + "\n\n";
          return sink.write(events.data(), events.size());
        });
  }

  using Seconds = std::chrono::duration<double>;

  std::string address_;
  std::vector<std::string> host_names_;  // in lower case
  SnapshotBroadcaster& broadcaster_;
  PageLimits limits_;
  std::unordered_map<std::string, Resource> resources_;
  Connections connections_;
  std::atomic<bool> serving_{false};
  std::unique_ptr<httplib::ThreadPool> threads_;
  std::thread thread_;
};

PageServer::PageServer(std::unique_ptr<Http> http, std::string url)
    : http_(std::move(http)), url_(std::move(url)) {}

PageServer::~PageServer() {
  http_->end();
}

Expected<std::unique_ptr<PageServer>> PageServer::start(const std::string& address, int port,
                                                        std::vector<StaticResource> resources,
                                                        SnapshotBroadcaster& broadcaster,
                                                        const PageLimits& limits,
                                                        std::vector<std::string> host_names) {
  if (Expected<void> checked = check_listen_address(address); !checked)
    return tl::unexpected(checked.error());
  auto http =
      std::make_unique<Http>(address, std::move(resources), broadcaster, limits, std::move(host_names));
  const int bound = http->bind(port);
  if (bound < 0) {
    const std::string reason = errno != 0 ? std::generic_category().message(errno) : "it cannot be bound";
    return make_error(
        {"port " + std::to_string(port) + " of " + address, reason, "a free port of this machine",
         "another program, such as another view, uses it, or the address is not one of this machine",
         "Choose another --port, or 0 for a free one"});
  }
  http->start();
  const std::string url = "http://" + url_host(address) + ":" + std::to_string(bound) + "/";
  return std::unique_ptr<PageServer>(new PageServer(std::move(http), url));
}

bool PageServer::serving() const {
  return http_->serving();
}

}  // namespace buoyancy::view
