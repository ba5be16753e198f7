#include "transport/message_limits.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "base/unique_fd.h"

namespace buoyancy {
namespace {

constexpr std::size_t kHundredThousandBodies = 10'800'044;  // [bytes], of a request

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

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
  const Expected<void> rejected = check_message_size("request for 200000 bodies", 21'600'044);
  ASSERT_FALSE(rejected);
  const std::string message = rejected.error().message();
  EXPECT_TRUE(
      message.starts_with("request for 200000 bodies: a message of 21600044 bytes; expected at most "
                          "16777216 bytes"))
      << message;
  EXPECT_TRUE(contains(message, "in 2 requests or more")) << message;
}

TEST(MessageLimits, WarnAboutMessagesLargerThanReceiveBuffer) {
  const ReceiveBuffer buffer{.max_message = 4'194'304};
  EXPECT_FALSE(receive_buffer_warning("request", 4'194'304, "A", buffer));
  const auto warning =
      receive_buffer_warning("request for 100000 bodies", kHundredThousandBodies, "BUOYANCY_STATES", buffer);
  ASSERT_TRUE(warning);
  const std::string message = warning->message();
  EXPECT_TRUE(message.starts_with("request for 100000 bodies: a message of 10800044 bytes in 165 packets"))
      << message;
  EXPECT_TRUE(contains(message, "at most 4194304 bytes")) << message;
  EXPECT_TRUE(contains(message, "sysctl -w net.core.rmem_max=11534336'")) << message;
  EXPECT_TRUE(contains(message, "in 3 requests or more")) << message;
}

TEST(MessageLimits, WarnAboutBufferSizeInUrl) {
  const auto warning =
      receive_buffer_warning("request", kHundredThousandBodies, "A",
                             {.max_message = 65'536, .requested = 65'536, .fixed_by_url = true});
  ASSERT_TRUE(warning);
  EXPECT_TRUE(contains(warning->message(), "recv_buf_size")) << warning->message();
  EXPECT_FALSE(contains(warning->message(), "sysctl")) << warning->message();
  EXPECT_TRUE(contains(warning->message(), "set it to 11534336")) << warning->message();
}

TEST(MessageLimits, NameWhatLimitsReceiveBuffer) {
  const auto limit = [](std::size_t granted, std::size_t requested, bool fixed) {
    return buffer_limit({.max_message = granted, .requested = requested, .fixed_by_url = fixed}, 5'000'000)
        .remedy;
  };
  EXPECT_TRUE(contains(limit(212'992, 5'242'880, false), "sysctl -w net.core.rmem_max=5242880"));
  EXPECT_TRUE(contains(limit(100'000, 100'000, true), "leave recv_buf_size out of the LCM URL"));
  EXPECT_TRUE(contains(limit(212'992, 20'000'000, true), "sysctl -w net.core.rmem_max=5242880"))
      << "the kernel granted less than the URL asks for";
  EXPECT_TRUE(contains(limit(5'242'880, 5'242'880, false), "set recv_buf_size in the LCM URL to more than"));
}

TEST(MessageLimits, WarnAboutMessageOfOnePacket) {
  const auto warning = receive_buffer_warning("response", 3'156, "A", {.max_message = 3'000});
  ASSERT_TRUE(warning);
  EXPECT_TRUE(contains(warning->message(), "in 1 packet, some of which")) << warning->message();
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
