#include "view/page_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <functional>
#include <string_view>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>

#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>

#include "view/request_stream.h"

namespace buoyancy {
namespace {

constexpr std::size_t kSlice = 65'536;  // bytes of a text that are one chunk

// Set while the thread that accepts runs a connection's task in order to turn it away.
thread_local bool turning_away = false;

// A fixed number of threads, and no queue: a connection that finds none free is turned away at once.
class ConnectionThreads : public httplib::TaskQueue {
 public:
  explicit ConnectionThreads(int most) : most_(most), threads_(static_cast<std::size_t>(most)) {}
  void enqueue(std::function<void()> task) override {
    if (busy_.fetch_add(1) >= most_) {
      --busy_;
      turning_away = true;
      task();
      turning_away = false;
      return;
    }
    threads_.enqueue([this, task = std::move(task)] {
      task();
      --busy_;
    });
  }
  void shutdown() override { threads_.shutdown(); }

 private:
  int most_;
  httplib::ThreadPool threads_;
  std::atomic<int> busy_{0};
};

bool is_ipv6(const std::string& address) {
  return address.find(':') != std::string::npos;
}

bool is_loopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
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

void answer_with(httplib::Response& response, int status, const std::string& text) {
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
  return failure({"--listen " + address, "not an IP address", "digits, such as 127.0.0.1, ::1 or 0.0.0.0",
                  "a host's name", "Name the address of the interface to listen on"});
}

class PageServer::Http : public httplib::Server {
 public:
  Http(std::string address, std::vector<ServedText> texts, SnapshotHub& hub, const PageLimits& limits)
      : address_(std::move(address)), hub_(hub), limits_(limits) {
    for (ServedText& text : texts) {
      texts_.emplace(std::move(text.path), Text{std::move(text.content_type),
                                                std::make_shared<const std::string>(std::move(text.body))});
    }
    new_task_queue = [this] { return new ConnectionThreads(limits_.connections); };  // httplib deletes it
    // httplib's own SO_REUSEPORT would share the port with another view instead of reporting it taken.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
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
      answer(request, response);
      return HandlerResponse::Handled;
    });
    set_exception_handler(
        [](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
          answer_with(response, 500, "This request could not be answered.");
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
    thread_ = std::thread([this] {
      listen_after_bind();
      serving_ = false;
    });
    while (serving_ && !is_running()) std::this_thread::yield();  // stop() before it would do nothing
  }
  bool serving() const { return serving_; }

  void end() {
    ending_ = true;
    hub_.close();
    stop();
    thread_.join();
  }

 private:
  struct Text {
    std::string content_type;
    std::shared_ptr<const std::string> body;
  };

  bool process_and_close_socket(socket_t socket) override {
    if (turning_away) {
      static const std::string kBusy = raw_response(
          "503 Service Unavailable", "Too many connections at a time: close a page that shows this view.");
      ::send(socket, kBusy.data(), kBusy.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
      ::shutdown(socket, SHUT_WR);
      ::close(socket);
      return false;
    }
    RequestStream stream(
        socket, {limits_.head_bytes, Seconds(limits_.head_patience), Seconds(limits_.write_patience)},
        ending_);
    switch (stream.read_head()) {
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
        stream.write(raw_response("431 Request Header Fields Too Large",
                                  "A request may have " + std::to_string(limits_.head_bytes) + " bytes."));
        break;
      case RequestStream::Head::kTooSlow:
        stream.write(raw_response("408 Request Timeout", "The request did not come in time."));
        break;
      case RequestStream::Head::kNothing:
        break;
    }
    stream.finish();
    return true;
  }

  bool is_host_ours(const httplib::Request& request) const {
    if (!is_loopback(address_)) return true;
    const std::string header = request.get_header_value("Host");
    const std::array<std::string, 4> ours{"localhost", "127.0.0.1", "[::1]", in_url(address_)};
    return request.get_header_value_count("Host") == 1 &&
           std::ranges::find(ours, without_port(header)) != ours.end();
  }

  void answer(const httplib::Request& request, httplib::Response& response) {
    if (!is_host_ours(request)) {
      answer_with(response, 403,
                  "The Host of this request is not this machine's loopback. Open "
                  "http://" +
                      in_url(address_) + " with the port.");
      return;
    }
    if (request.method != "GET") {
      response.set_header("Allow", "GET");
      answer_with(response, 405, "Only GET.");
      return;
    }
    if (request.path == "/events") {
      stream_events(response);
      return;
    }
    const auto found = texts_.find(request.path);
    if (found == texts_.end()) {
      answer_with(response, 404, "There is nothing here; the page is at /.");
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
    auto listener = std::make_shared<SnapshotHub::Listener>(hub_, limits_.streams);
    if (!listener->admitted()) {
      response.set_header("Retry-After", "5");
      answer_with(response, 503,
                  "Already " + std::to_string(limits_.streams) + " pages show this view: close one.");
      return;
    }
    response.status = 200;
    response.set_chunked_content_provider(
        "text/event-stream",
        [listener, first = true](std::size_t /*offset*/, httplib::DataSink& sink) mutable {
          const SnapshotHub::Published published = listener->next();
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
  SnapshotHub& hub_;
  PageLimits limits_;
  std::unordered_map<std::string, Text> texts_;
  std::atomic<bool> serving_{false};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

PageServer::PageServer(std::unique_ptr<Http> http, std::string url)
    : http_(std::move(http)), url_(std::move(url)) {}

PageServer::~PageServer() {
  http_->end();
}

Expected<std::unique_ptr<PageServer>> PageServer::start(const std::string& address, int port,
                                                        std::vector<ServedText> texts, SnapshotHub& hub,
                                                        const PageLimits& limits) {
  if (Expected<void> checked = check_listen_address(address); !checked)
    return tl::unexpected(checked.error());
  auto http = std::make_unique<Http>(address, std::move(texts), hub, limits);
  const int bound = http->bind(port);
  if (bound < 0) {
    const std::string reason = errno != 0 ? std::generic_category().message(errno) : "it cannot be bound";
    return failure({"port " + std::to_string(port) + " of " + address, reason, "a free port of this machine",
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
