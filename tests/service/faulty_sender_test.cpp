#include "service/daemon/faulty_sender.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace buoyancy::service {
namespace {

constexpr std::uint8_t kValid = 0x5A;  // the first byte of a reply that is not corrupted
constexpr std::size_t kSize = 40;      // [bytes]

// Replies are identified by the time of their arrival, a whole number. The time is the test's own.
class FaultySenderTest : public testing::Test {
 protected:
  struct Sent {
    int number = 0;
    double time = 0.0;
    bool operator==(const Sent&) const = default;
  };

  static Reply reply(int number) {
    std::vector<std::uint8_t> bytes(kSize, kValid);
    return {{{"WRENCHES", bytes}, {"LOADS", bytes}}, static_cast<double>(number)};
  }

  void start(const FaultOptions& options) {
    sender_.emplace(options, 0.0, [this](const Reply& sent) {
      sent_.push_back({static_cast<int>(sent.arrival), now_});
      for (const Reply::Message& message : sent.messages) {
        valid_messages_ += message.bytes.size() == kSize && message.bytes[0] == kValid ? 1 : 0;
      }
    });
  }
  void push(int number) { sender_->push(reply(number), now_); }

  // Lets time pass as an event loop would, until `end`.
  void run_until(double end) {
    for (double next = now_ + sender_->wait(now_); next <= end; next = now_ + sender_->wait(now_)) {
      now_ = std::max(next, std::nextafter(now_, end));
      sender_->send_due(now_);
    }
    now_ = end;
  }

  std::vector<int> numbers() const {
    std::vector<int> all;
    for (const Sent& sent : sent_) all.push_back(sent.number);
    return all;
  }

  double now_ = 0.0;
  std::vector<Sent> sent_;
  int valid_messages_ = 0;
  std::optional<FaultySender> sender_;
};

TEST_F(FaultySenderTest, SendsAtOnceWithoutFaults) {
  start({});
  for (int i = 0; i < 5; ++i) push(i);
  EXPECT_EQ(numbers(), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(sender_->wait(now_), std::numeric_limits<double>::infinity());
  EXPECT_EQ(valid_messages_, 10);
}

TEST_F(FaultySenderTest, SendsAndCountsWhatFatesSay) {
  const FaultOptions options = parse_faults(
                                   "drop=0.1,delay=5ms,jitter=2ms,duplicate=0.05,reorder=0.05,corrupt=0.02,"
                                   "stall=20ms/1s,seed=7")
                                   .value();
  start(options);
  constexpr int kReplies = 10'000;
  FaultCounters expected;
  std::vector<int> copies(kReplies, 0);
  int valid_messages = 0;
  for (int i = 0; i < kReplies; ++i) {
    const Fate fate = draw_fate(options, static_cast<std::uint64_t>(i));
    expected.dropped += fate.dropped ? 1 : 0;
    expected.delayed += fate.dropped ? 0 : 1;
    expected.duplicated += fate.duplicated ? 1 : 0;
    expected.reordered += fate.reordered ? 1 : 0;
    expected.corrupted += fate.corruption != Corruption::kNone ? 1 : 0;
    copies[static_cast<std::size_t>(i)] = fate.dropped ? 0 : fate.duplicated ? 2 : 1;
    if (fate.corruption == Corruption::kNone) valid_messages += 2 * copies[static_cast<std::size_t>(i)];
    push(i);
    run_until(0.001 * (i + 1));
  }
  run_until(10.5);
  for (const Sent& sent : sent_) --copies[static_cast<std::size_t>(sent.number)];
  EXPECT_EQ(copies, std::vector<int>(kReplies, 0));
  EXPECT_EQ(valid_messages_, valid_messages) << "all messages of a reply meet its fate";
  const FaultCounters counters = sender_->counters(now_);
  EXPECT_EQ(counters.dropped, expected.dropped);
  EXPECT_EQ(counters.delayed, expected.delayed);
  EXPECT_EQ(counters.duplicated, expected.duplicated);
  EXPECT_EQ(counters.reordered, expected.reordered);
  EXPECT_EQ(counters.corrupted, expected.corrupted);
  EXPECT_EQ(counters.stalls, 10);
}

TEST_F(FaultySenderTest, DelaysByDelayAndJitter) {
  const FaultOptions options{.delay = 0.005, .jitter = 0.002, .seed = 7};
  start(options);
  for (int i = 0; i < 1000; ++i) {
    push(i);
    run_until(0.001 * (i + 1));
  }
  run_until(2.0);
  ASSERT_EQ(sent_.size(), 1000U);
  EXPECT_TRUE(std::ranges::is_sorted(sent_, {}, &Sent::time));
  EXPECT_FALSE(std::ranges::is_sorted(sent_, {}, &Sent::number)) << "the jitter is longer than the interval";
  for (const Sent& sent : sent_) {
    EXPECT_NEAR(sent.time,
                0.001 * sent.number + draw_fate(options, static_cast<std::uint64_t>(sent.number)).delay,
                1e-9);
  }
}

TEST_F(FaultySenderTest, HoldsReplyBackUntilAfterTheNext) {
  const FaultOptions options{.reorder = 0.2, .seed = 7};
  start(options);
  std::vector<int> expected;
  std::vector<int> held;
  for (int i = 0; i < 1000; ++i) {
    if (draw_fate(options, static_cast<std::uint64_t>(i)).reordered) {
      held.push_back(i);
    } else {
      expected.push_back(i);
      expected.insert(expected.end(), held.begin(), held.end());
      held.clear();
    }
    push(i);
  }
  EXPECT_EQ(numbers(), expected) << "those held back in succession follow in their order";
}

TEST_F(FaultySenderTest, SendsHeldReplyWithoutNextAfterMaxHold) {
  start({.reorder = 1.0, .delay = 0.005});
  push(3);
  run_until(1.0);
  ASSERT_EQ(sent_.size(), 1U);
  EXPECT_NEAR(sent_[0].time, 0.005 + FaultySender::kMaxHold, 1e-9);
}

TEST_F(FaultySenderTest, SendsNothingDuringStallAndAllAfterIt) {
  start({.delay = 0.3, .stall = 1.0, .stall_period = 3.0});
  now_ = 1.6;
  push(0);  // due before the stall
  now_ = 1.9;
  push(1);  // due during the stall
  push(2);
  run_until(2.5);
  EXPECT_TRUE(sender_->is_stalled(now_));
  EXPECT_EQ(numbers(), std::vector<int>{0});
  EXPECT_DOUBLE_EQ(sender_->wait(now_), 0.5);
  run_until(3.1);
  EXPECT_EQ(numbers(), (std::vector<int>{0, 1, 2}));
  EXPECT_NEAR(sent_[1].time, 3.0, 1e-9);
  EXPECT_EQ(sender_->counters(now_).stalls, 1);
}

TEST_F(FaultySenderTest, SendsEarlyInsteadOfKeepingTooMuch) {
  start({.delay = 60.0});
  constexpr int kMore = 10;
  const int kept = static_cast<int>(FaultySender::kMaxWaiting);
  for (int i = 0; i < kept + kMore; ++i) push(i);
  ASSERT_EQ(sent_.size(), static_cast<std::size_t>(kMore));
  EXPECT_EQ(sent_.back(), (Sent{kMore - 1, 0.0})) << "the earliest first";
  sent_.clear();
  start({.delay = 60.0});
  Reply large = reply(7);
  large.messages[0].bytes.resize(FaultySender::kMaxWaitingBytes);
  sender_->push(large, now_);
  EXPECT_EQ(numbers(), std::vector<int>{7});
}

TEST_F(FaultySenderTest, SendsAllThatWaitsAtTheEnd) {
  start({.duplicate = 1.0, .delay = 1.0, .stall = 1.0, .stall_period = 3.0});
  push(0);
  now_ = 2.5;
  push(1);
  sender_->send_all();
  EXPECT_EQ(numbers(), (std::vector<int>{0, 0, 1, 1}));
  sender_->send_all();
  EXPECT_EQ(sent_.size(), 4U);
}

}  // namespace
}  // namespace buoyancy::service
