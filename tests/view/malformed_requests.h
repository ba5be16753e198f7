// Generates malformed and unusual HTTP requests: one of each kind, then the same with more and more random
// bytes overwritten.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace buoyancy::view {

class MalformedRequests {
 public:
  explicit MalformedRequests(std::uint32_t seed) : random_(seed) {}

  // The sequence depends only on the seed.
  std::string next() {
    std::string request = kinds_[count_ % kinds_.size()];
    const std::size_t corruptions = count_++ / kinds_.size() % kMaxCorruptions;
    for (std::size_t i = 0; i < corruptions && !request.empty(); ++i) {
      request[random_() % request.size()] = static_cast<char>(random_());
    }
    return request;
  }

 private:
  static constexpr std::size_t kMaxCorruptions = 25;

  std::mt19937 random_;
  std::size_t count_ = 0;
  const std::vector<std::string> kinds_{
      "",
      "GET",
      "GET /",
      "GET / HTTP/9.9\r\n",
      "GET  / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
      "get / http/1.1\r\nHost: 127.0.0.1\r\n\r\n",
      "GET / HTTP/1.1\n\n",
      "GET /% HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
      "GET /%zz%u0000 HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
      "GET /" + std::string(9'000, 'a') + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: -1\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n",
      "POST /model HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999999999999999\r\n\r\n",
      "POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nExpect: 100-continue\r\nContent-Length: 5\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nRange: bytes=" + std::string(8'000, '-') + "\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nRange: bytes=9-1,,,\r\n\r\n",
      "GET / HTTP/1.1\r\n: \r\n:\r\nHost\r\n\r\n",
      std::string("GET /\0 HTTP/1.1\r\nHost: \0\r\n\r\n", 28),
      "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
      "\x16\x03\x01\x02\x01\x01\xfc\x03\x03",
  };
};

}  // namespace buoyancy::view
