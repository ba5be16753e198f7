// buoyancyd --inject as its clients see it: every fault at its rate, equal to what the status counts, and the
// same faults for the same seed.
#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "service/daemon/fault_injection.h"
#include "service/daemon/faulty_sender.h"
#include "tests/service/is_binomial.h"
#include "tests/service/running_service.h"
#include "tests/support/byte_vector.h"
#include "tests/support/contains.h"
#include "tests/support/timeouts.h"

namespace buoyancy::service {
namespace {

// Requests on their way at the same time: less than any receive buffer holds. Each is in a session of its
// own, and the next window in others: mode latest supersedes a request of which the response is dropped.
constexpr int kWindow = 30;
constexpr int kSessions = 2 * kWindow;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// What a client receives on the channel of the responses.
struct Observed {
  std::vector<RawBytes> messages;  // in order of arrival
  std::int64_t answered = 0;       // requests with a valid response
  std::int64_t repeated = 0;       // valid responses beyond the first to a request
  std::int64_t reordered = 0;      // first responses that arrived after that to a later request
  std::int64_t cut_short = 0;
  std::int64_t other_fingerprint = 0;
};

class Observer {
 public:
  // Sends requests in windows, and waits after each until all arrived that the fates let arrive.
  Observed observe(const FaultOptions& options, int requests) {
    Observed observed;
    std::map<std::int64_t, int> copies;  // by the number of the request
    std::int64_t latest = -1;
    for (int first = 0; first < requests; first += kWindow) {
      int expected = 0;
      for (int i = first; i < std::min(first + kWindow, requests); ++i) {
        send_request(socket_, one_body(1 + i % kSessions, i, 0.001 * i));
        const Fate fate = draw_fate(options, static_cast<std::uint64_t>(i));
        expected += fate.dropped ? 0 : fate.duplicated ? 2 : 1;
      }
      for (; expected > 0; --expected) {
        std::optional<RawBytes> bytes = receive_bytes(socket_);
        if (!bytes) {
          ADD_FAILURE() << "misses " << expected << " messages after request " << first;
          return observed;
        }
        classify(*bytes, observed, copies, latest);
        observed.messages.push_back(std::move(*bytes));
      }
    }
    observed.answered = static_cast<std::int64_t>(copies.size());
    return observed;
  }

  // Ends the service and returns its last status. The response to the last request must have arrived: the
  // service has then read all of them.
  std::optional<ServiceStatus> end(RunningService& service, int requests) {
    service.child().send_signal(SIGTERM);
    return wait_for_status(
        socket_, [requests](const ServiceStatus& status) { return status.counters.requests == requests; });
  }

 private:
  void classify(const RawBytes& bytes, Observed& observed, std::map<std::int64_t, int>& copies,
                std::int64_t& latest) const {
    if (bytes.size() < whole_size_) {
      ++observed.cut_short;
    } else if (bytes[0] != fingerprint_byte_) {
      ++observed.other_fingerprint;
    } else {
      const std::int64_t number = decoded<WrenchResponse>(bytes).id.seq;
      if (copies[number]++ > 0) {
        ++observed.repeated;
      } else if (number < latest) {
        ++observed.reordered;
      }
      latest = std::max(latest, number);
    }
  }

  RawLcmSocket socket_;
  std::size_t whole_size_ = response_size(1);
  std::uint8_t fingerprint_byte_ = encoded(WrenchResponse{})[0];
};

FaultOptions parsed(const std::string& text) {
  return parse_faults(text).value();
}

class InjectedFaults : public testing::TestWithParam<const char*> {};

TEST_P(InjectedFaults, AreSeenAtTheirRatesAndCounted) {
  const std::string text = "drop=0.1,duplicate=0.05,reorder=0.05,corrupt=0.04,seed=7";
  RunningService service({"--inject", text, "--mode", GetParam()});
  Observer observer;
  constexpr int kRequests = 10'000;
  ASSERT_FALSE(draw_fate(parsed(text), kRequests - 1).dropped);
  const Observed seen = observer.observe(parsed(text), kRequests);
  const auto status = observer.end(service, kRequests);
  ASSERT_TRUE(status);
  const FaultCounters& faults = status->faults;
  EXPECT_EQ(status->counters.computed, kRequests) << "nothing but responses is lost";
  EXPECT_EQ(kRequests - seen.answered, faults.dropped + faults.corrupted);
  EXPECT_EQ(static_cast<std::int64_t>(seen.messages.size()), kRequests - faults.dropped + faults.duplicated);
  EXPECT_EQ(faults.delayed, 0);
  EXPECT_EQ(faults.stalls, 0);

  EXPECT_TRUE(is_binomial(faults.dropped, kRequests, 0.1));
  const std::int64_t sent = kRequests - faults.dropped;
  EXPECT_TRUE(is_binomial(sent - seen.answered, sent, 0.04));
  EXPECT_TRUE(is_binomial(seen.repeated, seen.answered, 0.05));
  EXPECT_TRUE(is_binomial(seen.cut_short, seen.cut_short + seen.other_fingerprint, 0.5));
  // The last response of a window has no next one, after which it could be sent.
  EXPECT_LE(seen.reordered, faults.reordered);
  EXPECT_TRUE(is_binomial(seen.reordered, seen.answered, 0.05));
}

INSTANTIATE_TEST_SUITE_P(Modes, InjectedFaults, testing::Values("lockstep", "latest"),
                         [](const auto& mode) { return std::string(mode.param); });

TEST(InjectedFaults, OfOneKindLeaveEverythingElseAlone) {
  constexpr int kRequests = 800;
  struct Case {
    const char* text;
    std::int64_t FaultCounters::*counter;
  };
  for (const Case& c : {Case{"drop=0.1,seed=3", &FaultCounters::dropped},
                        Case{"duplicate=0.1,seed=3", &FaultCounters::duplicated},
                        Case{"reorder=0.1,seed=3", &FaultCounters::reordered},
                        Case{"corrupt=0.1,seed=3", &FaultCounters::corrupted}}) {
    ASSERT_FALSE(draw_fate(parsed(c.text), kRequests - 1).dropped);
    RunningService service({"--inject", c.text});
    Observer observer;
    const Observed seen = observer.observe(parsed(c.text), kRequests);
    const auto status = observer.end(service, kRequests);
    ASSERT_TRUE(status);
    const FaultCounters& faults = status->faults;
    EXPECT_TRUE(is_binomial(faults.*c.counter, kRequests, 0.1)) << c.text;
    EXPECT_EQ(faults.dropped + faults.duplicated + faults.reordered + faults.corrupted, faults.*c.counter);
    EXPECT_EQ(seen.answered, kRequests - faults.dropped - faults.corrupted) << c.text;
    EXPECT_EQ(seen.repeated, faults.duplicated) << c.text;
    EXPECT_EQ(seen.cut_short + seen.other_fingerprint, faults.corrupted) << c.text;
    EXPECT_LE(seen.reordered, faults.reordered) << c.text;
    EXPECT_EQ(seen.reordered > 0, faults.reordered > 0) << c.text;
  }
}

TEST(InjectedFaults, RepeatForTheSameSeedOnly) {
  const auto messages_for = [](const std::string& seed) {
    const std::string text = "drop=0.2,duplicate=0.2,corrupt=0.2,seed=" + seed;
    const RunningService service({"--inject", text});
    return Observer().observe(parsed(text), 400).messages;
  };
  const std::vector<RawBytes> first = messages_for("7");
  EXPECT_TRUE(messages_for("7") == first);
  EXPECT_FALSE(messages_for("8") == first);
}

TEST(InjectedFaults, DelayEveryResponseWithoutDelayingRequests) {
  RunningService service({"--inject", "delay=100ms,jitter=50ms"});
  RawLcmSocket socket;
  const double start = seconds_now();
  for (int i = 0; i < kWindow; ++i) send_request(socket, one_body(1 + i, i, 0.0));
  std::set<std::int64_t> received;
  for (int i = 0; i < kWindow; ++i) {
    received.insert(receive(socket).id.seq);
    EXPECT_GE(seconds_now() - start, 0.1);
  }
  EXPECT_EQ(received.size(), static_cast<std::size_t>(kWindow));
  service.child().send_signal(SIGTERM);
  const auto status =
      wait_for_status(socket, [](const ServiceStatus& known) { return known.counters.requests == kWindow; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->faults.delayed, kWindow);
  EXPECT_GE(status->latency.p50, 0.1) << "to its publication";
}

TEST(InjectedFaults, StallTheServiceThenAnswerWhatWaited) {
  constexpr double kStall = 0.1;  // [s]
  RunningService service({"--inject", "stall=100ms/250ms"});
  RawLcmSocket socket;
  // Two requests are on their way: one may be read when the stall begins, so that its response waits instead.
  std::int64_t seq = 0;
  for (std::int64_t sent = 0; sent < 2; ++sent) send_request(socket, one_body(1, sent, 0.0));
  // Until a response took as long as most of a stall, and the status says that its request waited unread.
  bool response_waited = false;
  bool request_waited = false;
  double last = seconds_now();
  const double deadline = last + kWaitTimeout;
  while (!(response_waited && request_waited) && last < deadline) {
    const std::optional<RawMessage> message = socket.receive_any(kWaitTimeout);
    ASSERT_TRUE(message);
    ServiceStatus status;
    if (message->channel == "BUOYANCY_STATUS" && !decode(message->payload, status)) {
      request_waited = request_waited || status.queue_wait > 0.5 * kStall;
    }
    if (message->channel != "BUOYANCY_WRENCHES") continue;
    ASSERT_EQ(decoded<WrenchResponse>(message->payload).id.seq, seq++)
        << "every request is answered without a retry";
    const double now = seconds_now();
    response_waited = response_waited || now - last > 0.9 * kStall;
    last = now;
    send_request(socket, one_body(1, seq + 1, 0.0));
  }
  EXPECT_TRUE(response_waited);
  EXPECT_TRUE(request_waited);
  service.child().send_signal(SIGTERM);
  const auto status =
      wait_for_status(socket, [](const ServiceStatus& known) { return known.faults.stalls > 0; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->packets_dropped, 0);
}

TEST(InjectedFaults, MeetResponseAndItsHydrostaticsTogether) {
  const std::string text = "drop=0.3,duplicate=0.3,seed=7";
  const RunningService service({"--inject", text}, kHydrostaticBoxScene);
  RawLcmSocket socket;
  std::map<std::string, std::vector<std::int64_t>> received;  // seqs by channel
  constexpr int kRequests = 100;
  for (int i = 0; i < kRequests; ++i) {
    WrenchRequest states = one_body(1, i, 0.0);
    states.bodies[0].body_id = 2;
    send_request(socket, states);
    const Fate fate = draw_fate(parsed(text), static_cast<std::uint64_t>(i));
    for (int expected = fate.dropped ? 0 : fate.duplicated ? 4 : 2; expected > 0;) {
      const std::optional<RawMessage> message = socket.receive_any(kWaitTimeout);
      ASSERT_TRUE(message);
      if (message->channel == "BUOYANCY_WRENCHES") {
        received[message->channel].push_back(decoded<WrenchResponse>(message->payload).id.seq);
      } else if (message->channel == "BUOYANCY_HYDROSTATICS") {
        received[message->channel].push_back(decoded<BodiesHydrostatics>(message->payload).id.seq);
      } else {
        continue;
      }
      --expected;
    }
  }
  EXPECT_EQ(received["BUOYANCY_WRENCHES"], received["BUOYANCY_HYDROSTATICS"]);
  EXPECT_FALSE(received["BUOYANCY_WRENCHES"].empty());
}

TEST(InjectedFaults, AreAnnouncedInLogAndStatus) {
  RunningService service({"--inject", "seed=9,drop=1,delay=1500us"});
  const std::string log = service.log();
  const std::size_t warning =
      log.find("[warning] injecting faults on purpose: drop=1,delay=1.5ms,seed=9; responses are lost");
  ASSERT_NE(warning, std::string::npos) << log;
  EXPECT_LT(warning, log.find("ready:")) << log;
  EXPECT_TRUE(contains(log, "never use it in production"));
  RawLcmSocket socket;
  for (int i = 0; i < 3; ++i) send_request(socket, one_body(1, i, 0.0));
  const auto status =
      wait_for_status(socket, [](const ServiceStatus& known) { return known.faults.dropped == 3; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->injected_faults, "drop=1,delay=1.5ms,seed=9");
  service.child().send_signal(SIGTERM);
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0);
  EXPECT_TRUE(contains(service.log(),
                       "[warning] injected faults (drop=1,delay=1.5ms,seed=9): 3 responses dropped, 0 "
                       "delayed"));
}

TEST(InjectedFaults, AreAbsentUnlessRequested) {
  RunningService service;
  Observer observer;
  EXPECT_EQ(observer.observe({}, 100).answered, 100);
  const auto status = observer.end(service, 100);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->injected_faults, "");
  const FaultCounters& faults = status->faults;
  EXPECT_EQ(faults.dropped + faults.delayed + faults.duplicated + faults.reordered + faults.corrupted +
                faults.stalls,
            0);
  EXPECT_FALSE(contains(service.log(), "inject"));
}

TEST(InjectedFaults, SendWhatIsDelayedWhenTheServiceEnds) {
  RunningService service({"--inject", "delay=1000s,reorder=0.5"});
  RawLcmSocket socket;
  for (int i = 0; i < 3; ++i) send_request(socket, one_body(1, i, 0.0));
  ASSERT_TRUE(
      wait_for_status(socket, [](const ServiceStatus& status) { return status.faults.delayed == 3; }));
  service.child().send_signal(SIGTERM);
  std::set<std::int64_t> received;
  for (int i = 0; i < 3; ++i) received.insert(receive(socket).id.seq);
  EXPECT_EQ(received, (std::set<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(service.child().wait(kWaitTimeout), 0);
}

}  // namespace
}  // namespace buoyancy::service
