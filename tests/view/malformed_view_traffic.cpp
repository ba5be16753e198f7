// Throws requests that are none at a real buoyancy-view, holds connections open, idle, half asked, renewed or
// never read, while a page is connected and a service runs: it must serve others at once, and not grow.
//
//   malformed_view_traffic [--requests N] [--connections N]
//
// To be run in a network namespace with a multicast route (scripts/attack_view). Exit codes: 0 it served on;
// 1 it did not; 2 wrong arguments.
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <list>
#include <string>
#include <thread>

#include "cli/tool_command_line.h"
#include "tests/support/process_memory.h"
#include "tests/support/timeouts.h"
#include "tests/view/malformed_requests.h"
#include "tests/view/running_view.h"

namespace buoyancy::view {
namespace {

constexpr std::int64_t kMayGrow = 4'096;  // kB
constexpr double kAtOnce = 2.0;           // s; an idle connection would go by itself after 5
constexpr double kUntilDropped = 15.0;    // s, for streams that are not read
constexpr int kStreams = 32;              // that there is room for
constexpr int kSmallBuffer = 2'048;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool streams(const RunningView& view) {
  return EventReader(view.port()).next(kWaitTimeout).has_value();
}

// A page and a new stream's first snapshot, at the first try.
bool serves(const RunningView& view) {
  const auto start = Clock::now();
  HttpPeer peer(view.port());
  peer.send(get_request("/"));
  return peer.receive_all(kWaitTimeout).starts_with("HTTP/1.1 200 ") && streams(view) &&
         seconds_since(start) < kAtOnce;
}

int complain(const char* what) {
  std::printf("%s\n", what);
  return 1;
}

int run(int requests, int connections) {
  const RunningService service;
  RunningView view(kBoxScene);
  EventReader page(view.port());
  std::list<HttpPeer> held;
  const auto hold = [&](int count) {
    for (int i = 0; i < count; ++i) {
      held.emplace_back(view.port()).send(i % 2 == 0 ? "GET /mod" : "");
      if (held.size() > static_cast<std::size_t>(connections)) held.pop_front();
    }
  };
  MalformedRequests malformed(1);
  const auto throw_some = [&](int count) {
    for (int i = 0; i < count; ++i) {
      HttpPeer peer(view.port());
      peer.send(malformed.next());
      peer.end_sending();
      peer.receive_all(kWaitTimeout);
      while (page.next(0.0)) {  // who does not read is dropped
      }
    }
  };
  throw_some(1'000);
  hold(1'000);  // until every thread has been used
  const std::int64_t before = resident_kb(view.child().pid());
  const auto start = Clock::now();
  throw_some(requests);
  const double seconds = seconds_since(start);
  if (!serves(view)) return complain("after malformed requests the page is not served");
  std::printf("%d malformed requests in %.1f s, and the page is served\n", requests, seconds);

  hold(connections);
  if (!serves(view)) return complain("while connections are held the page is not served at once");
  for (int i = 0; i < 100; ++i) {
    hold(20);
    if (!serves(view)) return complain("while connections are renewed the page is not served at once");
  }
  std::printf("%d connections held and renewed, and page and stream are served at once\n", connections);

  while (page.next(0.0)) {
  }
  std::list<HttpPeer> unread;
  for (int i = 0; i < 2 * kStreams; ++i) {  // those that were closed above go with the next snapshot
    unread.emplace_back(view.port(), kSmallBuffer).send(get_request("/events"));
    if (!page.next(kWaitTimeout)) return complain("a page that reads is dropped for others that do not");
  }
  const auto filled = Clock::now();
  while (!streams(view) && seconds_since(filled) < kUntilDropped) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    while (page.next(0.0)) {
    }
  }
  if (!streams(view)) return complain("streams that are not read keep their places");
  std::printf("%d streams that are not read: a new one is served after %.1f s\n", kStreams,
              seconds_since(filled));
  if (!page.next(kWaitTimeout))
    return complain("the page that was connected before gets no snapshots any more");

  const std::int64_t grown = resident_kb(view.child().pid()) - before;
  std::printf("memory: %" PRId64 " kB, %+" PRId64 " kB\n", before + grown, grown);
  return grown <= kMayGrow ? 0 : complain("it grew");
}

int malformed_view_traffic_main(int argc, char** argv) {
  buoyancy::ToolCommandLine command_line("Throws what is no request at buoyancy-view",
                                         "malformed_view_traffic");
  int requests = 10'000;
  int connections = 100;
  command_line.add_number("--requests", requests, 1, 100'000'000, "Malformed requests", true);
  command_line.add_number("--connections", connections, 1, 900, "Connections held at a time", true);
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  return run(requests, connections);
}

}  // namespace
}  // namespace buoyancy::view

int main(int argc, char** argv) {
  return buoyancy::malformed_view_traffic_main(argc, argv);
}
