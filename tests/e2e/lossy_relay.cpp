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

constexpr std::chrono::milliseconds kReorderingDelay{12};

enum class Message { kRequest, kCondition, kResponse, kLoads };

std::string channel_of(Message message) {
  if (message == Message::kRequest) return std::string(kStatesChannel);
  if (message == Message::kCondition) return std::string(kConditionChannel);
  return std::string(message == Message::kResponse ? kWrenchesChannel : kLoadsChannel);
}

bool is_for_service(Message message) {
  return message == Message::kRequest || message == Message::kCondition;
}

struct Delayed {
  Message message;
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

struct LossyRelay::Forwarder {
  Forwarder(const RelayOptions& given, LossyRelay& owner)
      : options(given),
        relay(owner),
        client_side(open(given.client_url)),
        service_side(open(given.service_url)),
        random(given.seed) {
    for (const Message message : {Message::kRequest, Message::kCondition}) {
      require(client_side.subscribe(channel_of(message), [this, message](Bytes bytes, std::string_view) {
        forward(message, bytes, message == Message::kRequest ? relay.lost_requests_ : relay.lost_conditions_);
      }));
    }
    for (const Message message : {Message::kResponse, Message::kLoads}) {
      require(service_side.subscribe(channel_of(message), [this, message](Bytes bytes, std::string_view) {
        forward(message, bytes, relay.lost_responses_);
      }));
    }
  }

  void run() {
    while (!relay.stop_) {
      // With a timeout of 1 ms a delayed message is at most a millisecond late.
      std::array<pollfd, 2> waiting{pollfd{client_side.fileno(), POLLIN, 0},
                                    pollfd{service_side.fileno(), POLLIN, 0}};
      poll(waiting.data(), waiting.size(), delayed.empty() ? 20 : 1);
      if (waiting[0].revents != 0) client_side.handle_one();
      if (waiting[1].revents != 0) service_side.handle_one();
      while (!delayed.empty() && delayed.begin()->first <= Clock::now()) {
        send(delayed.begin()->second.message, delayed.begin()->second.bytes);
        delayed.erase(delayed.begin());
      }
    }
  }

  void forward(Message message, Bytes bytes, std::atomic<std::int64_t>& lost) {
    if (happens(options.loss, lost)) return;
    Clock::duration delay{0};
    if (!is_for_service(message)) {
      delay =
          std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.response_delay));
    }
    if (happens(options.duplication, relay.duplicated_)) send_after(delay, message, bytes);
    if (happens(options.reordering, relay.reordered_)) delay += kReorderingDelay;
    send_after(delay, message, bytes);
  }

  bool happens(double probability, std::atomic<std::int64_t>& counter) {
    const bool drawn = probability > 0.0 && std::bernoulli_distribution(probability)(random);
    if (drawn) ++counter;
    return drawn;
  }

  void send_after(Clock::duration delay, Message message, Bytes bytes) {
    if (delay.count() == 0) return send(message, bytes);
    delayed.emplace(Clock::now() + delay, Delayed{message, {bytes.begin(), bytes.end()}});
  }

  void send(Message message, Bytes bytes) {
    LcmConnection& receiver = is_for_service(message) ? service_side : client_side;
    require(receiver.publish(channel_of(message), bytes));
  }

  RelayOptions options;
  LossyRelay& relay;
  LcmConnection client_side;
  LcmConnection service_side;
  std::mt19937_64 random;
  DelayedByTime delayed;
};

LossyRelay::LossyRelay(const RelayOptions& options) {
  auto forwarder = std::make_unique<Forwarder>(options, *this);
  thread_ = std::thread([forwarder = std::move(forwarder)] { forwarder->run(); });
}

LossyRelay::~LossyRelay() {
  stop_ = true;
  thread_.join();
}

}  // namespace buoyancy
