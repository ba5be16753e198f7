// Sends a running buoyancyd what is meant to exhaust it, and reports what honest clients see meanwhile.
//
//   hostile_requests [--seconds S] [--only NAME]
//
// For each attack a service is started, and a client measures it alone. Then, for S seconds (default 5), an
// attacker sends while honest clients go on: one with requests of one body, or of 1,000. At the end the
// service gets SIGTERM while it is under attack. The table has a row for each attack: the honest requests
// that were answered and that were lost for good; the 99th percentile of their round trips, alone and under
// attack; how much memory the service took on; the longest delay of its watchdog; and how long SIGTERM took.
//
// Run it in a network namespace with a multicast route (scripts/attack requests). Exit status: 0 if every
// honest request was answered and each column is within its limit; 1 if not; 2 on invalid arguments.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/unique_fd.h"
#include "cli/tool_command_line.h"
#include "client/client.h"
#include "service/daemon/budgets.h"
#include "tests/service/running_service.h"
#include "tests/support/process_memory.h"

namespace buoyancy {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kWarmUp = 300;       // requests
constexpr std::int64_t kAlone = 1'000;      // requests
constexpr double kMaxStop = 0.2;            // [s], until a signal or the watchdog has its turn
constexpr double kWatchdogInterval = 0.05;  // [s]
constexpr std::int64_t kMaxGrowth = 512
                                    << 10;  // [kB], the sum of the budgets and what sockets and buffers take

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// What systemd would be: measures the longest time between two notifications of the watchdog.
class Watchdog {
 public:
  Watchdog() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::snprintf(address.sun_path, sizeof address.sun_path, "%s", path_.c_str());
    if (::bind(socket_.value(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("no socket for the watchdog");
    }
    thread_ = std::jthread([this](const std::stop_token& stop) { listen(stop); });
  }

  std::vector<std::string> environment() const {
    return {"NOTIFY_SOCKET=" + path_,
            "WATCHDOG_USEC=" + std::to_string(static_cast<int>(2 * kWatchdogInterval * 1e6))};
  }
  void restart() {
    longest_ = 0.0;
    last_ = Clock::now().time_since_epoch().count();  // the time before was that of the start
  }
  // Beyond the interval, until now.
  double longest_delay() const {
    const double since_last = seconds_since(Clock::time_point(Clock::duration(last_)));
    return std::max(0.0, std::max<double>(longest_, since_last) - kWatchdogInterval);
  }

 private:
  void listen(const std::stop_token& stop) {
    const timeval timeout{.tv_sec = 0, .tv_usec = 50'000};
    ::setsockopt(socket_.value(), SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    while (!stop.stop_requested()) {
      std::array<char, 512> text{};
      if (::recv(socket_.value(), text.data(), text.size() - 1, 0) <= 0) continue;
      if (std::string(text.data()).find("WATCHDOG=1") == std::string::npos) continue;
      longest_ = std::max<double>(longest_, seconds_since(Clock::time_point(Clock::duration(last_))));
      last_ = Clock::now().time_since_epoch().count();
    }
  }

  TempDir directory_;
  std::string path_ = directory_.path("notify");
  UniqueFd socket_;
  std::atomic<double> longest_{0.0};
  std::atomic<Clock::rep> last_{Clock::now().time_since_epoch().count()};
  std::jthread thread_;
};

struct Honest {
  std::int64_t answered = 0, lost = 0, retries = 0;
  std::vector<double> round_trips;  // [s]

  double p99() const {
    std::vector<double> sorted = round_trips;
    if (sorted.empty()) return 0.0;
    const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 99 / 100);
    std::ranges::nth_element(sorted, place);
    return *place;
  }
};

// A lock-step client with the default retries.
Honest run_client(std::size_t bodies, const std::function<bool(std::int64_t)>& goes_on) {
  Expected<Client> client = Client::open();
  if (!client) throw std::runtime_error(client.error().message());
  Honest honest;
  std::vector<BodyState> states(bodies);
  for (std::int64_t n = 1; goes_on(n); ++n) {
    for (BodyState& state : states) {
      state = {.body_id = 1,
               .position = {0.0, 0.0, 0.001 * static_cast<double>(n % 500)},
               .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0},
               .linear_velocity = {},
               .angular_velocity = {}};
    }
    const Clock::time_point start = Clock::now();
    const auto response = client->request(n, states);
    honest.round_trips.push_back(seconds_since(start));
    ++(response ? honest.answered : honest.lost);
  }
  honest.retries = client->statistics().retries;
  return honest;
}

struct Attack {
  const char* name;
  const char* sends;
  std::string scene;
  std::size_t honest_bodies;
  // Sends until it is told to stop. n: 0, 1, ...
  std::function<void(RawLcmSocket&, std::int64_t n)> send;
  double pause;                 // [s], between two of them
  std::int32_t heavy_body = 0;  // whose computation is not divided; 0: none takes long
};

RawBytes request_of(std::int32_t body, std::size_t bodies, std::int64_t session, std::int64_t seq) {
  WrenchRequest states = one_body(session, seq, 0.1);
  states.bodies[0].body_id = body;
  states.bodies.resize(bodies, states.bodies[0]);
  for (std::size_t i = 0; i < bodies; ++i)
    states.bodies[i].position[2] = 1e-4 * static_cast<double>(i % 1'000);
  return encoded(states);
}

// Sends a message so slowly that the service can read it with the smallest receive buffer.
void send_slowly(RawLcmSocket& socket, const RawBytes& message, std::int64_t n) {
  constexpr std::size_t kFragment = 65'000;
  const std::size_t count = (message.size() + kFragment - 1) / kFragment;
  for (std::size_t i = 0; i < count; ++i) {
    RawWriter packet;
    packet.int32(0x4c433033)
        .int32(static_cast<std::int32_t>(n))
        .int32(static_cast<std::int32_t>(message.size()));
    packet.int32(static_cast<std::int32_t>(i * kFragment));
    packet.int16(static_cast<std::int16_t>(i)).int16(static_cast<std::int16_t>(count));
    if (i == 0) {
      for (const char c : std::string("BUOYANCY_STATES"))
        packet.bytes.push_back(static_cast<std::uint8_t>(c));
      packet.bytes.push_back(0);
    }
    const auto begin = message.begin() + static_cast<std::ptrdiff_t>(i * kFragment);
    packet.bytes.insert(
        packet.bytes.end(), begin,
        begin + static_cast<std::ptrdiff_t>(std::min(kFragment, message.size() - i * kFragment)));
    socket.send_packet(packet.bytes);
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

// The first fragment of a message of 16 MB, of which no other is sent: from a socket of its own each time.
void send_forged_fragment(std::int64_t n) {
  RawLcmSocket sender;
  RawWriter packet;
  packet.int32(0x4c433033).int32(static_cast<std::int32_t>(n)).int32(16 << 20).int32(0);
  packet.int16(0).int16(-1);
  for (const char c : std::string("BUOYANCY_STATES")) packet.bytes.push_back(static_cast<std::uint8_t>(c));
  packet.bytes.push_back(0);
  packet.bytes.push_back(0);
  sender.send_packet(packet.bytes);
}

std::string many_boxes(int count) {
  std::string scene = kTestWater;
  for (int id = 1; id <= count; ++id) {
    scene += "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\" }\n";
  }
  return scene;
}

RawBytes request_of_all(int bodies, std::int64_t session, std::int64_t seq) {
  WrenchRequest states = one_body(session, seq, 0.1);
  states.bodies.resize(static_cast<std::size_t>(bodies), states.bodies[0]);
  for (int i = 0; i < bodies; ++i) states.bodies[static_cast<std::size_t>(i)].body_id = i + 1;
  return encoded(states);
}

std::vector<Attack> attacks() {
  constexpr int kManyBodies = 40'000;
  const std::string light = "[[body]]\nid = 1\nshape = { type = \"box\" }\n";
  const std::string heavy_in_waves =
      "[[body]]\nid = 2\nshape = { type = \"rock\", frequency = 55 }\ntolerance = 1e-6\n";
  const std::string waves =
      "[water.waves]\ntype = \"jonswap\"\nsignificant_wave_height = 1.0\npeak_period = 5.0\n";
  const std::string short_waves =
      "[water.waves]\ntype = \"jonswap\"\nsignificant_wave_height = 0.3\npeak_period = 2.0\nfrequencies = "
      "4096\n"
      "cutoff = 6.0\n";
  return {
      {"R1", "150,000 times one id, 16 MB, 64 sessions", kTestWater + light, 1,
       [](RawLcmSocket& socket, std::int64_t n) {
         static RawBytes request = request_of(1, 150'000, 0, 0);
         request[23] = static_cast<std::uint8_t>(n % 64);  // the session
         send_slowly(socket, request, n);
       },
       0.3},
      {"R1, legal", "40,000 bodies of the scene, 4 MB, 64 sessions", many_boxes(kManyBodies), 1,
       [](RawLcmSocket& socket, std::int64_t n) {
         socket.send("BUOYANCY_STATES", request_of_all(kManyBodies, 1'000 + n % 64, n));
       },
       0.02},
      {"R2", "3,000 times a body of 60,500 triangles in waves, 1e-6",
       kTestWater + waves + light + heavy_in_waves, 1,
       [](RawLcmSocket& socket, std::int64_t n) {
         socket.send("BUOYANCY_STATES", request_of(2, 3'000, 1'000 + n % 4, n));
       },
       0.25, 2},
      {"R7", "1,000 forged fragments a second", kTestWater + light, 1'000,
       [](RawLcmSocket& /*socket*/, std::int64_t n) { send_forged_fragment(n); }, 0.001},
      {"R11", "100 times a body in 4,096 short waves", kTestWater + short_waves + light + heavy_in_waves, 1,
       [](RawLcmSocket& socket, std::int64_t n) {
         socket.send("BUOYANCY_STATES", request_of(2, 100, 1'000 + n % 4, n));
       },
       0.25, 2},
  };
}

// How long the service takes for one body alone [s]: the slice that others wait for is that much longer.
double time_of_body(std::int32_t body) {
  if (body == 0) return 0.0;
  RawLcmSocket socket;
  double longest = 0.0;
  for (std::int64_t seq = 1; seq <= 5; ++seq) {
    const Clock::time_point start = Clock::now();
    socket.send("BUOYANCY_STATES", request_of(body, 1, 999, seq));
    receive(socket);
    longest = std::max(longest, seconds_since(start));
  }
  return longest;
}

const char* mark(bool holds) {
  return holds ? "" : "!";
}

bool run(const Attack& attack, double seconds) {
  Watchdog watchdog;
  RunningService service({}, attack.scene, watchdog.environment());
  run_client(attack.honest_bodies, [](std::int64_t n) { return n <= kWarmUp; });
  const Honest alone = run_client(attack.honest_bodies, [](std::int64_t n) { return n <= kAlone; });
  const double body = time_of_body(attack.heavy_body);
  const std::int64_t before = resident_kb(service.child().pid());
  std::atomic<std::int64_t> sent{0};
  std::int64_t peak = before;
  watchdog.restart();
  Honest honest;
  double delay = 0.0;
  double stop = 0.0;
  {
    const std::jthread attacker([&](const std::stop_token& stopped) {
      RawLcmSocket socket;
      for (Clock::time_point next = Clock::now(); !stopped.stop_requested(); ++sent) {
        attack.send(socket, sent);
        next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(attack.pause));
        std::this_thread::sleep_until(next);
      }
    });
    const Clock::time_point start = Clock::now();
    honest = run_client(attack.honest_bodies, [&](std::int64_t n) {
      if (n % 16 == 0) peak = std::max(peak, resident_kb(service.child().pid()));
      return seconds_since(start) < seconds;
    });
    delay = watchdog.longest_delay();
    const Clock::time_point signalled = Clock::now();
    service.child().send_signal(SIGTERM);
    service.child().wait(kWaitTimeout);
    stop = seconds_since(signalled);
  }
  const double slice = std::chrono::duration<double>(service::kSlice).count() + body;
  const bool answers = honest.lost == 0 && honest.answered > 0;
  const bool is_fast = attack.honest_bodies > 1 || honest.p99() <= 3.0 * alone.p99() + slice;
  const bool is_small = peak - before <= kMaxGrowth;
  const bool watches = delay <= kMaxStop;
  const bool stops = stop <= kMaxStop;
  std::printf("%-10s %-54s %6" PRId64 " %8" PRId64 "%s %7" PRId64 " %5" PRId64
              " %6.1f %8.2f %8.2f%s %8.1f%s %8.0f%s %8.0f%s\n",
              attack.name, attack.sends, sent.load(), honest.answered, mark(answers), honest.retries,
              honest.lost, 1e3 * body, 1e3 * alone.p99(), 1e3 * honest.p99(), mark(is_fast),
              static_cast<double>(peak - before) / 1024.0, mark(is_small), 1e3 * delay, mark(watches),
              1e3 * stop, mark(stops));
  std::fflush(stdout);
  return answers && is_fast && is_small && watches && stops;
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  using namespace buoyancy;
  std::int64_t seconds = 5;
  std::string only;
  ToolCommandLine command_line("Send a running buoyancyd what is meant to exhaust it", "hostile_requests");
  command_line.add_number("--seconds", seconds, std::int64_t{1}, std::int64_t{600},
                          "Duration of each attack [s]");
  command_line.add_option("--only", only, "Only the attack of this name, such as R7");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  try {
    std::printf("%-10s %-54s %6s %8s %7s %5s %6s %8s %8s %8s %8s %8s\n", "attack", "the attacker sends",
                "sent", "answered", "retries", "lost", "body", "p99 [ms]", "attacked", "MB", "watchdog",
                "SIGTERM");
    bool holds = true;
    for (const Attack& attack : attacks()) {
      if (only.empty() || only == attack.name) holds = run(attack, static_cast<double>(seconds)) && holds;
    }
    return holds ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hostile_requests: %s\n", error.what());
    return 1;
  }
}
