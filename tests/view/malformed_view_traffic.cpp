// Sends malformed requests to a real buoyancy-view and holds connections open (idle, with incomplete
// requests, renewed, or never read) while a page is connected and a service runs. The view must keep serving
// others without delay, and its memory must not grow.
//
//   malformed_view_traffic [--requests N] [--connections N]
//
// Must run in a network namespace with a multicast route (scripts/attack view). Exit status: 0 if the view
// kept serving; 1 if it did not; 2 on invalid arguments.
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

constexpr std::int64_t kMaxGrowth = 4'096;     // [kB]
constexpr double kMaxDelay = 2.0;              // [s]; idle connections time out only after 5 s
constexpr double kUnreadStreamTimeout = 15.0;  // [s], until an unread stream is dropped
constexpr int kStreams = 32;                   // limit of the view
constexpr int kSmallBuffer = 2'048;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool streams(const RunningView& view) {
  return EventReader(view.port()).next(kWaitTimeout).has_value();
}

// True if the page and the first snapshot of a new stream are served at the first attempt within kMaxDelay.
bool serves(const RunningView& view) {
  const auto start = Clock::now();
  HttpPeer peer(view.port());
  peer.send(get_request("/"));
  return peer.receive_all(kWaitTimeout).starts_with("HTTP/1.1 200 ") && streams(view) &&
         seconds_since(start) < kMaxDelay;
}

int fail(const char* message) {
  std::printf("%s\n", message);
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
  const auto send_malformed = [&](int count) {
    for (int i = 0; i < count; ++i) {
      HttpPeer peer(view.port());
      peer.send(malformed.next());
      peer.end_sending();
      peer.receive_all(kWaitTimeout);
      while (page.next(0.0)) {  // keeps reading, so that the view does not drop the page
      }
    }
  };
  send_malformed(1'000);
  hold(1'000);  // uses every thread once
  const std::int64_t before = resident_kb(view.child().pid());
  const auto start = Clock::now();
  send_malformed(requests);
  const double seconds = seconds_since(start);
  if (!serves(view)) return fail("the page is not served after malformed requests");
  std::printf("%d malformed requests in %.1f s; the page is still served\n", requests, seconds);

  hold(connections);
  if (!serves(view)) return fail("the page is not served in time while connections are held");
  for (int i = 0; i < 100; ++i) {
    hold(20);
    if (!serves(view)) return fail("the page is not served in time while connections are renewed");
  }
  std::printf("%d connections held and renewed; page and stream are served in time\n", connections);

  while (page.next(0.0)) {
  }
  std::list<HttpPeer> unread;
  for (int i = 0; i < 2 * kStreams; ++i) {  // twice: streams closed above end with the next snapshot only
    unread.emplace_back(view.port(), kSmallBuffer).send(get_request("/events"));
    if (!page.next(kWaitTimeout)) return fail("a page that reads was dropped while others do not read");
  }
  const auto filled = Clock::now();
  while (!streams(view)) {
    if (seconds_since(filled) > kUnreadStreamTimeout) return fail("unread streams are not dropped");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    while (page.next(0.0)) {
    }
  }
  std::printf("%d unread streams: a new one is served after %.1f s\n", kStreams, seconds_since(filled));
  if (!page.next(kWaitTimeout))
    return fail("the page that was connected first receives no snapshots any more");

  const std::int64_t growth = resident_kb(view.child().pid()) - before;
  std::printf("memory: %" PRId64 " kB, %+" PRId64 " kB\n", before + growth, growth);
  return growth <= kMaxGrowth ? 0 : fail("memory of the view grew");
}

int malformed_view_traffic_main(int argc, char** argv) {
  ToolCommandLine command_line("Sends malformed requests to buoyancy-view", "malformed_view_traffic");
  int requests = 10'000;
  int connections = 100;
  command_line.add_number("--requests", requests, 1, 100'000'000, "Number of malformed requests", true);
  command_line.add_number("--connections", connections, 1, 900, "Number of connections held at a time", true);
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  return run(requests, connections);
}

}  // namespace
}  // namespace buoyancy::view

int main(int argc, char** argv) {
  return buoyancy::view::malformed_view_traffic_main(argc, argv);
}
