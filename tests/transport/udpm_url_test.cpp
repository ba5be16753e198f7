#include "transport/udpm_url.h"

#include <gmock/gmock.h>

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

TEST(UdpmUrl, ParsesAddressPortAndOptions) {
  const auto url = parse_udpm_url("udpm://239.1.2.3:7700?ttl=1&recv_buf_size=65536");
  ASSERT_TRUE(url) << url.error().message();
  EXPECT_EQ(url->group, "239.1.2.3");
  EXPECT_EQ(url->port, 7700);
  EXPECT_EQ(url->ttl, 1);
  EXPECT_EQ(url->recv_buf_size, 65536);
}

TEST(UdpmUrl, UsesDefaultsOfLcm) {
  for (const char* text : {"udpm://", "udpm://?", "udpm://:7667", "udpm://239.255.76.67", "udpm://?ttl=0"}) {
    const auto url = parse_udpm_url(text);
    ASSERT_TRUE(url) << text << ": " << url.error().message();
    EXPECT_EQ(url->group, "239.255.76.67") << text;
    EXPECT_EQ(url->port, 7667) << text;
    EXPECT_EQ(url->ttl, 0) << text;
    EXPECT_FALSE(url->recv_buf_size) << text;
  }
}

TEST(UdpmUrl, ConvertsToStringWithEveryPart) {
  EXPECT_EQ(to_string(parse_udpm_url("udpm://239.1.2.3").value()), "udpm://239.1.2.3:7667?ttl=0");
  const std::string whole = "udpm://239.1.2.3:7700?ttl=1&recv_buf_size=65536";
  EXPECT_EQ(to_string(parse_udpm_url(whole).value()), whole);
}

TEST(UdpmUrl, RejectsUrlsThatLiblcmMisreads) {
  for (const char* text :
       {"", "239.255.76.67:7667", "udpm:/239.255.76.67", "tcpq://127.0.0.1:7700", "file:///tmp/log",
        "udpm://10.0.0.1:7667", "udpm://239.255.76:7667", "udpm://localhost:7667", "udpm://[ff02::1]:7667",
        "udpm://239.255.76.67:", "udpm://239.255.76.67:0", "udpm://239.255.76.67:65536",
        "udpm://239.255.76.67:76a", "udpm://239.255.76.67:7667?ttl=256", "udpm://239.255.76.67:7667?ttl=-1",
        "udpm://239.255.76.67:7667?ttl", "udpm://239.255.76.67:7667?tll=1",
        "udpm://239.255.76.67:7667?recv_buf_size=0", "udpm://239.255.76.67:7667?recv_buf_size=4e6"}) {
    const auto url = parse_udpm_url(text);
    ASSERT_FALSE(url) << text;
    EXPECT_THAT(url.error().message(), HasSubstr("LCM URL '" + std::string(text) + "'"));
  }
}

}  // namespace
}  // namespace buoyancy
