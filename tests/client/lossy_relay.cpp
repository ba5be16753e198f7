#include "tests/client/lossy_relay.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <random>
#include <utility>
#include <vector>

#include <poll.h>

#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

using Clock = std::chrono::steady_clock;

struct Delayed {
  Clock::time_point due;
  std::vector<std::uint8_t> bytes;
};

void require(const Expected<void>& done) {
  if (done) return;
  std::fprintf(stderr, "relay: %s\n", done.error().message().c_str());
  std::abort();
}

LcmConnection open(const std::string& url) {
  Expected<LcmConnection> connection = LcmConnection::open(url);
  if (!connection) require(failure(connection.error()));
  return std::move(*connection);
}

void carry(LcmConnection& client_side, LcmConnection& service_side, std::deque<Delayed>& delayed,
           const std::atomic<bool>& stop) {
  while (!stop) {
    // Due answers are at most a millisecond late.
    std::array<pollfd, 2> waiting{pollfd{client_side.fileno(), POLLIN, 0},
                                  pollfd{service_side.fileno(), POLLIN, 0}};
    poll(waiting.data(), waiting.size(), delayed.empty() ? 20 : 1);
    if (waiting[0].revents != 0) client_side.handle_one();
    if (waiting[1].revents != 0) service_side.handle_one();
    while (!delayed.empty() && delayed.front().due <= Clock::now()) {
      require(client_side.publish(std::string(kWrenchesChannel), delayed.front().bytes));
      delayed.pop_front();
    }
  }
}

}  // namespace

struct LossyRelay::Carrier {
  Carrier(const RelayOptions& options, LossyRelay& relay)
      : client_side(open(options.client_url)), service_side(open(options.service_url)), random(options.seed) {
    const auto delay =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.answer_delay));
    const auto loses = [this, loss = options.loss](std::atomic<std::int64_t>& lost) {
      const bool loses_this = std::bernoulli_distribution(loss)(random);
      if (loses_this) ++lost;
      return loses_this;
    };
    require(client_side.subscribe(std::string(kStatesChannel),
                                  [this, loses, &relay](Bytes bytes, std::string_view) {
                                    if (loses(relay.lost_questions_)) return;
                                    require(service_side.publish(std::string(kStatesChannel), bytes));
                                  }));
    require(service_side.subscribe(
        std::string(kWrenchesChannel), [this, loses, delay, &relay](Bytes bytes, std::string_view) {
          if (loses(relay.lost_answers_)) return;
          if (delay.count() > 0) {
            delayed.push_back({Clock::now() + delay, {bytes.begin(), bytes.end()}});
          } else {
            require(client_side.publish(std::string(kWrenchesChannel), bytes));
          }
        }));
  }

  LcmConnection client_side;
  LcmConnection service_side;
  std::mt19937_64 random;
  std::deque<Delayed> delayed;
};

LossyRelay::LossyRelay(const RelayOptions& options) {
  auto carrier = std::make_unique<Carrier>(options, *this);
  thread_ = std::thread([this, carrier = std::move(carrier)] {
    carry(carrier->client_side, carrier->service_side, carrier->delayed, stop_);
  });
}

LossyRelay::~LossyRelay() {
  stop_ = true;
  thread_.join();
}

}  // namespace buoyancy
