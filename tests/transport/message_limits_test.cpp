#include "transport/message_limits.h"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <sys/socket.h>

#include "base/unique_fd.h"

namespace buoyancy {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::size_t kHundredThousandBodies = 10'800'044;  // [bytes], of a request

TEST(MessageLimits, CountsPacketsOfLcm) {
  // liblcm's limits include the channel name and its NUL; LcmConnection's tests compare with liblcm.
  EXPECT_EQ(packet_count(0, "A"), 1U);
  EXPECT_EQ(packet_count(65'497, "A"), 1U);
  EXPECT_EQ(packet_count(65'498, "A"), 2U);
  EXPECT_EQ(packet_count(2 * 65'487 - 2, "A"), 2U);
  EXPECT_EQ(packet_count(2 * 65'487 - 1, "A"), 3U);
  EXPECT_EQ(packet_count(kHundredThousandBodies, "BUOYANCY_STATES"), 165U);
}

TEST(MessageLimits, RejectMessagesThatNoReceiverAccepts) {
  EXPECT_TRUE(check_message_size("request", kMaxMessageBytes));
  EXPECT_FALSE(check_message_size("request", kMaxMessageBytes + 1));
  const Expected<void> rejected = check_message_size("request for 200000 bodies", 21'600'044);
  ASSERT_FALSE(rejected);
  EXPECT_THAT(rejected.error().message(),
              AllOf(StartsWith("request for 200000 bodies: a message of 21600044 bytes; expected at most "
                               "16777216 bytes"),
                    HasSubstr("in 2 requests or more")));
}

std::string warning(const std::string& what, std::size_t bytes, const std::string& channel,
                    const ReceiveBuffer& buffer) {
  const auto warning = receive_buffer_warning(what, bytes, channel, buffer);
  return warning ? warning->message() : "";
}

TEST(MessageLimits, WarnAboutMessagesLargerThanReceiveBuffer) {
  const ReceiveBuffer buffer{.max_message = 4'194'304};
  EXPECT_EQ(warning("request", 4'194'304, "A", buffer), "");
  EXPECT_NE(warning("request", 4'194'305, "A", buffer), "");
  EXPECT_THAT(warning("request for 100000 bodies", kHundredThousandBodies, "BUOYANCY_STATES", buffer),
              AllOf(StartsWith("request for 100000 bodies: a message of 10800044 bytes in 165 packets"),
                    HasSubstr("at most 4194304 bytes"), HasSubstr("sysctl -w net.core.rmem_max=11534336'"),
                    HasSubstr("in 3 requests or more")));
  EXPECT_THAT(warning("request", kHundredThousandBodies, "A",
                      {.max_message = 65'536, .requested = 65'536, .fixed_by_url = true}),
              AllOf(HasSubstr("recv_buf_size"), Not(HasSubstr("sysctl")), HasSubstr("set it to 11534336")));
  EXPECT_THAT(warning("response", 3'156, "A", {.max_message = 3'000}),
              HasSubstr("in 1 packet, some of which"));
}

TEST(MessageLimits, NameWhatLimitsReceiveBuffer) {
  const auto limit = [](std::size_t granted, std::size_t requested, bool fixed) {
    return buffer_limit({.max_message = granted, .requested = requested, .fixed_by_url = fixed}, 5'000'000)
        .remedy;
  };
  EXPECT_THAT(limit(212'992, 5'242'880, false), HasSubstr("sysctl -w net.core.rmem_max=5242880"));
  EXPECT_THAT(limit(100'000, 100'000, true), HasSubstr("leave recv_buf_size out of the LCM URL"));
  EXPECT_THAT(limit(212'992, 20'000'000, true), HasSubstr("sysctl -w net.core.rmem_max=5242880"))
      << "the kernel granted less than the URL asks for";
  EXPECT_THAT(limit(5'242'880, 5'242'880, false), HasSubstr("set recv_buf_size in the LCM URL to more than"));
}

TEST(MessageLimits, AskForBufferThatHoldsMessage) {
  EXPECT_EQ(receive_buffer_for(0), kMinReceiveBuffer);
  EXPECT_EQ(receive_buffer_for(kMinReceiveBuffer), kMinReceiveBuffer);
  EXPECT_GE(receive_buffer_for(kHundredThousandBodies), kHundredThousandBodies);
}

TEST(MessageLimits, ReportBufferThatKernelGrants) {
  // Half of the default is granted to everybody.
  const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ASSERT_TRUE(socket.valid());
  EXPECT_EQ(set_receive_buffer(socket.value(), 50'000), 50'000U);
  EXPECT_EQ(grantable_receive_buffer(50'000), 50'000U);
  EXPECT_GT(grantable_receive_buffer(std::numeric_limits<std::size_t>::max()), 50'000U) << "no overflow";
  EXPECT_EQ(set_receive_buffer(-1, 50'000), 0U);
}

}  // namespace
}  // namespace buoyancy
