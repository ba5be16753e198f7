#include "service/daemon/instance_monitor.h"

#include <gtest/gtest.h>

namespace buoyancy::service {
namespace {

std::vector<std::uint8_t> status_of(std::int64_t instance_id) {
  ServiceStatus status;
  status.instance_id = instance_id;
  status.version = "0.1.0";
  std::vector<std::uint8_t> bytes;
  encode(status, bytes);
  return bytes;
}

TEST(InstanceMonitor, AreSaidOnceEachAndOurOwnNever) {
  InstanceMonitor others(7);
  others.observe(status_of(7));
  EXPECT_TRUE(others.take_new().empty());
  others.observe(status_of(8));
  others.observe(status_of(9));
  others.observe(status_of(8));
  EXPECT_EQ(others.take_new(), (std::vector<std::int64_t>{8, 9}));
  others.observe(status_of(9));
  EXPECT_TRUE(others.take_new().empty());
}

TEST(InstanceMonitor, AreNotSeenInWhatIsNoStatus) {
  InstanceMonitor others(7);
  std::vector<std::uint8_t> cut = status_of(8);
  cut.pop_back();
  others.observe(cut);
  others.observe({});
  EXPECT_TRUE(others.take_new().empty());
}

TEST(InstanceMonitor, AreNotSaidBeyondAsManyAsAreToldApart) {
  InstanceMonitor others(-1);
  for (std::int64_t id = 0; id < 1000; ++id) others.observe(status_of(id));
  EXPECT_EQ(others.take_new().size(), InstanceMonitor::kMost);
  others.observe(status_of(1000));
  EXPECT_TRUE(others.take_new().empty());
}

}  // namespace
}  // namespace buoyancy::service
