#include "view/live/page_server.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <functional>
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

namespace buoyancy {
namespace {

constexpr std::size_t kSlice = 65'536;  // bytes of a text that are one chunk

// Sent and not taken yet, at a time. The kernel would let it grow to megabytes: snapshots that are old before
// they are read, for each of many connections.
constexpr int kSendBuffer = 131'072;  // bytes

// The connections that are held, in the order in which they came.
class Connections {
 public:
  enum class Phase { kHead, kResponse, kStream };
  struct Connection {
    explicit Connection(socket_t its_socket) : socket(its_socket) {}
    socket_t socket;
    Phase phase = Phase::kHead;
    std::atomic<bool> given_up{false};
  };

  // most: more than there can be streams.
  explicit Connections(int most) : most_(static_cast<std::size_t>(most)) {}

  // Waits for the one that gives way, which is at once: its thread is woken, and waits for nobody.
  Connection& add(socket_t socket) {
    std::unique_lock lock(mutex_);
    if (delay_line_.size() >= most_) give_up_one();
    room_.wait(lock, [this] { return delay_line_.size() < most_; });
    Connection& added = delay_line_.emplace_back(socket);
    added.given_up = ended_;
    return added;
  }

  // False: it was given up.
  bool set_phase(Connection& connection, Phase phase) {
    const std::lock_guard lock(mutex_);
    connection.phase = phase;
    return !connection.given_up;
  }

  void close(const Connection& connection) {
    {
      const std::lock_guard lock(mutex_);  // else its number could be another's when it is given up
      ::close(connection.socket);
      delay_line_.remove_if([&connection](const Connection& held) { return &held == &connection; });
    }
    room_.notify_one();
  }

  // Gives up all, and whatever comes.
  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    for (Connection& held : delay_line_) held.given_up = true;
  }

 private:
  // The oldest whose request has not come; where there is none, the oldest that is slow to take its response.
  void give_up_one() {
    for (const Phase phase : {Phase::kHead, Phase::kResponse}) {
      const auto oldest = std::ranges::find_if(
          delay_line_, [phase](const Connection& held) { return held.phase == phase && !held.given_up; });
      if (oldest == delay_line_.end()) continue;
      oldest->given_up = true;
      ::shutdown(oldest->socket, SHUT_RDWR);  // wakes its thread
      return;
    }
  }

  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable room_;
  std::list<Connection> delay_line_;
  bool ended_ = false;
};

// The connection that this thread serves.
thread_local Connections::Connection* served = nullptr;

// Runs httplib's tasks on the thread that accepts: they only hand a connection to a thread of its own.
class OnTheSpot : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override { task(); }
  void shutdown() override {}
};

bool is_ipv6(const std::string& address) {
  return address.find(':') != std::string::npos;
}

// 127.0.0.0/8, also as IPv6 has it, and ::1, however written.
bool is_loopback(const std::string& address) {
  in_addr ipv4{};
  if (::inet_pton(AF_INET, address.c_str(), &ipv4) == 1) return ntohl(ipv4.s_addr) >> 24 == 127;
  in6_addr ipv6{};
  if (::inet_pton(AF_INET6, address.c_str(), &ipv6) != 1) return false;
  return IN6_IS_ADDR_LOOPBACK(&ipv6) || (IN6_IS_ADDR_V4MAPPED(&ipv6) && ipv6.s6_addr[12] == 127);
}

std::string in_url(const std::string& address) {
  return is_ipv6(address) ? "[" + address + "]" : address;
}

// "127.0.0.1" of "127.0.0.1:8667".
std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const std::size_t bracket = host.rfind(']');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || bracket < colon);
  return has_port ? host.substr(0, colon) : host;
}

// Does a Host without its port name the loopback? An address may: nobody else's web page is at one of these.
bool names_loopback(std::string_view host) {
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  const std::string address(bracketed ? host.substr(1, host.size() - 2) : host);
  return address == "localhost" ? !bracketed : bracketed == is_ipv6(address) && is_loopback(address);
}

void response_with(httplib::Response& response, int status, const std::string& text) {
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
  return make_error({"--listen " + address, "not an IP address", "digits, such as 127.0.0.1, ::1 or 0.0.0.0",
                     "a host's name", "Name the address of the interface to listen on"});
}

class PageServer::Http : public httplib::Server {
 public:
  Http(std::string address, std::vector<StaticResource> texts, SnapshotBroadcaster& hub,
       const PageLimits& limits)
      : address_(std::move(address)), hub_(hub), limits_(limits), connections_(limits.connections) {
    for (StaticResource& text : texts) {
      texts_.emplace(std::move(text.path), Text{std::move(text.content_type),
                                                std::make_shared<const std::string>(std::move(text.body))});
    }
    new_task_queue = [] { return new OnTheSpot; };  // httplib deletes it
    // httplib's own SO_REUSEPORT would share the port with another view instead of reporting it taken.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);  // its connections' too
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
          response_with(response, 500, "This request could not be answered.");
        });
  }

  // The port; negative: errno says why not.
  int bind(int port) {
    errno = 0;
    const int bound = port == 0 ? bind_to_any_port(address_) : bind_to_port(address_, port) ? port : -1;
    // httplib has room for five that wait to be accepted; a sixth would ask again only after a second.
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
    while (serving_ && !is_running()) std::this_thread::yield();  // stop() before it would do nothing
  }
  bool serving() const { return serving_; }

  void end() {
    connections_.end();
    hub_.close();
    stop();
    thread_.join();
    threads_->shutdown();
  }

 private:
  struct Text {
    std::string content_type;
    std::shared_ptr<const std::string> body;
  };

  bool process_and_close_socket(socket_t socket) override {
    Connections::Connection& connection = connections_.add(socket);
    threads_->enqueue([this, &connection] { serve(connection); });
    return true;
  }

  void serve(Connections::Connection& connection) {
    served = &connection;
    RequestStream stream(
        connection.socket,
        {limits_.max_header_bytes, Seconds(limits_.header_timeout), Seconds(limits_.write_timeout)},
        connection.given_up);
    const RequestStream::Head head = stream.read_head();
    if (connections_.set_phase(connection, Connections::Phase::kResponse)) respond(stream, head);
    connections_.set_phase(connection, Connections::Phase::kResponse);  // no stream any more
    stream.finish();
    connections_.close(connection);
  }

  void respond(RequestStream& stream, RequestStream::Head head) {
    switch (head) {
      case RequestStream::Head::kRead: {
        bool closed = false;
        // Texts are given whole and as they are: parts of them, and compression, only cost time.
        process_request(stream, true, closed, [](httplib::Request& request) {
          request.ranges.clear();
          request.headers.erase("Accept-Encoding");
        });
        break;
      }
      case RequestStream::Head::kTooLarge:
        stream.write(
            raw_response("431 Request Header Fields Too Large",
                         "A request may have " + std::to_string(limits_.max_header_bytes) + " bytes."));
        break;
      case RequestStream::Head::kTooSlow:
        stream.write(raw_response("408 Request Timeout", "The request did not come in time."));
        break;
      case RequestStream::Head::kNothing:
        break;
    }
  }

  bool is_host_ours(const httplib::Request& request) const {
    if (!is_loopback(address_)) return true;
    return request.get_header_value_count("Host") == 1 &&
           names_loopback(without_port(request.get_header_value("Host")));
  }

  void respond(const httplib::Request& request, httplib::Response& response) {
    if (!is_host_ours(request)) {
      response_with(response, 403,
                    "The Host of this request is not this machine's loopback. Open "
                    "http://" +
                        in_url(address_) + " with the port.");
      return;
    }
    if (request.method != "GET") {
      response.set_header("Allow", "GET");
      response_with(response, 405, "Only GET.");
      return;
    }
    if (request.path == "/events") {
      stream_events(response);
      return;
    }
    const auto found = texts_.find(request.path);
    if (found == texts_.end()) {
      response_with(response, 404, "There is nothing here; the page is at /.");
      return;
    }
    const Text& text = found->second;
    response.status = 200;
    response.set_content_provider(
        text.body->size(), text.content_type,
        [body = text.body](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
          return sink.write(body->data() + offset, std::min(length, kSlice));
        });
  }

  void stream_events(httplib::Response& response) {
    auto listener = std::make_shared<SnapshotBroadcaster::Listener>(hub_, limits_.streams);
    if (!listener->admitted()) {
      response.set_header("Retry-After", "5");
      response_with(response, 503,
                    "Already " + std::to_string(limits_.streams) + " pages show this view: close one.");
      return;
    }
    if (!connections_.set_phase(*served, Connections::Phase::kStream)) return;
    response.status = 200;
    response.set_chunked_content_provider(
        "text/event-stream",
        [listener, first = true](std::size_t /*offset*/, httplib::DataSink& sink) mutable {
          const SnapshotBroadcaster::Published published = listener->next();
          if (published.number == 0) {
            sink.done();
            return true;
          }
          std::string events;
          if (std::exchange(first, false)) {
            events = "retry: 1000\nevent: history\ndata: " + *published.history + "\n\n";
          }
          events += "data: " + *published.snapshot + "\n\n";
          return sink.write(events.data(), events.size());
        });
  }

  using Seconds = std::chrono::duration<double>;

  std::string address_;
  SnapshotBroadcaster& hub_;
  PageLimits limits_;
  std::unordered_map<std::string, Text> texts_;
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
                                                        std::vector<StaticResource> texts,
                                                        SnapshotBroadcaster& hub, const PageLimits& limits) {
  if (Expected<void> checked = check_listen_address(address); !checked)
    return tl::unexpected(checked.error());
  auto http = std::make_unique<Http>(address, std::move(texts), hub, limits);
  const int bound = http->bind(port);
  if (bound < 0) {
    const std::string reason = errno != 0 ? std::generic_category().message(errno) : "it cannot be bound";
    return make_error({"port " + std::to_string(port) + " of " + address, reason,
                       "a free port of this machine",
                       "another program, perhaps another view, has it, or the address is not this machine's",
                       "Choose another --port, or 0 for any that is free"});
  }
  http->start();
  const std::string url = "http://" + in_url(address) + ":" + std::to_string(bound) + "/";
  return std::unique_ptr<PageServer>(new PageServer(std::move(http), url));
}

bool PageServer::serving() const {
  return http_->serving();
}

}  // namespace buoyancy
