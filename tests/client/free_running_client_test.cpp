#include "client/free_running_client.h"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/client/fake_service.h"

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

}  // namespace
}  // namespace buoyancy
