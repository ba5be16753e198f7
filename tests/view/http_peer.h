// A client of the live view's HTTP server without an HTTP library: it sends arbitrary bytes, well-formed or
// not, and returns what it receives.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "base/unique_fd.h"

namespace buoyancy::view {

class HttpPeer {
 public:
  // Connects to the port on 127.0.0.1. Throws if no server listens. receive_buffer: size of the kernel's
  // receive buffer [bytes]; 0: the kernel's default.
  explicit HttpPeer(std::uint16_t port, int receive_buffer = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (receive_buffer > 0) {
      ::setsockopt(socket_.value(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_.value(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("no server listens on port " + std::to_string(port));
    }
  }

  // Returns false if the server closed the connection before all was sent.
  bool send(const std::string& bytes) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t part = ::send(socket_.value(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (part <= 0) return false;
      sent += static_cast<std::size_t>(part);
    }
    return true;
  }
  void end_sending() { ::shutdown(socket_.value(), SHUT_WR); }

  // Returns what has arrived since the last call, at least one byte. Empty: the server closed the connection.
  // nullopt: nothing arrived within `seconds`.
  std::optional<std::string> receive(double seconds) {
    pollfd waiting{socket_.value(), POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(1e3 * seconds)) <= 0) return std::nullopt;
    std::array<char, 65'536> part;
    const ssize_t size = ::recv(socket_.value(), part.data(), part.size(), 0);
    return std::string(part.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  }

  // Same as receive(0), but leaves the bytes to be received.
  std::optional<std::string> peek() {
    std::array<char, 1'024> part;
    const ssize_t size = ::recv(socket_.value(), part.data(), part.size(), MSG_PEEK | MSG_DONTWAIT);
    if (size < 0) return std::nullopt;
    return std::string(part.data(), static_cast<std::size_t>(size));
  }

  // Returns everything until the server closes the connection, or until `seconds` have passed.
  std::string receive_all(double seconds) {
    std::string all;
    const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < limit) {
      const std::optional<std::string> part = receive(seconds);
      if (!part || part->empty()) break;
      all += *part;
    }
    return all;
  }

 private:
  UniqueFd socket_;
};

// The port in "ready: http://127.0.0.1:PORT/", which buoyancy-view prints.
inline std::uint16_t port_from_ready_line(const std::string& standard_output) {
  const std::string mark = "ready: http://127.0.0.1:";
  const std::size_t begin = standard_output.find(mark);
  if (begin == std::string::npos) throw std::runtime_error("no ready line with a port: " + standard_output);
  return static_cast<std::uint16_t>(std::stoul(standard_output.substr(begin + mark.size())));
}

inline std::string get_request(const std::string& path, const std::string& more_headers = "") {
  return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + more_headers + "\r\n";
}

// Reads the snapshots of /events; the constructor connects.
class EventReader {
 public:
  explicit EventReader(std::uint16_t port) : peer_(port) { peer_.send(get_request("/events")); }

  // Returns the next snapshot's JSON; nullopt: none arrived within `seconds`, or the stream ended.
  std::optional<std::string> next(double seconds) {
    const std::string begin = "\ndata: {";
    while (true) {
      const std::size_t from = text_.find(begin);
      const std::size_t to = from == std::string::npos ? from : text_.find("\n\n", from);
      if (to != std::string::npos) {
        std::string snapshot = text_.substr(from + begin.size() - 1, to - from - begin.size() + 1);
        text_.erase(0, to);
        return snapshot;
      }
      const std::optional<std::string> part = peer_.receive(seconds);
      if (!part || part->empty()) return std::nullopt;
      text_ += *part;
    }
  }
  HttpPeer& peer() { return peer_; }

 private:
  HttpPeer peer_;
  std::string text_;
};

}  // namespace buoyancy::view
