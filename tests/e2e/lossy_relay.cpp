#include "tests/e2e/lossy_relay.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <poll.h>

#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kReorderedBy{12};

enum class Toward { kService, kClient };

struct Delayed {
  Toward toward;
  std::vector<std::uint8_t> bytes;
};
using DelayedByTime = std::multimap<Clock::time_point, Delayed>;

void require(const Expected<void>& done) {
  if (done) return;
  std::fprintf(stderr, "relay: %s\n", done.error().message().c_str());
  std::abort();
}

LcmConnection open(const std::string& url) {
  Expected<LcmConnection> connection = LcmConnection::open(url);
  if (!connection) require(make_error(connection.error()));
  return std::move(*connection);
}

}  // namespace

struct LossyRelay::Carrier {
  Carrier(const RelayOptions& given, LossyRelay& owner)
      : options(given),
        relay(owner),
        client_side(open(given.client_url)),
        service_side(open(given.service_url)),
        random(given.seed) {
    require(client_side.subscribe(std::string(kStatesChannel), [this](Bytes bytes, std::string_view) {
      carry(Toward::kService, bytes, relay.lost_requests_);
    }));
    require(service_side.subscribe(std::string(kWrenchesChannel), [this](Bytes bytes, std::string_view) {
      carry(Toward::kClient, bytes, relay.lost_responses_);
    }));
  }

  void run() {
    while (!relay.stop_) {
      // What is due is at most a millisecond late.
      std::array<pollfd, 2> waiting{pollfd{client_side.fileno(), POLLIN, 0},
                                    pollfd{service_side.fileno(), POLLIN, 0}};
      poll(waiting.data(), waiting.size(), delayed.empty() ? 20 : 1);
      if (waiting[0].revents != 0) client_side.handle_one();
      if (waiting[1].revents != 0) service_side.handle_one();
      while (!delayed.empty() && delayed.begin()->first <= Clock::now()) {
        pass_on(delayed.begin()->second.toward, delayed.begin()->second.bytes);
        delayed.erase(delayed.begin());
      }
    }
  }

  void carry(Toward toward, Bytes bytes, std::atomic<std::int64_t>& lost) {
    if (happens(options.loss, lost)) return;
    Clock::duration delay{0};
    if (toward == Toward::kClient) {
      delay =
          std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.response_delay));
    }
    if (happens(options.duplication, relay.duplicated_)) pass_on_after(delay, toward, bytes);
    if (happens(options.reordering, relay.reordered_)) delay += kReorderedBy;
    pass_on_after(delay, toward, bytes);
  }

  bool happens(double probability, std::atomic<std::int64_t>& counter) {
    const bool does = probability > 0.0 && std::bernoulli_distribution(probability)(random);
    if (does) ++counter;
    return does;
  }

  void pass_on_after(Clock::duration delay, Toward toward, Bytes bytes) {
    if (delay.count() == 0) return pass_on(toward, bytes);
    delayed.emplace(Clock::now() + delay, Delayed{toward, {bytes.begin(), bytes.end()}});
  }

  void pass_on(Toward toward, Bytes bytes) {
    require(toward == Toward::kService ? service_side.publish(std::string(kStatesChannel), bytes)
                                       : client_side.publish(std::string(kWrenchesChannel), bytes));
  }

  RelayOptions options;
  LossyRelay& relay;
  LcmConnection client_side;
  LcmConnection service_side;
  std::mt19937_64 random;
  DelayedByTime delayed;
};

LossyRelay::LossyRelay(const RelayOptions& options) {
  auto carrier = std::make_unique<Carrier>(options, *this);
  thread_ = std::thread([carrier = std::move(carrier)] { carrier->run(); });
}

LossyRelay::~LossyRelay() {
  stop_ = true;
  thread_.join();
}

}  // namespace buoyancy
