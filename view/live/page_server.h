// The HTTP server of the live page: a few texts from memory at fixed paths, and snapshots as server-sent
// events. No path of the machine can be asked for: there is no file behind any address.
//
// Bounded on every side, since whoever reaches the port may send anything: connections and streams at a time,
// bytes and time of a request's head, bytes and time for what was written to be taken; bodies are never read,
// a connection carries one request. Who holds connections keeps nobody out: where all places are taken, the
// one that has waited longest for its request gives way. Bound to a loopback address it answers only requests
// whose Host names the loopback, so that no web page of somebody else's can read it under a name of its own
// (DNS rebinding).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "view/live/snapshot_broadcaster.h"

namespace buoyancy {

struct StaticResource {
  std::string path;          // "/model"
  std::string content_type;  // "application/json"
  std::string body;
};

// Is address an IPv4 or IPv6 address, in digits?
Expected<void> check_listen_address(const std::string& address);

struct PageLimits {
  int connections = 256;  // at a time, more than streams; a further one has an older one closed
  int streams = 32;       // of these, never closed for others; further ones get 503
  std::size_t max_header_bytes = 16'384;  // a larger request gets 431
  double header_timeout = 5.0;            // s; a slower request gets 408
  double write_timeout = 5.0;  // s for a chunk, or for any of what waits; a slower reader is dropped
};

class PageServer {
 public:
  // Listens and serves from threads of its own, which inherit the signal mask. port: 0 for any that is free.
  // "/events" is the hub's. Errors: the port cannot be had.
  static Expected<std::unique_ptr<PageServer>> start(const std::string& address, int port,
                                                     std::vector<StaticResource> texts,
                                                     SnapshotBroadcaster& hub, const PageLimits& limits = {});
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;
  ~PageServer();  // closes the hub and every connection

  const std::string& url() const { return url_; }  // "http://127.0.0.1:8667/"
  bool serving() const;  // false: the kernel gives no more connections, nothing will be served again

 private:
  class Http;
  PageServer(std::unique_ptr<Http> http, std::string url);
  std::unique_ptr<Http> http_;
  std::string url_;
};

}  // namespace buoyancy
