#include "service/daemon/instance_monitor.h"

#include <gtest/gtest.h>

#include "tests/support/byte_vector.h"

namespace buoyancy::service {
namespace {

std::vector<std::uint8_t> status_of(std::int64_t instance_id) {
  ServiceStatus status;
  status.scene_fingerprint = 100 + instance_id;
  status.instance_id = instance_id;
  status.version = "0.1.0";
  return encoded(status);
}

TEST(InstanceMonitor, ReportsEachOtherInstanceOnce) {
  InstanceMonitor monitor(7);
  monitor.observe(status_of(7));
  EXPECT_TRUE(monitor.take_new().empty());
  monitor.observe(status_of(8));
  monitor.observe(status_of(9));
  monitor.observe(status_of(8));
  const std::vector<InstanceMonitor::Instance> seen = monitor.take_new();
  ASSERT_EQ(seen.size(), 2U);
  for (std::int64_t i = 0; i < 2; ++i) {
    EXPECT_EQ(seen[i].id, 8 + i);
    EXPECT_EQ(seen[i].scene_fingerprint, 108 + i);
  }
  EXPECT_EQ(monitor.count(), 2U);
  monitor.observe(status_of(9));
  EXPECT_TRUE(monitor.take_new().empty());
}

TEST(InstanceMonitor, IgnoresInvalidMessages) {
  InstanceMonitor monitor(7);
  std::vector<std::uint8_t> truncated = status_of(8);
  truncated.pop_back();
  monitor.observe(truncated);
  monitor.observe({});
  EXPECT_TRUE(monitor.take_new().empty());
}

TEST(InstanceMonitor, IgnoresInstancesBeyondItsLimit) {
  InstanceMonitor monitor(-1);
  for (std::int64_t id = 0; id < 1000; ++id) monitor.observe(status_of(id));
  EXPECT_EQ(monitor.take_new().size(), InstanceMonitor::kMaxInstances);
  monitor.observe(status_of(1000));
  EXPECT_TRUE(monitor.take_new().empty());
}

}  // namespace
}  // namespace buoyancy::service
