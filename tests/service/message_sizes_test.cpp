#include "service/daemon/message_sizes.h"

#include <string>

#include <gtest/gtest.h>

#include "messages/wire.h"
#include "service/daemon/daemon.h"
#include "tests/engine/box_scene.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"

namespace buoyancy::service {
namespace {

Scene boxes(int bodies, const std::string& more = "") {
  std::string text;
  for (int id = 1; id <= bodies; ++id) {
    text +=
        "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = [1, 1, 1] }\n" + more;
  }
  return scene_of(text);
}

const std::string kHydrostatics = "outputs = [\"wrench\", \"hydrostatics\"]\n";
const std::string kLoads = "outputs = [\"wrench\", \"loads\"]\n";
const ReceiveBuffer kAnyBuffer{.max_message = kMaxMessageBytes};

template <typename Message>
std::size_t size_of_encoded(std::size_t bodies) {
  Message message;
  message.bodies.resize(bodies);
  return encoded(message).size();
}

TEST(MessageSizes, AreThoseOfEncodedMessages) {
  const LargestMessages messages = largest_messages(boxes(1'000), {});
  EXPECT_EQ(messages.request.bytes, size_of_encoded<WrenchRequest>(1'000));
  EXPECT_EQ(messages.request.packets, 2U);
  EXPECT_EQ(messages.response.bytes, size_of_encoded<WrenchResponse>(1'000));
  EXPECT_FALSE(messages.hydrostatics);
  EXPECT_FALSE(messages.loads);
  const LargestMessages more = largest_messages(boxes(200, kHydrostatics), {});
  ASSERT_TRUE(more.hydrostatics);
  EXPECT_EQ(more.hydrostatics->bytes, size_of_encoded<BodiesHydrostatics>(200));
  EXPECT_EQ(more.hydrostatics->packets, 2U);
  const LargestMessages with_loads = largest_messages(boxes(200, kLoads), {});
  ASSERT_TRUE(with_loads.loads);
  EXPECT_EQ(with_loads.loads->bytes, size_of_encoded<BodiesLoads>(200));
  EXPECT_EQ(with_loads.loads->packets, 3U);
  EXPECT_EQ(with_loads.loads->channel, "BUOYANCY_LOADS");
}

TEST(MessageSizes, WarnAboutRequestsThatDoNotFitReceiveBuffer) {
  const LargestMessages messages = largest_messages(boxes(1'000), {});
  EXPECT_TRUE(size_warnings(messages, {.max_message = messages.request.bytes}).empty());
  const auto warnings = size_warnings(messages, {.max_message = messages.request.bytes - 1});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(
      warnings[0].message().starts_with("request for all 1000 bodies: a message of 108044 bytes in 2 "
                                        "packets"))
      << warnings[0].message();
}

TEST(MessageSizes, WarnAboutMessagesThatNoReceiverAccepts) {
  LargestMessages messages = largest_messages(boxes(3), {});
  messages.request = {.subject = "request for all 160000 bodies", .channel = "A", .bytes = 17'280'044};
  messages.hydrostatics = {.subject = "hydrostatics", .channel = "B", .bytes = 16'900'000};
  messages.loads = {.subject = "loads", .channel = "C", .bytes = 16'900'000};
  const auto warnings = size_warnings(messages, kAnyBuffer);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_TRUE(
      warnings[0].message().starts_with("request for all 160000 bodies: a message of 17280044 bytes; "
                                        "expected at most 16777216"))
      << warnings[0].message();
  EXPECT_TRUE(warnings[1].message().starts_with("hydrostatics: ")) << warnings[1].message();
  EXPECT_TRUE(warnings[2].message().starts_with("loads: ")) << warnings[2].message();
}

TEST(MessageSizes, PredictReceiveBufferFromUrl) {
  const LargestMessages messages = largest_messages(boxes(3), {});
  EXPECT_FALSE(expected_receive_buffer(messages, "memq://"));
  const auto fixed = expected_receive_buffer(messages, "udpm://239.255.76.67:7667?recv_buf_size=50000");
  ASSERT_TRUE(fixed);
  EXPECT_EQ(fixed->requested, 50'000U);
  EXPECT_EQ(fixed->max_message, 50'000U);
  EXPECT_TRUE(fixed->fixed_by_url);
  const auto automatic = expected_receive_buffer(messages, "udpm://239.255.76.67:7667");
  ASSERT_TRUE(automatic);
  EXPECT_EQ(automatic->requested, receive_buffer_for(messages.request.bytes));
  EXPECT_GE(automatic->max_message, 50'000U);
  EXPECT_FALSE(automatic->fixed_by_url);
}

TEST(MessageSizes, AppearInCheckReport) {
  const Scene scene = boxes(1'000, kHydrostatics);
  const LargestMessages messages = largest_messages(scene, {});
  const ReceiveBuffer small{.max_message = 100'000};
  const std::string text = check_report_text(scene, messages, small);
  for (const char* part : {"request for all 1000 bodies: 108044 bytes in 2 packets",
                           "response for all 1000 bodies: 104036 bytes in 2 packets",
                           "hydrostatics for all 1000 bodies: 512036 bytes in 8 packets", "100000 bytes",
                           "warning: request for all 1000 bodies: "}) {
    EXPECT_TRUE(contains(text, part));
  }
  const auto json = parse_json(check_report_json(scene, messages, small));
  EXPECT_EQ(json["messages"]["request"]["bytes"], 108'044);
  EXPECT_EQ(json["messages"]["hydrostatics"]["packets"], 8);
  EXPECT_TRUE(json["messages"]["loads"].is_null());
  EXPECT_EQ(json["receive_buffer"], 100'000);
  EXPECT_EQ(json["warnings"].size(), 1U);
  EXPECT_EQ(json["bodies"].size(), 1'000U);
  const auto in_process = parse_json(check_report_json(scene, messages, std::nullopt));
  EXPECT_TRUE(in_process["receive_buffer"].is_null());
  EXPECT_TRUE(in_process["warnings"].empty());
}

TEST(MessageSizes, OfLoadsAppearInCheckReport) {
  const Scene scene = boxes(1'000, kLoads);
  const LargestMessages messages = largest_messages(scene, {});
  const std::string text = check_report_text(scene, messages, std::nullopt);
  EXPECT_TRUE(contains(text, "loads for all 1000 bodies: 760036 bytes in 12 packets"));
  const auto json = parse_json(check_report_json(scene, messages, std::nullopt));
  EXPECT_EQ(json["messages"]["loads"]["bytes"], 760'036);
  EXPECT_EQ(json["messages"]["loads"]["packets"], 12);
  EXPECT_TRUE(json["messages"]["hydrostatics"].is_null());
}

TEST(CheckReport, WarnsAboutASteepSea) {
  const Scene scene = boxes(1, "[water.waves]\ntype = \"regular\"\nheight = 3\nperiod = 2\n");
  const LargestMessages messages = largest_messages(scene, {});
  const std::string text = check_report_text(scene, messages, std::nullopt);
  EXPECT_TRUE(contains(text, "\nwarning: test scene: the sea: a steepness of 1.5"));
  const auto json = parse_json(check_report_json(scene, messages, std::nullopt));
  ASSERT_EQ(json["warnings"].size(), 2U);  // such a wave also breaks
  EXPECT_EQ(json["sea"]["components"].size(), 1U);
}

}  // namespace
}  // namespace buoyancy::service
