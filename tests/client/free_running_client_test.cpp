#include "client/free_running_client.h"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/client/fake_service.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

TEST(FreeRunningClient, ReturnsNewestResponseAndCountsItsLag) {
  // Responds to request 0, and from then on to the request three before: the lag is three.
  const FakeService service([](const WrenchRequest& request) {
    WrenchRequest earlier = request;
    if (request.id.seq != 0) earlier.id.seq -= 3;
    return Responses{{1, 2, 3}, encoded(response_to(earlier, static_cast<double>(earlier.id.seq)))};
  });
  FreeRunningClient client(open_channel(), kTestRetryPolicy, 0.05);
  for (std::int64_t seq = 0; seq <= 10; ++seq) {
    const Expected<const WrenchResponse*> response = client.request(make_request(seq));
    ASSERT_TRUE(response) << response.error().message();
    EXPECT_LE((*response)->id.seq, std::max<std::int64_t>(0, seq - 3));
  }
  const ClientStats statistics = client.statistics();
  EXPECT_EQ(statistics.requests, 11);
  EXPECT_EQ(statistics.late, 10);
  EXPECT_GE(statistics.max_lag, 3);
  EXPECT_GE(statistics.unanswered, 3);
  EXPECT_GE(statistics.malformed, 1);
}

// The service answers after pauses of 0.4 s, and then no more.
TEST(FreeRunningClient, FailsOnlyAfterOneSilenceLongerThanItsRetries) {
  constexpr std::int64_t kPause = 8;
  constexpr std::int64_t kLast = 40;
  const FakeService service([](const WrenchRequest& request) {
    if (request.id.seq % kPause != 0 || request.id.seq > kLast) return Responses{};
    return Responses{encoded(response_to(request, static_cast<double>(request.id.seq)))};
  });
  FreeRunningClient client(open_channel(), {.timeout = 0.4, .max_retries = 4}, 0.05);
  std::int64_t seq = 0;
  for (; seq <= kLast; ++seq) {
    const Expected<const WrenchResponse*> response = client.request(make_request(seq));
    ASSERT_TRUE(response) << "after " << 0.05 * static_cast<double>(seq)
                          << " s of pauses, each of 0.4 s: " << response.error().message();
    EXPECT_LE((*response)->id.seq, seq);
  }
  Expected<const WrenchResponse*> response = client.request(make_request(seq));
  while (response && seq < 10 * kLast) response = client.request(make_request(++seq));
  ASSERT_FALSE(response);
  EXPECT_GE(seq - kLast, 38) << "2 s";
  EXPECT_TRUE(contains(response.error().message(), "no response for"));
}

}  // namespace
}  // namespace buoyancy
