// Throws requests that are none at a real buoyancy-view, and holds more connections open than it has room
// for, while a page is connected and a service runs: it must serve on, and not grow.
//
//   hostile_view [--requests N] [--connections N]
//
// To be run in a network namespace with a multicast route (scripts/hostile_view). Exit codes: 0 it served on;
// 1 it did not; 2 wrong arguments.
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <list>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "tests/service/memory_of.h"
#include "tests/view/malformed_requests.h"
#include "tests/view/running_view.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kMayGrow = 4'096;  // kB

bool serves(const RunningView& view) {
  HttpPeer peer(view.port());
  peer.send(get_request("/"));
  return peer.receive_all(kPatience).starts_with("HTTP/1.1 200 ");
}

int complain(const char* what) {
  std::printf("%s\n", what);
  return 1;
}

int run(int requests, int connections) {
  const RunningService service;
  RunningView view(kBoxScene);
  EventReader page(view.port());
  MalformedRequests malformed(1);
  const auto throw_some = [&](int count) {
    for (int i = 0; i < count; ++i) {
      HttpPeer peer(view.port());
      peer.send(malformed.next());
      peer.end_sending();
      peer.receive_all(kPatience);
    }
  };
  throw_some(1'000);  // until every thread has been used
  const std::int64_t before = resident_kb(view.child().pid());
  const auto start = std::chrono::steady_clock::now();
  throw_some(requests);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!serves(view)) return complain("after malformed requests the page is not served");
  std::printf("%d malformed requests in %.1f s, and the page is served\n", requests, seconds);

  std::list<HttpPeer> held;
  for (int i = 0; i < connections; ++i) {
    held.emplace_back(view.port()).send(i % 2 == 0 ? get_request("/events") : "GET /mod");
  }
  if (!page.next(kPatience)) return complain("the page that was connected before gets no snapshots any more");
  held.clear();
  if (!serves(view)) return complain("after many connections the page is not served");
  std::printf("%d connections held at a time, the page connected before went on, and the page is served\n",
              connections);

  const std::int64_t grown = resident_kb(view.child().pid()) - before;
  std::printf("memory: %" PRId64 " kB, %+" PRId64 " kB\n", before + grown, grown);
  return grown <= kMayGrow ? 0 : complain("it grew");
}

int hostile_main(int argc, char** argv) {
  CLI::App app("Throws what is no request at buoyancy-view", "hostile_view");
  int requests = 10'000;
  int connections = 100;
  app.add_option("--requests", requests, "Malformed requests")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  app.add_option("--connections", connections, "Connections held at a time")
      ->check(CLI::Range(1, 900))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return run(requests, connections);
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  return buoyancy::hostile_main(argc, argv);
}
