#include "service/daemon/waiting_requests.h"

#include <string>

#include <gtest/gtest.h>

namespace buoyancy::service {
namespace {

using PushResult = WaitingRequests::PushResult;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(WaitingRequests, ReturnsTheFirstOfASessionThatMayGoOn) {
  WaitingRequests waiting(8, 1'000);
  EXPECT_EQ(waiting.push(1, bytes_of("a"), 1.5), PushResult::kQueued);
  EXPECT_EQ(waiting.push(2, bytes_of("b"), 2.5), PushResult::kQueued);
  EXPECT_EQ(waiting.push(2, bytes_of("c"), 3.5), PushResult::kQueued);
  EXPECT_EQ(waiting.push(2, bytes_of("b"), 4.5), PushResult::kRetry);
  std::string popped;
  double arrived = 0.0;
  const auto pop = [&](std::int64_t session) {
    return waiting.pop_next([session](const SessionKey& each, double) { return each == session; },
                            [&](Bytes bytes, double arrival) {
                              popped.assign(bytes.begin(), bytes.end());
                              arrived = arrival;
                            });
  };
  EXPECT_FALSE(pop(3));
  EXPECT_TRUE(pop(2));
  EXPECT_EQ(popped, "b");
  EXPECT_EQ(arrived, 2.5);
  EXPECT_TRUE(waiting.contains(2));
  EXPECT_TRUE(pop(2));
  EXPECT_EQ(popped, "c");
  EXPECT_FALSE(waiting.contains(2));
  EXPECT_TRUE(pop(1));
  EXPECT_TRUE(waiting.empty());
}

TEST(WaitingRequests, BoundsTheirNumberAndMemory) {
  WaitingRequests waiting(2, 10);
  EXPECT_EQ(waiting.push(1, bytes_of("12345678901"), 0.0), PushResult::kFull);
  EXPECT_EQ(waiting.push(1, bytes_of("1234567"), 0.0), PushResult::kQueued);
  EXPECT_EQ(waiting.push(2, bytes_of("1234"), 0.0), PushResult::kFull);
  EXPECT_EQ(waiting.push(2, bytes_of("123"), 0.0), PushResult::kQueued);
  EXPECT_EQ(waiting.push(3, bytes_of(""), 0.0), PushResult::kFull);
  EXPECT_TRUE(waiting.pop_next([](const SessionKey&, double) { return true; }, [](Bytes, double) {}));
  EXPECT_EQ(waiting.push(3, bytes_of("1234567"), 0.0), PushResult::kQueued);
}

}  // namespace
}  // namespace buoyancy::service
