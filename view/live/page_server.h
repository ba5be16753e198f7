// The HTTP server of the live page: serves a few resources from memory at fixed paths, and snapshots as
// server-sent events. No path leads to a file of the machine.
//
// Everything that a client can use is limited: the number of connections and streams, the size and duration
// of a request's header, the size of what is buffered and the time to read it. Request bodies are never read,
// and a connection carries one request. A client that holds connections cannot lock others out: when all are
// in use, the one that has waited longest for its request is closed. The server only responds to requests
// whose Host is an address or a name of its own, so that a web page of another origin cannot read it through
// a name of that page's (DNS rebinding). Bound to a loopback address, its own are those of the loopback;
// otherwise all addresses and the machine's name too.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "view/live/metrics.h"
#include "view/live/snapshot_broadcaster.h"

namespace buoyancy::view {

struct StaticResource {
  std::string path;          // "/model"
  std::string content_type;  // "application/json"
  std::string body;
};

// Errors: address is not an IPv4 or IPv6 address in numeric form.
Expected<void> check_listen_address(const std::string& address);

struct PageLimits {
  int connections = 256;                  // more than streams; for a further one, an older one is closed
  int streams = 32;                       // of these; never closed for others, further ones get 503
  std::size_t max_header_bytes = 16'384;  // a larger request gets 431
  double header_timeout = 5.0;            // [s]; a slower request gets 408
  double write_timeout =
      5.0;  // [s] to read a chunk, or any part of what is buffered; slower clients are dropped
};

class PageServer {
 public:
  // Listens and serves on threads of its own, which inherit the signal mask. port: 0 selects a free one.
  // "/events" streams from the broadcaster, which must outlive the server. host_names: further names, without
  // ports. metrics: served at "/metrics", and must outlive the server; nullptr: there is no such path.
  // Errors: the port is not available.
  static Expected<std::unique_ptr<PageServer>> start(const std::string& address, int port,
                                                     std::vector<StaticResource> resources,
                                                     SnapshotBroadcaster& broadcaster,
                                                     const PageLimits& limits = {},
                                                     std::vector<std::string> host_names = {},
                                                     const Metrics* metrics = nullptr);
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;
  ~PageServer();  // closes the broadcaster and every connection

  const std::string& url() const { return url_; }  // "http://127.0.0.1:8667/"
  bool serving() const;  // false: accepting connections has failed, nothing will be served any more

 private:
  class Http;
  PageServer(std::unique_ptr<Http> http, std::string url);
  std::unique_ptr<Http> http_;
  std::string url_;
};

}  // namespace buoyancy::view
